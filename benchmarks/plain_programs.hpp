// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/plain.hpp"

#include <array>
#include <cstddef>
#include <span>

// Loops of other programs, written like those of kernels/plain.hpp. Functions add residuals and messages to
// the values in the output array.
namespace meshorder::plain {

/// Computes y = A x for a matrix of 3×3 blocks, each stored row by row.
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

/// Makes one Gauss–Seidel sweep for A x = b. The diagonal must not be 0.
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

/// Adds central fluxes of 5 unknowns over the faces between vertices, one face for each edge, as in
/// vertex-centred finite volume codes.
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

/// Adds up the features of all neighbours, `width` floats per vertex, as graph neural networks do.
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
