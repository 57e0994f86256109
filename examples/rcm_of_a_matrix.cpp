// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Orders the rows of a sparse matrix by reverse Cuthill–McKee and moves the matrix: its bandwidth shrinks.
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>

#include <cstddef>
#include <cstdio>
#include <span>
#include <vector>

namespace mo = meshorder;

namespace {

struct Matrix {
  std::vector<int> row_start{0};
  std::vector<int> column;
  std::vector<double> value;
};

// Returns the Laplacian of a grid of side × side points, in a poor order: point i is in row 7 i mod n. The
// first row lacks an entry that the first column has, as in matrices with boundary conditions.
Matrix sample(int side) {
  const int n = side * side;
  std::vector<int> point_of_row(static_cast<std::size_t>(n));
  const auto row_of = [n](int point) { return 7 * point % n; };
  for (int point = 0; point < n; ++point) point_of_row[static_cast<std::size_t>(row_of(point))] = point;
  Matrix matrix;
  for (const int point : point_of_row) {
    const int x = point % side;
    const int y = point / side;
    const auto add = [&](int other, double value) {
      matrix.column.push_back(row_of(other));
      matrix.value.push_back(value);
    };
    add(point, 4);
    if (x > 0) add(point - 1, -1);
    if (x + 1 < side && point != 0) add(point + 1, -1);
    if (y > 0) add(point - side, -1);
    if (y + 1 < side) add(point + side, -1);
    matrix.row_start.push_back(static_cast<int>(matrix.column.size()));
  }
  return matrix;
}

mo::Permutation rcm(const std::vector<int>& row_start, const std::vector<int>& column) {
  return mo::order_vertices({row_start, column}, "rcm", {.symmetry = mo::Symmetry::mirror}).permutation;
}

int bandwidth(const Matrix& matrix) {
  const mo::Graph graph = mo::cleaned({matrix.row_start, matrix.column}, mo::Symmetry::mirror);
  return mo::quality(graph).bandwidth;
}

}  // namespace

int main() {
  const Matrix a = sample(60);
  const mo::Permutation p = rcm(a.row_start, a.column);

  Matrix b{std::vector<int>(a.row_start.size()), std::vector<int>(a.column.size()),
           std::vector<double>(a.value.size())};
  p.move_csr({a.row_start, a.column}, std::as_bytes(std::span(a.value)), b.row_start, b.column,
             std::as_writable_bytes(std::span(b.value)));

  const int before = bandwidth(a);
  const int after = bandwidth(b);
  std::printf("bandwidth %d before, %d after\n", before, after);
  return after < before / 10 ? 0 : 1;
}
