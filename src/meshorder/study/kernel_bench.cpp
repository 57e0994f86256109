// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/mesh/graphs.hpp>
#include <meshorder/sim/kernels/positions.hpp>
#include <meshorder/sim/kernels/spmv.hpp>
#include <meshorder/study/kernel_bench.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace meshorder {
namespace {

// the values do not matter to the time; these are soft rubber's
const Lame kMaterial = Lame::from_young(1e6, 0.45);
constexpr double kStiffness = 1e3;

/// Waves of 2 % of the mesh's size along every axis: strains of up to 0.2, however fine the mesh.
std::vector<Point> displacements(std::span<const Point> points) {
  std::vector<Point> result(points.size());
  if (points.empty()) return result;
  Point low = points.front();
  Point high = points.front();
  for (const Point& point : points) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], point[c]);
      high[c] = std::max(high[c], point[c]);
    }
  }
  const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  const double wave = size > 0.0 ? 3.0 * std::numbers::pi / size : 0.0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      const double along = points[v][(c + 1) % 3] - low[(c + 1) % 3];
      result[v][c] = 0.02 * size * std::sin(wave * along + 1.0 + c) + 0.03 * (points[v][c] - low[c]);
    }
  }
  return result;
}

template <class Vector>
std::size_t bytes_of(const Vector& vector) {
  return vector.capacity() * sizeof(typename Vector::value_type);
}

}  // namespace

std::string_view name(Kernel kernel) {
  switch (kernel) {
    case Kernel::spmv:
      return "spmv";
    case Kernel::element:
      return "element";
    case Kernel::assembly:
      return "assembly";
    case Kernel::springs:
      return "springs";
  }
  return "";
}

KernelBench::KernelBench(const Mesh& mesh, const CsrGraph& graph) {
  if (graph.size() != mesh.vertex_count()) {
    throw InvalidArgument("kernels: a graph of " + std::to_string(graph.size()) + " vertices for a mesh of " +
                          std::to_string(mesh.vertex_count()));
  }
  matrix_ = zero_block_csr(graph);
  rest_ = rest_shapes(cut_into_simplices(mesh), mesh.points);
  map_ = assembly_map(rest_, matrix_);
  springs_ = springs_on_edges(graph, mesh.points);
  positions_ = padded_positions(mesh.points);
  forces_ = padded_zeros(mesh.vertex_count());
  x_.assign(3 * mesh.points.size(), 0.0);
  y_.assign(3 * mesh.points.size(), 0.0);
  const std::vector<Point> moves = displacements(mesh.points);
  for (std::size_t v = 0; v < moves.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) {
      x_[3 * v + c] = moves[v][c];
      positions_[kPaddedStride * v + c] += moves[v][c];
    }
  }
  // the matrix that spmv multiplies by
  run(Kernel::assembly);
}

KernelBench::KernelBench(const Mesh& mesh) : KernelBench(mesh, vertex_graph(mesh)) {}

void KernelBench::run(Kernel kernel) {
  switch (kernel) {
    case Kernel::spmv:
      multiply(matrix_, x_, y_);
      return;
    case Kernel::element:
      std::fill(forces_.begin(), forces_.end(), 0.0);
      add_stvk_forces(rest_, kMaterial, positions_, forces_);
      return;
    case Kernel::assembly:
      matrix_.set_zero();
      add_stvk_stiffness(rest_, kMaterial, positions_, map_, matrix_);
      return;
    case Kernel::springs:
      std::fill(forces_.begin(), forces_.end(), 0.0);
      add_spring_forces(springs_, kStiffness, positions_, forces_);
      return;
  }
}

std::span<const double> KernelBench::result(Kernel kernel) const {
  switch (kernel) {
    case Kernel::spmv:
      return y_;
    case Kernel::assembly:
      return matrix_.values;
    case Kernel::element:
    case Kernel::springs:
      break;
  }
  return forces_;
}

double KernelBench::streamed_bytes(Kernel kernel) const {
  // what is cleared and then added to is written, read and written again
  const std::size_t vertices = bytes_of(positions_) + 3 * bytes_of(forces_);
  const std::size_t elements = bytes_of(rest_.vertices) + bytes_of(rest_.geometry);
  std::size_t bytes = 0;
  switch (kernel) {
    case Kernel::spmv:
      bytes = bytes_of(matrix_.values) + bytes_of(matrix_.columns) + bytes_of(matrix_.offsets) +
              bytes_of(x_) + bytes_of(y_);
      break;
    case Kernel::element:
      bytes = elements + vertices;
      break;
    case Kernel::assembly:
      bytes = elements + bytes_of(positions_) + bytes_of(map_.blocks) + 3 * bytes_of(matrix_.values);
      break;
    case Kernel::springs:
      bytes = bytes_of(springs_.ends) + bytes_of(springs_.rest_lengths) + vertices;
      break;
  }
  return static_cast<double>(bytes);
}

std::size_t KernelBench::bytes() const {
  return bytes_of(matrix_.offsets) + bytes_of(matrix_.columns) + bytes_of(matrix_.values) +
         bytes_of(rest_.vertices) + bytes_of(rest_.geometry) + bytes_of(map_.blocks) +
         bytes_of(springs_.ends) + bytes_of(springs_.rest_lengths) + bytes_of(positions_) +
         bytes_of(forces_) + bytes_of(x_) + bytes_of(y_);
}

}  // namespace meshorder
