// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/simd_target.hpp"

#include <hwy/highway.h>
#include <hwy/targets.h>

namespace meshorder {

std::string simd_target() {
  // better targets have lower bits
  const auto usable = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(usable & -usable);
}

}  // namespace meshorder
