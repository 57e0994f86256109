// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/multigrid.hpp"

#include "kernels/block_csr.hpp"
#include "kernels/elasticity.hpp"
#include "kernels/positions.hpp"
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "support/sample_graphs.hpp"
#include <meshorder/error.hpp>
#include <meshorder/permutation.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

struct System {
  std::vector<Point> points;
  BlockCsr matrix;
};

/// h² K + M of the mesh at rest: a stiff body at h = 0.1, K alone (and singular) without mass.
System elastic_system(const Mesh& mesh, double time_step, double mass) {
  System system{mesh.points, zero_block_csr(vertex_graph(mesh))};
  const RestShapes rest = rest_shapes(cut_into_simplices(mesh), mesh.points);
  Elasticity elasticity;
  elasticity.lame = Lame::from_young(1e4, 0.4);
  const AssemblyMap map = assembly_map(rest, system.matrix);
  const Stiffness stiffness{map, system.matrix, time_step * time_step};
  add_elasticity(rest, elasticity, padded_positions(mesh.points), {}, &stiffness);
  for (Index v = 0; v < system.matrix.size(); ++v) {
    double* const diagonal = system.matrix.values.data() + 9 * system.matrix.find(v, v);
    for (int c = 0; c < 3; ++c) diagonal[4 * c] += mass;
  }
  return system;
}

/// Rows and columns of fixed vertices become those of the identity.
void fix(System& system, const std::function<bool(const Point&)>& is_fixed) {
  BlockCsr& a = system.matrix;
  for (Index v = 0; v < a.size(); ++v) {
    for (Offset k = a.offsets[v]; k < a.offsets[v + 1]; ++k) {
      const Index u = a.columns[k];
      if (!is_fixed(system.points[u]) && !is_fixed(system.points[v])) continue;
      for (int i = 0; i < 9; ++i) a.values[9 * k + i] = u == v && i % 4 == 0 ? 1.0 : 0.0;
    }
  }
}

/// A box with its lowest layer fixed and without mass: the worst conditioned.
System fixed_box(Index size) {
  System system = elastic_system(make_grid({.size = size}), 1.0, 0.0);
  const double lowest = std::accumulate(system.points.begin(), system.points.end(), HUGE_VAL,
                                        [](double y, const Point& p) { return std::min(y, p[1]); });
  fix(system, [&](const Point& p) { return p[1] <= lowest; });
  return system;
}

Eigen::MatrixXd dense_inverse_by(const Preconditioner& preconditioner, Index size) {
  Eigen::MatrixXd result(3 * size, 3 * size);
  std::vector<double> r(3 * size, 0.0), z(3 * size);
  for (Eigen::Index i = 0; i < result.cols(); ++i) {
    r[i] = 1;
    preconditioner.apply(r, z);
    result.col(i) = Eigen::Map<const Eigen::VectorXd>(z.data(), result.rows());
    r[i] = 0;
  }
  return result;
}

/// EXPECTs that the preconditioner is symmetric and positive definite, up to the rounding of floats.
void expect_definite(const System& system) {
  const auto multigrid = make_multigrid(system.matrix, system.points);
  multigrid->update(system.matrix);
  const Eigen::MatrixXd dense = dense_inverse_by(*multigrid, system.matrix.size());
  EXPECT_LT((dense - dense.transpose()).cwiseAbs().maxCoeff(), 1e-4 * dense.cwiseAbs().maxCoeff());
  // scaled, as units differ between unknowns
  const Eigen::VectorXd scale = dense.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * dense * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (scaled + scaled.transpose()));
  EXPECT_GT(solver.eigenvalues().minCoeff(), 1e-6);
}

/// Iterations that conjugate gradients need for a relative residual of 1e-6.
int iterations(const System& system, const Preconditioner& preconditioner) {
  using Vector = Eigen::VectorXd;
  const Eigen::Index n = 3 * system.matrix.size();
  Vector b = Vector::NullaryExpr(n, [](Eigen::Index i) { return std::sin(0.7 * static_cast<double>(i)); });
  Vector r = b, z(n), q(n);
  const auto apply = [&] {
    preconditioner.apply({r.data(), static_cast<std::size_t>(n)}, {z.data(), static_cast<std::size_t>(n)});
  };
  apply();
  Vector p = z;
  double rz = r.dot(z);
  for (int iteration = 1; iteration < 500; ++iteration) {
    multiply(system.matrix, {p.data(), static_cast<std::size_t>(n)}, {q.data(), static_cast<std::size_t>(n)});
    r -= rz / p.dot(q) * q;
    if (r.norm() <= 1e-6 * b.norm()) return iteration;
    apply();
    const double before = rz;
    rz = r.dot(z);
    EXPECT_GT(rz, 0.0);
    p = z + rz / before * p;
  }
  return 500;
}

