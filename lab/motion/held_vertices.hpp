// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "kernels/block_csr.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// The vertices whose motion in a step is given, and with what velocity they move.
class HeldVertices {
 public:
  void clear();
  /// Held twice, a vertex has the later velocity.
  void hold(Index vertex, const Point& velocity);

  /// Gives the held vertices their velocities, in 3 doubles for each vertex. O(held).
  void set(std::span<double> velocities) const;
  /// Sets their entries to 0. O(held).
  void set_zero(std::span<double> vector) const;
  /// Those held, in the order in which they were given.
  [[nodiscard]] std::span<const Index> vertices() const noexcept { return vertices_; }

  /// Calls `work(vertex, velocity)` for them in that order.
  template <class Work>
  void for_each(Work work) const {
    for (std::size_t i = 0; i < vertices_.size(); ++i) work(vertices_[i], velocities_[i]);
  }

  /// Takes their rows and columns out of a symmetric matrix: zero but for the diagonal, a multiple of the
  /// identity. With zeros on the right-hand side they take no part. O(their blocks · log row length).
  void remove_from(BlockCsr& matrix) const;

 private:
  std::vector<Index> vertices_;
  std::vector<Point> velocities_;  ///< of `vertices_`
};

}  // namespace meshorder
