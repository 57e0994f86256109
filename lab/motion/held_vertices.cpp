// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/motion/held_vertices.hpp"

#include <algorithm>

namespace meshorder {

void HeldVertices::clear() {
  vertices_.clear();
  velocities_.clear();
}

void HeldVertices::hold(Index vertex, const Point& velocity) {
  vertices_.push_back(vertex);
  velocities_.push_back(velocity);
}

void HeldVertices::set(std::span<double> velocities) const {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    std::copy(velocities_[i].begin(), velocities_[i].end(), velocities.begin() + Offset{3} * vertices_[i]);
  }
}

void HeldVertices::set_zero(std::span<double> vector) const {
  for (const Index v : vertices_) std::fill_n(vector.begin() + Offset{3} * v, 3, 0.0);
}

void HeldVertices::remove_from(BlockCsr& matrix) const {
  for (const Index v : vertices_) {
    for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
      const Index column = matrix.columns[k];
      double* const block = matrix.values.data() + 9 * k;
      if (column == v) {
        const double mean = (block[0] + block[4] + block[8]) / 3;
        std::fill_n(block, 9, 0.0);
        for (const int i : {0, 4, 8}) block[i] = mean > 0.0 ? mean : 1.0;
      } else {
        std::fill_n(block, 9, 0.0);
        std::fill_n(matrix.values.data() + 9 * matrix.find(column, v), 9, 0.0);
      }
    }
  }
}

}  // namespace meshorder