int iterations(const System& system) {
  const auto multigrid = make_multigrid(system.matrix, system.points);
  multigrid->update(system.matrix);
  return iterations(system, *multigrid);
}

Mesh tetrahedra(std::vector<Point> points, const std::vector<std::array<Index, 4>>& cells) {
  Mesh mesh;
  mesh.points = std::move(points);
  for (const auto& cell : cells) mesh.cells.push_back(Shape::tetrahedron, cell);
  return mesh;
}

TEST(Multigrid, IsSymmetricAndPositiveDefinite) {
  expect_definite(elastic_system(make_grid({.size = 4}), 0.1, 1.0));
  expect_definite(elastic_system(make_ball({.size = test::kSanitized ? 4 : 6}), 0.1, 1e-3));
  expect_definite(fixed_box(test::kSanitized ? 4 : 5));
}

TEST(Multigrid, StaysDefiniteWhereTheMatrixIsNot) {
  System system = elastic_system(make_grid({.size = 4}), 0.1, 1.0);
  for (Index v = 0; v < system.matrix.size(); v += 3) {
    double* const diagonal = system.matrix.values.data() + 9 * system.matrix.find(v, v);
    for (int c = 0; c < 3; ++c) diagonal[4 * c] *= -0.5;
  }
  expect_definite(system);
}

TEST(Multigrid, IterationsHardlyGrowWithTheMesh) {
  const int small = iterations(fixed_box(6));
  const int middle = iterations(fixed_box(12));
  const int large = iterations(fixed_box(test::kSanitized ? 16 : 24));
  EXPECT_LE(small, 32);
  EXPECT_LE(middle, small + 8);
  EXPECT_LE(large, middle + 8);
}

TEST(Multigrid, TakesFewIterationsInATimeStep) {
  EXPECT_LE(iterations(elastic_system(make_grid({.size = 20}), 0.1, 1.0)), 25);
}

TEST(Multigrid, GivesTheSameBitsForAnyNumberOfThreads) {
  // large enough for several chunks on two levels
  const System system = fixed_box(test::kSanitized ? 16 : 32);
  std::vector<double> r(3 * system.points.size());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = std::cos(static_cast<double>(i));
  std::vector<double> first;
  for (const std::size_t threads : {1, 2, 3}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const auto multigrid = make_multigrid(system.matrix, system.points);
    multigrid->update(system.matrix);
    multigrid->update(system.matrix);
    std::vector<double> z(r.size());
    multigrid->apply(r, z);
    if (first.empty()) first = z;
    EXPECT_EQ(z, first) << threads << " threads";
  }
}

TEST(Multigrid, UpdatesToWhatItWouldBeMadeOf) {
  const System soft = elastic_system(make_grid({.size = 8}), 0.1, 1.0);
  System stiff = soft;
  for (double& value : stiff.matrix.values) value *= 4;  // a power of two: rounding is the same
  std::vector<double> r(3 * soft.points.size());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = std::cos(static_cast<double>(i));
  std::vector<double> of_stiff(r.size()), of_updated(r.size()), of_soft(r.size());
  const auto multigrid = make_multigrid(soft.matrix, soft.points);
  multigrid->update(soft.matrix);
  multigrid->apply(r, of_soft);
  multigrid->update(stiff.matrix);
  multigrid->apply(r, of_updated);
  EXPECT_EQ(iterations(stiff, *multigrid), iterations(stiff));
  for (std::size_t i = 0; i < r.size(); ++i) ASSERT_NEAR(4 * of_updated[i], of_soft[i], 1e-5) << i;
}

TEST(Multigrid, TakesAnyOrderOfVertices) {
  Mesh mesh = make_ball({.size = 10});
  const int before = iterations(elastic_system(mesh, 0.1, 0.1));
  // 7919 is a prime, so each number v · 7919 mod n occurs once
  const Index n = mesh.vertex_count();
  std::vector<Point> points(n);
  for (Index v = 0; v < n; ++v) points[Offset{v} * 7919 % n] = mesh.points[v];
  mesh.points = points;
  for (Index& v : mesh.cells.vertices) v = static_cast<Index>(Offset{v} * 7919 % n);
  EXPECT_NEAR(iterations(elastic_system(mesh, 0.1, 0.1)), before, 5);
}

