// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/kernel_input.hpp"

#include "base/memory.hpp"
#include "base/stopwatch.hpp"
#include <meshorder/error.hpp>

#include <string>

namespace meshorder {

KernelInput::KernelInput(const Mesh& mesh, const CsrGraph& graph)
    : is_matrix_(stored_matrix(mesh) != nullptr), points_(mesh.points), graph_(&graph), simplices_(mesh) {
  if (graph.size() != mesh.vertex_count()) {
    throw InvalidArgument("kernels: a graph of " + std::to_string(graph.size()) + " vertices for a mesh of " +
                          std::to_string(mesh.vertex_count()));
  }
  if (is_matrix_) pattern_ = entry_pattern(mesh);
}

KernelInput KernelInput::moved(const MeshOrder& order) const {
  const Permutation& vertices = order.vertices.permutation;
  const Stopwatch stopwatch;
  KernelInput result;
  result.is_matrix_ = is_matrix_;
  if (is_matrix_) {
    result.pattern_ = meshorder::moved(vertices, pattern_);
  } else {
    resize_large(result.own_points_, points_.size());
    vertices.move(points_, result.own_points_);
    result.points_ = result.own_points_;
    result.simplices_ = simplices_.moved(vertices, order.cells.permutation);
  }
  result.seconds_to_move_ = stopwatch.seconds();
  result.own_graph_ = std::make_unique<const CsrGraph>(renumbered(*graph_, vertices.old_to_new()));
  result.graph_ = result.own_graph_.get();
  return result;
}

}  // namespace meshorder
