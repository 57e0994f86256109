// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/simd_dispatch.hpp"

#include <atomic>

namespace meshorder {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a setting of the process
std::atomic<std::int64_t> allowed{~std::int64_t{0}};

std::int64_t found_targets() {
  std::int64_t found = HWY_STATIC_TARGET;
#if HWY_ARCH_X86
  // the features that the attributes of Highway's set_macros-inl.h enable; AVX2 and FMA imply F16C
  const bool has_sse4 = __builtin_cpu_supports("sse4.2") != 0 && __builtin_cpu_supports("pclmul") != 0 &&
                        __builtin_cpu_supports("aes") != 0;
  const bool has_avx2 = has_sse4 && __builtin_cpu_supports("avx2") != 0 &&
                        __builtin_cpu_supports("fma") != 0 && __builtin_cpu_supports("bmi") != 0 &&
                        __builtin_cpu_supports("bmi2") != 0;
  const bool has_avx3 = has_avx2 && __builtin_cpu_supports("avx512f") != 0 &&
                        __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                        __builtin_cpu_supports("avx512bw") != 0;
  if (has_sse4) found |= HWY_SSE4;
  if (has_avx2) found |= HWY_AVX2;
  if (has_avx3) found |= HWY_AVX3;
#endif
  return found;
}

}  // namespace

std::int64_t simd_targets() {
  static const std::int64_t targets = found_targets();
  return targets & allowed.load(std::memory_order_relaxed);
}

void limit_simd_targets(std::int64_t targets) { allowed = targets == 0 ? ~std::int64_t{0} : targets; }

std::string simd_target() {
  const std::int64_t usable = simd_targets() & HWY_TARGETS;
  return hwy::TargetName(usable & -usable);
}

}  // namespace meshorder
