// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cholesky/cholesky.hpp"

#include "base/random.hpp"
#include "kernels/positions.hpp"
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "payoff/deformed.hpp"
#include "simulators/sparse.hpp"
#include "support/sample_graphs.hpp"
#include <meshorder/error.hpp>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <map>
#include <string>

namespace meshorder {
namespace {

using test::dense;
using test::diagonal;
using test::shifted_laplacian;

/// Random numbers in −0.5 … 0.5; the padding is 0.
template <class Real>
std::vector<Real> random_vertices(Index n, std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<Real> result(std::size_t{kPaddedStride} * n);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (i % kPaddedStride != 3) result[i] = static_cast<Real>(random.unit() - 0.5);
  }
  return result;
}

/// The coordinates, a column each, and the padding.
template <class Real>
Eigen::MatrixXd columns_of(const std::vector<Real>& x) {
  using Rows = Eigen::Matrix<Real, Eigen::Dynamic, kPaddedStride, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(x.data(), static_cast<Eigen::Index>(x.size()) / kPaddedStride, kPaddedStride)
      .template cast<double>();
}

template <class Real>
double residual(const SparseMatrix& matrix, const std::vector<Real>& b, const std::vector<Real>& x) {
  double largest = 0;
  for (Index v = 0; v < matrix.size(); ++v) {
    for (Index c = 0; c < kPaddedStride; ++c) {
      auto sum = static_cast<double>(b[kPaddedStride * v + c]);
      for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
        sum -= matrix.values[k] * static_cast<double>(x[kPaddedStride * matrix.columns[k] + c]);
      }
      largest = std::max(largest, std::abs(sum));
    }
  }
  return largest;
}

std::map<std::string, SparseMatrix> small_matrices() {
  std::map<std::string, SparseMatrix> result;
  result["one row"] = diagonal({4.0});
  result["diagonal"] = diagonal({4.0, 1e-3, 7.0, 1e6, 2.0});
  result["path"] = shifted_laplacian(test::path(70), 0.1);
  result["cycle"] = shifted_laplacian(test::cycle(33), 0.1);
  result["arrow"] = shifted_laplacian(test::star(40), 0.1);
  result["grid"] = shifted_laplacian(test::grid(7, 6, 5), 0.1);
  result["hypercube"] = shifted_laplacian(test::hypercube(7), 0.1);
  result["random"] = shifted_laplacian(test::random_connected(150, 200, 3), 0.1);
  result["hubs"] = shifted_laplacian(test::preferential_attachment(200, 3, 4), 0.1);
  result["disconnected"] =
      shifted_laplacian(test::disjoint_union({test::grid(5, 5), test::path(1), test::complete(9),
                                              test::path(3), test::star(12)}),
                        0.1);
  // panels of all widths, with and without rows below
  for (Index n = 2; n <= 20; ++n) {
    result["dense " + std::to_string(n)] = shifted_laplacian(test::complete(n), 0.1);
    result["bipartite " + std::to_string(n)] = shifted_laplacian(test::complete_bipartite(n, 30), 0.1);
  }
  return result;
}

