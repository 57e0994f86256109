// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/pass.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/stvk.cpp"
#include <hwy/foreach_target.h>
// the rest of this file is compiled once for each instruction set
#include "kernels/stvk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

struct LawOfFile {
  static constexpr bool kVolumesOnly = false;
  template <int D, class Lanes>
  using Law = Stvk<D, Lanes>;
  template <int D, class Lanes>
  using ExactTangent = StvkTangent<D, Lanes>;
  template <int D, class Lanes>
  using ApproximateTangent = StvkTangent<D, Lanes>;
};

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#define MESHORDER_LAW_KERNELS stvk_kernels
#include "kernels/law_dispatch-inl.hpp"
