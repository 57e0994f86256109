// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"

#include <cstddef>
#include <initializer_list>
#include <utility>

namespace meshorder {

/// The least distance, modulo 4096 bytes, between the arrays that a kernel reads and adds to at one index.
///
/// Processors first compare the low 12 bits of a load's address with those of earlier stores; on many, the
/// load waits if the bits agree. If positions and forces both began at a page, a kernel that reads
/// positions[v] and adds to forces[v] would wait for the stores to all vertices near v: springs took 1.4 to
/// 2.2 times as long on an Intel Xeon (docs/evidence/benchmarks.md). Some 30 vertices of 32 bytes each are
/// near v, so a distance of 64 bytes is not enough.
inline constexpr std::size_t kApart = 1088;

/// Returns whether the addresses differ by less than kApart modulo 4096.
bool aliases(const void* a, const void* b) noexcept;

/// Returns an empty vector with room for `count` entries. A large vector aliases none of `others` if these
/// are at most two: large vectors begin at three places of a page in turn (aligned.cpp).
template <class T>
AlignedVector<T> reserved_apart(std::size_t count, std::initializer_list<const void*> others) {
  AlignedVector<T> tries[3];
  for (AlignedVector<T>& array : tries) {
    array.reserve(count);
    bool apart = true;
    for (const void* const other : others) apart = apart && !aliases(array.data(), other);
    if (apart) return std::move(array);
  }
  return std::move(tries[0]);
}

}  // namespace meshorder