TEST(Multigrid, TakesPartsAndVerticesApart) {
  // two boxes, and unused vertices before, between and after them
  const Mesh box = make_grid({.size = test::kSanitized ? 3 : 5});
  Mesh mesh;
  const auto append_box = [&](double x) {
    const Index first = mesh.vertex_count();
    for (const Point& p : box.points) mesh.points.push_back({p[0] + x, p[1], p[2]});
    for (Index cell = 0; cell < box.cell_count(); ++cell) {
      std::vector<Index> vertices(box.cells[cell].begin(), box.cells[cell].end());
      for (Index& v : vertices) v += first;
      mesh.cells.push_back(Shape::tetrahedron, vertices);
    }
  };
  mesh.points.push_back({9, 9, 9});
  append_box(0);
  mesh.points.push_back({9, 9, 8});
  append_box(100);
  mesh.points.push_back({9, 8, 9});
  const System system = elastic_system(mesh, 0.1, 0.5);
  expect_definite(system);
  EXPECT_LE(iterations(system), 30);

  // an isolated vertex is solved exactly
  const auto multigrid = make_multigrid(system.matrix, system.points);
  multigrid->update(system.matrix);
  std::vector<double> r(3 * system.points.size(), 0.0), z(r.size());
  r[1] = 3;
  multigrid->apply(r, z);
  EXPECT_FLOAT_EQ(static_cast<float>(z[1]), 6.0F);
}

/// mass · I
System diagonal_system(std::vector<Point> points, double mass) {
  System system{std::move(points), {}};
  system.matrix = zero_block_csr(graph_from_edges(index_size(system.points), {}));
  for (std::size_t i = 0; i < system.matrix.values.size(); ++i) {
    if (i % 9 % 4 == 0) system.matrix.values[i] = mass;
  }
  return system;
}

TEST(Multigrid, TakesTinyMeshes) {
  const std::vector<Point> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  const System one =
      elastic_system(tetrahedra({corners.begin(), corners.begin() + 4}, {{0, 1, 2, 3}}), 0.1, 1);
  expect_definite(one);
  EXPECT_LE(iterations(one), 12);
  const System two = elastic_system(tetrahedra(corners, {{0, 1, 2, 3}, {1, 2, 3, 4}}), 0.1, 1);
  expect_definite(two);

  const System vertex = diagonal_system({{1, 2, 3}}, 2);
  expect_definite(vertex);
  const auto multigrid = make_multigrid({}, {});
  multigrid->update({});
  multigrid->apply({}, {});
}

TEST(Multigrid, TakesAggregatesWithoutWidth) {
  // points on a line, as if joined by springs, and points in a plane. A rotation about the line moves none of
  // its points
  for (const int dimension : {1, 2}) {
    const Index side = dimension == 1 ? 60 : 8;
    std::vector<Edge> edges;
    std::vector<Point> points;
    const Index n = dimension == 1 ? side : side * side;
    for (Index v = 0; v < n; ++v) {
      const Index column = v % side, row = v / side;
      points.push_back({static_cast<double>(column), static_cast<double>(row), 0});
      if (v % side + 1 < side) edges.push_back({v, v + 1});
      if (v + side < n) edges.push_back({v, v + side});
    }
    System system{points, zero_block_csr(graph_from_edges(n, edges))};
    BlockCsr& a = system.matrix;
    for (Index v = 0; v < n; ++v) {
      double sum = 0.01;
      for (Offset k = a.offsets[v]; k < a.offsets[v + 1]; ++k) {
        if (a.columns[k] == v) continue;
        for (int c = 0; c < 3; ++c) a.values[9 * k + 4 * c] = -1;
        sum += 1;
      }
      for (int c = 0; c < 3; ++c) a.values[9 * a.find(v, v) + 4 * c] = sum;
    }
    expect_definite(system);
    EXPECT_LE(iterations(system), 30);
  }
}

TEST(Multigrid, HoldsNoMoreThanTheMatrix) {
  const System system = fixed_box(20);
  const auto multigrid = make_multigrid(system.matrix, system.points);
  multigrid->update(system.matrix);
  EXPECT_LE(multigrid->bytes(), std::size_t{76} * system.matrix.block_count());
  EXPECT_GE(multigrid->bytes(), std::size_t{18} * system.matrix.block_count());
}

TEST(Multigrid, RefusesOtherSizes) {
  const System system = fixed_box(3);
  EXPECT_THROW(make_multigrid(system.matrix, std::span(system.points).first(5)), InvalidArgument);
  const auto multigrid = make_multigrid(system.matrix, system.points);
  EXPECT_THROW(multigrid->update(fixed_box(4).matrix), InvalidArgument);
  std::vector<double> r(9), z(9);
  EXPECT_THROW(multigrid->apply(r, z), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