template <class Real>
void expect_dense_solutions(double tolerance) {
  for (const auto& [name, matrix] : small_matrices()) {
    SCOPED_TRACE(name);
    const CholeskyFactor<Real> factor(matrix);
    ASSERT_EQ(factor.size(), matrix.size());
    const std::vector<Real> b = random_vertices<Real>(matrix.size());
    const Eigen::MatrixXd expected = dense(matrix).ldlt().solve(columns_of(b));
    test::for_each_target([&](const char* target) {
      SCOPED_TRACE(target);
      std::vector<Real> x(b.size(), Real{7});
      factor.solve(b, x);
      EXPECT_LT((columns_of(x) - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff());
      EXPECT_EQ(columns_of(x).col(3).cwiseAbs().maxCoeff(), 0.0);
    });
  }
}

TEST(CholeskyFactor, SolvesSmallSystemsAsADenseSolverDoes) { expect_dense_solutions<double>(1e-12); }

TEST(CholeskyFactor, SolvesThemInSinglePrecision) { expect_dense_solutions<float>(3e-4); }

/// Large enough for several tasks.
SparseMatrix large_matrix() {
  static const SparseMatrix matrix =
      shifted_laplacian(vertex_graph(make_grid({.size = test::kSanitized ? 10 : 15})), 0.01);
  return matrix;
}

TEST(CholeskyFactor, LeavesNoResidualInAGridOfTetrahedra) {
  const SparseMatrix matrix = large_matrix();
  const CholeskyFactor<double> factor(matrix);
  const std::vector<double> b = random_vertices<double>(matrix.size());
  std::vector<double> x(b.size());
  factor.solve(b, x);
  EXPECT_LT(residual(matrix, b, x), 1e-11);

  const CholeskyFactor<float> single(matrix);
  const std::vector<float> rounded_b(b.begin(), b.end());
  std::vector<float> rounded_x(b.size());
  single.solve(rounded_b, rounded_x);
  EXPECT_LT(residual(matrix, rounded_b, rounded_x), 3e-3);
  EXPECT_LT(single.bytes(), factor.bytes());
}

TEST(CholeskyFactor, SolvesManySeparatePieces) {
  const CsrGraph piece = test::grid(9, 9, 4);
  const SparseMatrix matrix = shifted_laplacian(test::disjoint_union(std::vector<CsrGraph>(60, piece)), 0.1);
  const CholeskyFactor<double> factor(matrix);
  const std::vector<double> b = random_vertices<double>(matrix.size());
  std::vector<double> x(b.size());
  factor.solve(b, x);
  EXPECT_LT(residual(matrix, b, x), 1e-12);
}

TEST(CholeskyFactor, SolvesInPlace) {
  const SparseMatrix matrix = large_matrix();
  const CholeskyFactor<double> factor(matrix);
  std::vector<double> x = random_vertices<double>(matrix.size());
  std::vector<double> expected(x.size());
  factor.solve(x, expected);
  factor.solve(x, x);
  EXPECT_EQ(x, expected);
}

/// Every seventh vertex of the first ninth, unsorted and some twice.
std::vector<Index> some_vertices(Index n) {
  std::vector<Index> vertices;
  for (Index v = 0; v < n / 9; v += 7) {
    vertices.push_back(v);
    vertices.insert(vertices.begin(), v / 2);
  }
  return vertices;
}

template <class Real>
void expect_same_bits() {
  const SparseMatrix matrix = large_matrix();
  const std::vector<Real> b = random_vertices<Real>(matrix.size());
  std::vector<Real> first, first_in_reach;
  for (const std::size_t threads : {1, 2, 3, 5}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const CholeskyFactor<Real> factor(matrix);
    std::vector<Real> x(b.size()), in_reach(b.size());
    factor.solve(b, x);
    factor.solve(factor.reach_of(some_vertices(matrix.size())), b, in_reach);
    if (threads == 1) {
      first = x;
      first_in_reach = in_reach;
    }
    EXPECT_EQ(x, first) << threads << " threads";
    EXPECT_EQ(in_reach, first_in_reach) << threads << " threads";
    factor.solve(b, x);
    EXPECT_EQ(x, first) << "the second time on " << threads << " threads";
  }
}

TEST(CholeskyFactor, GivesTheSameBitsOnAnyNumberOfThreads) {
  expect_same_bits<double>();
  expect_same_bits<float>();
}

/// Compares the full solve with that of the reach, for a right-hand side that is 0 outside the reach. The
/// solve of the reach must not read or write outside it.
template <class Real>
void expect_full_solution(const SparseMatrix& matrix, const std::vector<Index>& vertices, double tolerance) {
  const CholeskyFactor<Real> factor(matrix);
  const FactorReach reach = factor.reach_of(vertices);
  const std::vector<Real> some = random_vertices<Real>(matrix.size());
  const Real unread = std::numeric_limits<Real>::quiet_NaN();
  const Real unwritten = 99;
  std::vector<Real> b(some.size(), Real{0}), b_of_reach(some.size(), unread);
  for (const Index v : vertices) {
    for (Index c = 0; c < kPaddedStride; ++c) {
      b[kPaddedStride * v + c] = b_of_reach[kPaddedStride * v + c] = some[kPaddedStride * v + c];
    }
  }
  test::for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    std::vector<Real> expected(b.size()), x(b.size(), unwritten);
    factor.solve(b, x);
    std::fill(expected.begin(), expected.end(), unwritten);
    for (const Index v : vertices) {
      std::copy_n(x.begin() + kPaddedStride * v, kPaddedStride, expected.begin() + kPaddedStride * v);
    }
    std::fill(x.begin(), x.end(), unwritten);
    factor.solve(reach, b_of_reach, x);
    const double scale = columns_of(expected).cwiseAbs().maxCoeff();
    EXPECT_LE((columns_of(x) - columns_of(expected)).cwiseAbs().maxCoeff(), tolerance * scale);
    std::vector<Real> in_place = b_of_reach;
    factor.solve(reach, in_place, in_place);
    for (const Index v : vertices) {
      for (Index c = 0; c < kPaddedStride; ++c) {
        ASSERT_EQ(in_place[kPaddedStride * v + c], x[kPaddedStride * v + c]);
      }
    }
  });
}

