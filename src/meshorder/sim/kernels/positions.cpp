// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/kernels/positions.hpp>

#include <algorithm>

namespace meshorder {

AlignedVector<double> padded_positions(std::span<const Point> points) {
  AlignedVector<double> result = padded_zeros(index_size(points));
  auto place = result.begin();
  for (const Point& point : points) {
    std::copy(point.begin(), point.end(), place);
    place += kPaddedStride;
  }
  return result;
}

AlignedVector<double> padded_zeros(Index n) { return AlignedVector<double>(Offset{kPaddedStride} * n, 0.0); }

}  // namespace meshorder
