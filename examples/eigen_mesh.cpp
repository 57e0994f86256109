// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Reorders a triangle mesh and its Laplacian. The mesh is in matrices of Eigen, as in libigl.
#include <meshorder/eigen.hpp>
#include <meshorder/error.hpp>
#include <meshorder/meshorder.hpp>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <cmath>
#include <cstdio>
#include <exception>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

namespace mo = meshorder;

namespace {

constexpr int kSide = 40;

struct Surface {
  Eigen::MatrixXd points;  // libigl's V
  Eigen::MatrixXi faces;   // libigl's F
};

// Returns a wavy square of kSide × kSide points, numbered at random.
Surface sample() {
  std::vector<int> number(kSide * kSide);
  for (int i = 0; i < kSide * kSide; ++i) number[static_cast<std::size_t>(i)] = i;
  std::mt19937 random(1);
  for (int i = kSide * kSide - 1; i > 0; --i)
    std::swap(number[static_cast<std::size_t>(i)], number[random() % static_cast<unsigned>(i + 1)]);
  Surface surface;
  surface.points.resize(kSide * kSide, 3);
  surface.faces.resize(2 * (kSide - 1) * (kSide - 1), 3);
  const auto at = [&](int x, int y) {
    return number[static_cast<std::size_t>(x) + kSide * static_cast<std::size_t>(y)];
  };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) surface.points.row(at(x, y)) << x, y, std::sin(0.3 * x);
  for (int y = 0, f = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      surface.faces.row(f++) << at(x, y), at(x + 1, y), at(x, y + 1);
      surface.faces.row(f++) << at(x + 1, y), at(x + 1, y + 1), at(x, y + 1);
    }
  }
  return surface;
}

Eigen::SparseMatrix<double> laplacian(const Surface& s) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index f = 0; f < s.faces.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = s.faces(f, k);
      const int b = s.faces(f, (k + 1) % 3);
      for (const auto& [i, j, value] : {std::tuple(a, a, 1.0), {b, b, 1.0}, {a, b, -1.0}, {b, a, -1.0}})
        entries.emplace_back(i, j, value);
    }
  }
  Eigen::SparseMatrix<double> matrix(s.points.rows(), s.points.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Returns the sum of the lengths of all sides, which no order changes.
double length(const Surface& s) {
  double sum = 0;
  for (Eigen::Index f = 0; f < s.faces.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      sum += (s.points.row(s.faces(f, k)) - s.points.row(s.faces(f, (k + 1) % 3))).norm();
  return sum;
}

bool is_near(double a, double b) { return std::abs(a - b) < 1e-9 * std::abs(b); }

bool is_right() {
  Surface surface = sample();
  const Eigen::SparseMatrix<double> before = laplacian(surface);
  const double length_before = length(surface);
  Eigen::VectorXd height = surface.points.col(2);

  // a mesh: points and faces move, and so do the other data of vertices
  const mo::MeshOrder order = mo::reorder(surface.points, surface.faces);
  mo::move_rows(order.vertices.permutation, height);
  const bool mesh_is_same = is_near(length(surface), length_before) && height == surface.points.col(2);

  // a matrix: it has an order of its own
  const auto rows = mo::permutation_matrix(mo::order_vertices(mo::graph_view(before), "rcm").permutation);
  Eigen::SparseMatrix<double> after;
  after = before.twistedBy(rows);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(before.rows());
  const bool matrix_is_same = (after * (rows * x)).isApprox(rows * (before * x));

  // a mesh stored row by row gets the same order, and a transposed mesh is refused
  const Surface again = sample();
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points = again.points;
  const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> faces = again.faces;
  const bool storage_is_all_one =
      mo::order_mesh(points, faces).vertices.permutation == order.vertices.permutation;
  bool transposed_is_refused = false;
  try {
    (void)mo::order_mesh(again.points.transpose().eval(), again.faces);
  } catch (const mo::InvalidArgument& error) {
    transposed_is_refused = true;
    std::printf("transposed: %s\n", error.what());
  }
  return mesh_is_same && matrix_is_same && storage_is_all_one && transposed_is_refused;
}

}  // namespace

int main() {
  try {
    return is_right() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
