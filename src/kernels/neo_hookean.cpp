// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/neo_hookean.cpp"
#include <hwy/foreach_target.h>
// the rest of this file is compiled once for each instruction set
#include "kernels/neo_hookean-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

struct LawOfFile {
  static constexpr bool kVolumesOnly = true;
  template <int, class Lanes>
  using Law = NeoHookean<Lanes>;
  template <int, class Lanes>
  using ExactTangent = NeoHookeanTangent<Lanes>;
  template <int, class Lanes>
  using ApproximateTangent = NeoHookeanTangent<Lanes>;
};

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#define MESHORDER_LAW_KERNELS neo_hookean_kernels
#include "kernels/law_dispatch-inl.hpp"