TEST(CholeskyFactor, SolvesOnAReachAsInFull) {
  for (const auto& [name, matrix] : small_matrices()) {
    SCOPED_TRACE(name);
    const Index n = matrix.size();
    std::vector<Index> all(n);
    std::iota(all.begin(), all.end(), 0);
    for (const std::vector<Index>& vertices : {std::vector<Index>{}, {n - 1}, {n / 2, 0, n / 2}, all}) {
      expect_full_solution<double>(matrix, vertices, 1e-14);
      expect_full_solution<float>(matrix, vertices, 1e-6);
    }
  }
}

TEST(CholeskyFactor, SolvesOnAReachAcrossTasks) {
  const SparseMatrix matrix = large_matrix();
  expect_full_solution<double>(matrix, {matrix.size() / 2}, 1e-14);
  expect_full_solution<double>(matrix, some_vertices(matrix.size()), 1e-14);
  expect_full_solution<float>(matrix, some_vertices(matrix.size()), 1e-6);
  const SparseMatrix pieces =
      shifted_laplacian(test::disjoint_union(std::vector<CsrGraph>(60, test::grid(9, 9, 4))), 0.1);
  expect_full_solution<double>(pieces, some_vertices(pieces.size()), 1e-14);
}

TEST(CholeskyFactor, ReachesASmallPartFromFewVertices) {
  const CholeskyFactor<double> factor(shifted_laplacian(test::grid(120, 120), 0.1));
  std::vector<Index> all(factor.size());
  std::iota(all.begin(), all.end(), 0);
  const FactorReach everything = factor.reach_of(all);
  EXPECT_GE(everything.entries, factor.entries());
  EXPECT_LT(everything.entries, factor.entries() * 3 / 2);
  const FactorReach corner = factor.reach_of(std::vector<Index>{0, 1, 120});
  EXPECT_LT(corner.entries, everything.entries / 10);
  EXPECT_TRUE(std::is_sorted(corner.panels.begin(), corner.panels.end()));
  EXPECT_EQ(factor.reach_of({}).entries, 0);
}

