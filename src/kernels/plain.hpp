// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

// Kernels as programs write them that know nothing of each other's caches: one loop, no prefetching, no
// blocking, no threads. What an order of a mesh is worth in them, it is worth to most users. The other
// kernels in this folder are tuned, and run alike in all good orders.
//
// Vectors of positions and forces have x, y, z of one vertex side by side. Results are added to what is
// there.
namespace meshorder::plain {

/// A matrix in compressed sparse rows.
template <class Number, class Column>
struct Matrix {
  std::span<const Column> starts;   ///< rows + 1
  std::span<const Column> columns;  ///< rising in each row
  std::span<Number> values;
};

/// y = A x.
template <class Number, class Column>
void multiply(const Matrix<Number, Column>& a, std::span<const Number> x, std::span<Number> y) {
  for (std::size_t row = 0; row < y.size(); ++row) {
    Number sum = 0;
    for (Column k = a.starts[row]; k < a.starts[row + 1]; ++k) sum += a.values[k] * x[a.columns[k]];
    y[row] = sum;
  }
}

/// y = A x with blocks of 3 × 3, row by row.
template <class Column>
void multiply_blocks(const Matrix<double, Column>& a, std::span<const double> x, std::span<double> y) {
  for (std::size_t row = 0; row + 1 < a.starts.size(); ++row) {
    std::array<double, 3> sum{};
    for (Column k = a.starts[row]; k < a.starts[row + 1]; ++k) {
      const double* const block = a.values.data() + 9 * std::size_t(k);
      const double* const in = x.data() + 3 * std::size_t(a.columns[k]);
      for (int i = 0; i < 3; ++i)
        sum[i] += block[3 * i] * in[0] + block[3 * i + 1] * in[1] + block[3 * i + 2] * in[2];
    }
    for (int i = 0; i < 3; ++i) y[3 * row + i] = sum[i];
  }
}

/// A sweep of Gauss and Seidel for A x = b. The diagonal is not 0.
template <class Number, class Column>
void relax(const Matrix<Number, Column>& a, std::span<const Number> b, std::span<Number> x) {
  for (std::size_t row = 0; row < x.size(); ++row) {
    Number rest = b[row];
    Number diagonal = 1;
    for (Column k = a.starts[row]; k < a.starts[row + 1]; ++k) {
      if (std::size_t(a.columns[k]) == row) {
        diagonal = a.values[k];
      } else {
        rest -= a.values[k] * x[a.columns[k]];
      }
    }
    x[row] = rest / diagonal;
  }
}

/// Forces of springs of stiffness 1: `ends` has two vertices for each of `lengths`.
template <class Number>
void springs(std::span<const Index> ends, std::span<const Number> lengths, std::span<const Number> positions,
             std::span<Number> forces) {
  for (std::size_t s = 0; s < lengths.size(); ++s) {
    const std::size_t i = 3 * std::size_t(ends[2 * s]);
    const std::size_t j = 3 * std::size_t(ends[2 * s + 1]);
    std::array<Number, 3> edge{};
    for (int c = 0; c < 3; ++c) edge[c] = positions[j + c] - positions[i + c];
    const Number length = std::sqrt(edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2]);
    const Number tension = (length - lengths[s]) / length;
    for (int c = 0; c < 3; ++c) {
      forces[i + c] += tension * edge[c];
      forces[j + c] -= tension * edge[c];
    }
  }
}

/// Six times the gradients of a tetrahedron's barycentric coordinates times its volume, and six times its
/// volume.
struct Gradients {
  std::array<std::array<double, 3>, 4> of_corner;
  double volume;
};

inline Gradients gradients(const Index* tetrahedron, std::span<const double> positions) {
  const auto edge = [&](int corner, int c) {
    return positions[3 * std::size_t(tetrahedron[corner]) + c] -
           positions[3 * std::size_t(tetrahedron[0]) + c];
  };
  Gradients g{};
  for (int corner = 1; corner < 4; ++corner) {
    const int next = corner % 3 + 1;
    const int last = next % 3 + 1;
    for (int c = 0; c < 3; ++c) {
      const int d = (c + 1) % 3;
      const int e = (c + 2) % 3;
      g.of_corner[corner][c] = edge(next, d) * edge(last, e) - edge(next, e) * edge(last, d);
      g.of_corner[0][c] -= g.of_corner[corner][c];
    }
  }
  for (int c = 0; c < 3; ++c) g.volume += edge(1, c) * g.of_corner[1][c];
  return g;
}

/// Pressure of 6 in tetrahedra, element by element: six times the gradient of the volume.
inline void press(std::span<const Index> tetrahedra, std::span<const double> positions,
                  std::span<double> forces) {
  for (std::size_t e = 0; e < tetrahedra.size(); e += 4) {
    const Gradients g = gradients(tetrahedra.data() + e, positions);
    for (int corner = 0; corner < 4; ++corner) {
      for (int c = 0; c < 3; ++c)
        forces[3 * std::size_t(tetrahedra[e + corner]) + c] += g.of_corner[corner][c];
    }
  }
}

/// Linear elements for the Laplacian, entries found by a search along their row.
template <class Column>
void assemble(std::span<const Index> tetrahedra, std::span<const double> positions,
              const Matrix<double, Column>& a) {
  for (std::size_t e = 0; e < tetrahedra.size(); e += 4) {
    const Gradients g = gradients(tetrahedra.data() + e, positions);
    const double scale = 1 / (6 * std::abs(g.volume));
    for (int i = 0; i < 4; ++i) {
      const Column start = a.starts[tetrahedra[e + i]];
      for (int j = 0; j < 4; ++j) {
        Column k = start;
        while (a.columns[k] != Column(tetrahedra[e + j])) ++k;
        double product = 0;
        for (int c = 0; c < 3; ++c) product += g.of_corner[i][c] * g.of_corner[j][c];
        a.values[k] += scale * product;
      }
    }
  }
}

/// Central fluxes of 5 unknowns over the faces between vertices, one for each edge, as vertex-centred finite
/// volumes have them.
inline void exchange(std::span<const Index> ends, std::span<const double> areas,
                     std::span<const double> state, std::span<double> residual) {
  constexpr int kUnknowns = 5;
  for (std::size_t face = 0; face < areas.size(); ++face) {
    const std::size_t i = kUnknowns * std::size_t(ends[2 * face]);
    const std::size_t j = kUnknowns * std::size_t(ends[2 * face + 1]);
    for (int u = 0; u < kUnknowns; ++u) {
      const double flux = areas[face] * (state[i + u] + state[j + u]) / 2;
      residual[i + u] += flux;
      residual[j + u] -= flux;
    }
  }
}

/// Sums the features of all neighbours, `width` floats a vertex, as networks on graphs do.
template <class Column>
void gather_messages(const Matrix<float, Column>& graph, int width, std::span<const float> in,
                     std::span<float> out) {
  for (std::size_t row = 0; row + 1 < graph.starts.size(); ++row) {
    for (Column k = graph.starts[row]; k < graph.starts[row + 1]; ++k) {
      const std::size_t from = std::size_t(graph.columns[k]) * std::size_t(width);
      for (int f = 0; f < width; ++f)
        out[row * std::size_t(width) + std::size_t(f)] += in[from + std::size_t(f)];
    }
  }
}

}  // namespace meshorder::plain
