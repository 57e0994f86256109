// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// The table of a function's versions, one for each instruction set, and the choice among them. Highway's own
// choice needs its library, which takes 7 ms at the start of a program to measure the processor's clock.

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

namespace meshorder {

/// Returns the instruction sets of this processor among those that Highway compiles for, as bits of
/// HWY_TARGETS. Better instruction sets have lower bits. The result includes the instruction sets that the
/// compiler may use anyway.
std::int64_t simd_targets();

/// Restricts `simd_targets` to `targets`, for tests; 0: no restriction. Call it only while no kernel runs.
void limit_simd_targets(std::int64_t targets);

/// Returns Highway's name of the instruction set that the kernels use on this processor: "AVX3", "AVX2",
/// "NEON".
std::string simd_target();

/// Returns the index of the best version in a table of MESHORDER_SIMD_VERSIONS.
///
/// @param targets  the instruction sets for which the table has a version, as bits of HWY_TARGETS
inline std::size_t simd_version(std::int64_t targets) {
  constexpr int kLowest = HWY_HIGHEST_TARGET_BIT + 1 - HWY_MAX_DYNAMIC_TARGETS;
  constexpr std::uint64_t kFallback = std::uint64_t{1} << HWY_MAX_DYNAMIC_TARGETS;
  const auto usable = static_cast<std::uint64_t>(simd_targets() & targets) >> kLowest;
  return static_cast<std::size_t>(std::countr_zero(usable | kFallback));
}

}  // namespace meshorder

/// Makes the table of a function's versions, which foreach_target.h has compiled.
#define MESHORDER_SIMD_VERSIONS(function)                                                     \
  constexpr std::array<decltype(&HWY_STATIC_DISPATCH(function)), HWY_MAX_DYNAMIC_TARGETS + 1> \
      function##_versions {                                                                   \
    HWY_CHOOSE_TARGET_LIST(function), HWY_CHOOSE_FALLBACK(function)                           \
  }

/// The function's version for this processor.
#define MESHORDER_SIMD(function) (*function##_versions[::meshorder::simd_version(HWY_TARGETS)])
