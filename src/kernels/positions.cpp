// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/positions.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <string>

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

void check_same_size(std::span<const double> positions, std::span<const double> forces,
                     const char* function) {
  if (positions.size() != forces.size()) {
    throw InvalidArgument(std::string(function) + ": positions and forces must have the same size");
  }
}

}  // namespace meshorder
