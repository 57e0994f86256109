// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"

#include <span>

namespace meshorder {

/// Puts the `left` things with the least coordinates first, along the longest axis of the centres of all;
/// equal ones by their number. O(n).
void halve(std::span<Index> things, Index left, std::span<const Point> centers);

/// Orders things so that each run of `size` is compact: halves them again and again at multiples of `size`.
/// O(n log n).
void sort_into_runs(std::span<Index> things, Index size, std::span<const Point> centers);

}  // namespace meshorder
