// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"

#include <cstddef>
#include <initializer_list>
#include <utility>

namespace meshorder {

/// The least distance, modulo 4096 bytes, of arrays that are read and added to by the same index.
///
/// Processors first compare a load with the stores before it by the low 12 bits of their addresses, and many
/// let it wait where these agree. A kernel that reads positions[v] and adds to forces[v] would wait for the
/// stores to all vertices near v if both arrays began at a page: springs took 1.4 to 2.2 times as long on an
/// Intel Xeon (docs/evidence/benchmarks.md). Vertices near v are some 30 of 32 bytes; a distance of 64 bytes
/// does not suffice.
inline constexpr std::size_t kApart = 1088;

/// Whether the addresses differ by less than kApart modulo 4096.
bool aliases(const void* a, const void* b) noexcept;

/// Returns an empty vector with room for `count` entries that is apart from up to two other arrays. Large
/// vectors begin at three places of a page in turns (aligned.cpp); small ones may lie anywhere.
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
