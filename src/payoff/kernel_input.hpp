// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "mesh/simplices.hpp"
#include "mesh/stored_matrix.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/order.hpp>

#include <memory>
#include <span>
#include <vector>

namespace meshorder {

/// The data of the kernels of a mesh or matrix, in one order. Cuts the mesh into simplices once; for other
/// orders it moves these simplices.
class KernelInput {
 public:
  /// The input in the mesh's own order. Refers to the mesh and its vertex graph, which must not change.
  /// O(cells). Throws InvalidArgument if the graph is of another mesh.
  KernelInput(const Mesh& mesh, const CsrGraph& graph);

  /// Returns the input in another order, on arrays of its own. O(size).
  [[nodiscard]] KernelInput moved(const MeshOrder& order) const;

  [[nodiscard]] bool is_matrix() const noexcept { return is_matrix_; }
  [[nodiscard]] std::span<const Point> points() const noexcept { return points_; }
  [[nodiscard]] const CsrGraph& graph() const noexcept { return *graph_; }
  [[nodiscard]] SimplicesRef simplices() const noexcept { return simplices_; }
  /// Returns the entries of a matrix; an empty pattern for a mesh.
  [[nodiscard]] const EntryPattern& pattern() const noexcept { return pattern_; }
  /// Returns the seconds that `moved` took to move points and simplices, or entries: a part of the cost of
  /// an order.
  [[nodiscard]] double seconds_to_move() const noexcept { return seconds_to_move_; }

 private:
  KernelInput() = default;

  bool is_matrix_ = false;
  std::span<const Point> points_;
  const CsrGraph* graph_ = nullptr;
  CellSimplices simplices_;
  EntryPattern pattern_;
  double seconds_to_move_ = 0;
  // set in an input that was moved; for a matrix, which has no elements, only the graph
  std::vector<Point> own_points_;
  std::unique_ptr<const CsrGraph> own_graph_;
};

}  // namespace meshorder
