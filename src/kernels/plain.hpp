// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

// Kernels as ordinary programs write them: one loop on one thread, no prefetching, no blocking. Their times
// show how much most users gain by an order of a mesh. The other kernels in this folder are tuned, and run
// about equally fast in all good orders.
//
// Arrays of positions and forces hold x, y, z of each vertex side by side. Forces and matrix entries are
// added to the values in the output array.
namespace meshorder::plain {

/// The vertices to which a thread adds: `AllVertices`, or a `VertexRange`. When threads share a loop over
/// elements or edges, each thread is given the elements or edges that touch a vertex of its range, and adds
/// only to vertices of its range.
struct AllVertices {
  [[nodiscard]] static constexpr bool has(Index /*v*/) { return true; }
};
struct VertexRange {
  Index begin = 0;
  Index end = 0;

  [[nodiscard]] bool has(Index v) const { return begin <= v && v < end; }
};

/// A matrix in compressed sparse rows.
template <class Number, class Column, class Start = Column>
struct Matrix {
  std::span<const Start> starts;    ///< rows + 1
  std::span<const Column> columns;  ///< ascending in each row
  std::span<Number> values;
};

/// Computes y = A x.
template <class Number, class Column, class Start>
void multiply(const Matrix<Number, Column, Start>& a, std::span<const Number> x, std::span<Number> y) {
  for (std::size_t row = 0; row < y.size(); ++row) {
    Number sum = 0;
    for (Start k = a.starts[row]; k < a.starts[row + 1]; ++k) sum += a.values[k] * x[a.columns[k]];
    y[row] = sum;
  }
}

/// Adds the forces of springs of stiffness 1: `ends` has two vertices for each spring, `lengths` the spring's
/// length at rest.
template <class Number, class Owned = AllVertices>
void springs(std::span<const Index> ends, std::span<const Number> lengths, std::span<const Number> positions,
             std::span<Number> forces, const Owned& owned = {}) {
  for (std::size_t s = 0; s < lengths.size(); ++s) {
    const std::size_t i = 3 * std::size_t(ends[2 * s]);
    const std::size_t j = 3 * std::size_t(ends[2 * s + 1]);
    std::array<Number, 3> edge{};
    for (int c = 0; c < 3; ++c) edge[c] = positions[j + c] - positions[i + c];
    const Number length = std::sqrt(edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2]);
    const Number tension = length > 0 ? (length - lengths[s]) / length : 0;
    if (owned.has(ends[2 * s])) {
      for (int c = 0; c < 3; ++c) forces[i + c] += tension * edge[c];
    }
    if (owned.has(ends[2 * s + 1])) {
      for (int c = 0; c < 3; ++c) forces[j + c] -= tension * edge[c];
    }
  }
}

/// The volume of a tetrahedron (negative if it is inverted), the area of a triangle or the length of a line,
/// and its derivative with respect to the position of each corner: the volume times the gradient of that
/// corner's barycentric coordinate.
template <int Corners>
struct Gradients {
  std::array<std::array<double, 3>, Corners> of_corner{};
  double volume = 0;
};

template <int Corners>
Gradients<Corners> gradients(const Index* simplex, std::span<const double> positions) {
  using Vector = std::array<double, 3>;
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const auto dot = [](const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto inverse = [](double x) { return x > 0 ? 1 / x : 0; };
  std::array<Vector, Corners - 1> edge{};  // from the first corner
  for (int a = 1; a < Corners; ++a) {
    for (int c = 0; c < 3; ++c)
      edge[a - 1][c] =
          positions[3 * std::size_t(simplex[a]) + c] - positions[3 * std::size_t(simplex[0]) + c];
  }
  Gradients<Corners> g;
  if constexpr (Corners == 4) {
    g.of_corner = {Vector{}, cross(edge[1], edge[2]), cross(edge[2], edge[0]), cross(edge[0], edge[1])};
    for (int a = 1; a < 4; ++a) {
      for (double& x : g.of_corner[a]) x /= 6;
    }
    g.volume = dot(edge[0], g.of_corner[1]);
  } else if constexpr (Corners == 3) {
    const Vector normal = cross(edge[0], edge[1]);
    const double twice = std::sqrt(dot(normal, normal));
    g.of_corner = {Vector{}, cross(edge[1], normal), cross(normal, edge[0])};
    for (int a = 1; a < 3; ++a) {
      for (double& x : g.of_corner[a]) x *= inverse(2 * twice);
    }
    g.volume = twice / 2;
  } else {
    g.volume = std::sqrt(dot(edge[0], edge[0]));
    for (int c = 0; c < 3; ++c) g.of_corner[1][c] = edge[0][c] * inverse(g.volume);
  }
  for (int a = 1; a < Corners; ++a) {
    for (int c = 0; c < 3; ++c) g.of_corner[0][c] -= g.of_corner[a][c];
  }
  return g;
}

/// Adds the forces of a pressure of 1 that expands the elements: the derivative of the volume, area or length
/// of each element. `Corners` is 4 for tetrahedra, 3 for triangles, 2 for lines.
template <int Corners, class Owned = AllVertices>
void press(std::span<const Index> simplices, std::span<const double> positions, std::span<double> forces,
           const Owned& owned = {}) {
  for (std::size_t e = 0; e < simplices.size(); e += Corners) {
    const Gradients<Corners> g = gradients<Corners>(simplices.data() + e, positions);
    for (int corner = 0; corner < Corners; ++corner) {
      if (!owned.has(simplices[e + corner])) continue;
      for (int c = 0; c < 3; ++c)
        forces[3 * std::size_t(simplices[e + corner]) + c] += g.of_corner[corner][c];
    }
  }
}

/// Assembles linear finite elements for the Laplacian; finds each entry by a linear search in its row.
template <int Corners, class Column, class Start, class Owned = AllVertices>
void assemble(std::span<const Index> simplices, std::span<const double> positions,
              const Matrix<double, Column, Start>& a, const Owned& owned = {}) {
  for (std::size_t e = 0; e < simplices.size(); e += Corners) {
    const Gradients<Corners> g = gradients<Corners>(simplices.data() + e, positions);
    const double scale = g.volume != 0 ? 1 / std::abs(g.volume) : 0;
    for (int i = 0; i < Corners; ++i) {
      if (!owned.has(simplices[e + i])) continue;
      const Start start = a.starts[simplices[e + i]];
      for (int j = 0; j < Corners; ++j) {
        Start k = start;
        while (a.columns[k] != Column(simplices[e + j])) ++k;
        double product = 0;
        for (int c = 0; c < 3; ++c) product += g.of_corner[i][c] * g.of_corner[j][c];
        a.values[k] += scale * product;
      }
    }
  }
}

}  // namespace meshorder::plain