/// The message with which a factor of `matrix` is refused.
std::string refusal(const SparseMatrix& matrix) {
  try {
    const CholeskyFactor<double> factor(matrix);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(CholeskyFactor, RefusesMatricesThatAreNotPositiveDefinite) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal(diagonal({1, 2, -3, 4})), HasSubstr("not positive definite: row 2 "));
  EXPECT_THAT(refusal(diagonal({1, 0, 3})), HasSubstr("row 1 "));
  EXPECT_THAT(refusal(diagonal({0})), HasSubstr("row 0 "));
  EXPECT_THAT(refusal(diagonal({1, 2, std::nan("")})), HasSubstr("row 2 "));
  SparseMatrix indefinite = shifted_laplacian(test::grid(6, 7), 0.1);
  for (Offset k = indefinite.offsets[20]; k < indefinite.offsets[21]; ++k) {
    if (indefinite.columns[k] == 20) indefinite.values[k] -= 5;
  }
  EXPECT_THAT(refusal(indefinite), HasSubstr("not positive definite: row "));
}

TEST(CholeskyFactor, RefusesForTheSameRowOnAnyNumberOfThreads) {
  SparseMatrix matrix = large_matrix();
  // far from each other, in the work of different threads
  for (const Index row : {5, matrix.size() / 2, matrix.size() - 5}) {
    for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
      if (matrix.columns[k] == row) matrix.values[k] = -1;
    }
  }
  std::string first;
  for (const std::size_t threads : {1, 2, 3, 5}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const std::string message = refusal(matrix);
    if (threads == 1) first = message;
    EXPECT_THAT(message, testing::HasSubstr("not positive definite: row "));
    EXPECT_EQ(message, first) << threads << " threads";
  }
}

TEST(CholeskyFactor, RefusesSingularMatricesWhateverRoundingLeaves) {
  for (const CsrGraph& graph :
       {test::path(2), test::path(1000), test::cycle(77), test::complete(40), test::star(500),
        test::grid(30, 40), test::grid(12, 11, 10), test::random_connected(500, 800, 1),
        test::disjoint_union({test::path(4), test::grid(20, 20)})}) {
    for (const bool weighted : {false, true}) {
      EXPECT_THAT(refusal(shifted_laplacian(graph, 0.0, weighted)), testing::HasSubstr("row "))
          << graph.size() << " vertices";
      EXPECT_EQ(refusal(shifted_laplacian(graph, 1e-9, weighted)), "") << graph.size() << " vertices";
    }
  }
}

TEST(CholeskyFactor, RefusesVectorsOfAnotherSizeAndVerticesThatDoNotExist) {
  const CholeskyFactor<double> factor(diagonal({1, 2}));
  std::vector<double> right(8), wrong(6);
  EXPECT_THROW(factor.solve(wrong, right), InvalidArgument);
  EXPECT_THROW(factor.solve(right, wrong), InvalidArgument);
  EXPECT_THROW(factor.solve(factor.reach_of({}), right, wrong), InvalidArgument);
  EXPECT_THROW((void)factor.reach_of(std::vector<Index>{2}), InvalidArgument);
  EXPECT_THROW((void)factor.reach_of(std::vector<Index>{-1}), InvalidArgument);
}

TEST(CholeskyFactor, OfNothingSolvesNothing) {
  const CholeskyFactor<double> factor{SparseMatrix{}};
  EXPECT_EQ(factor.size(), 0);
  EXPECT_EQ(factor.entries(), 0);
  factor.solve({}, {});
  factor.solve(factor.reach_of({}), {}, {});
}

TEST(CholeskyFactor, CountsEntriesWithTheDiagonal) {
  EXPECT_EQ(CholeskyFactor<double>(diagonal({1, 2, 3})).entries(), 3);
  EXPECT_EQ(CholeskyFactor<double>(shifted_laplacian(test::complete(20), 0.1)).entries(), 20 * 21 / 2);
  EXPECT_EQ(CholeskyFactor<double>(shifted_laplacian(test::star(20), 0.1)).entries(), 39);
}

}  // namespace
}  // namespace meshorder
