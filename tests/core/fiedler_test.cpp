// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/fiedler.hpp"

#include "graph/traversal.hpp"
#include "support/clustered_graphs.hpp"
#include "support/dense.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

namespace meshorder {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Index kDenseSize = test::kSanitized ? 120 : 400;  // the largest size for dense solvers

double path_lambda2(Index n) { return 2 - 2 * std::cos(kPi / n); }

FiedlerOptions to(double tolerance) {
  FiedlerOptions options;
  options.tolerance = tolerance;
  return options;
}

double sum_of_squares(const FiedlerVectors& result, std::size_t component) {
  double sum = 0;
  for (const Index v : result.component_vertices[component]) sum += result.values[v] * result.values[v];
  return sum;
}

/// ‖L x − λ x‖ / ‖x‖ from the graph and the values alone.
double true_residual(const CsrGraph& graph, const FiedlerVectors& result, std::size_t component) {
  double squares = 0;
  for (const Index v : result.component_vertices[component]) {
    double r = -result.components[component].lambda2 * result.values[v];
    for (const Index u : graph[v]) r += result.values[v] - result.values[u];
    squares += r * r;
  }
  return std::sqrt(squares / sum_of_squares(result, component));
}

/// Σ over edges of squared differences divided by Σ of squares.
double rayleigh_quotient(const CsrGraph& graph, const FiedlerVectors& result, std::size_t component) {
  double sum = 0;
  for (const Index v : result.component_vertices[component]) {
    for (const Index u : graph[v]) {
      if (u < v) sum += std::pow(result.values[u] - result.values[v], 2);
    }
  }
  return sum / sum_of_squares(result, component);
}

/// EXPECTs the properties that every result has, converged or not.
void expect_sound(const CsrGraph& graph, const FiedlerVectors& result, const FiedlerOptions& options = {}) {
  ASSERT_EQ(index_size(result.values), graph.size());
  ASSERT_EQ(result.component_vertices, connected_components(graph));
  ASSERT_EQ(result.components.size(), result.component_vertices.size());
  for (std::size_t c = 0; c < result.components.size(); ++c) {
    const FiedlerComponent& report = result.components[c];
    const std::vector<Index>& vertices = result.component_vertices[c];
    ASSERT_EQ(report.size, index_size(vertices));
    if (report.size == 1) {
      ASSERT_EQ(result.values[vertices[0]], 0);
      ASSERT_EQ(report.lambda2, 0);
      ASSERT_TRUE(report.converged);
      continue;
    }
    double sum = 0;
    double largest = 0;
    Index largest_degree = 0;
    for (const Index v : vertices) {
      ASSERT_TRUE(std::isfinite(result.values[v]));
      sum += result.values[v];
      largest = std::max(largest, std::abs(result.values[v]));
      largest_degree = std::max(largest_degree, graph.degree(v));
    }
    ASSERT_NEAR(sum, 0, 1e-9 * std::sqrt(report.size));
    ASSERT_NEAR(sum_of_squares(result, c), 1, 1e-12);
    const auto first = std::find_if(vertices.begin(), vertices.end(),
                                    [&](Index v) { return std::abs(result.values[v]) >= 0.5 * largest; });
    ASSERT_NE(first, vertices.end());
    ASSERT_LT(result.values[*first], 0);

    const double rounding = 4e-16 * largest_degree + 1e-15 * report.lambda2;
    ASSERT_NEAR(rayleigh_quotient(graph, result, c), report.lambda2, rounding + 1e-11 * report.lambda2);
    ASSERT_NEAR(true_residual(graph, result, c), report.residual, rounding + 1e-6 * report.residual);
    if (report.converged) {
      ASSERT_LE(true_residual(graph, result, c), options.tolerance * report.lambda2 + rounding);
    } else {
      ASSERT_GT(report.residual, options.tolerance * report.lambda2);
    }
  }
}

/// Solves a connected graph and EXPECTs it to converge to λ₂, and to x where that is given (up to the sign).
void expect_eigenpair(const CsrGraph& graph, double lambda2, const std::vector<double>& x = {}) {
  SCOPED_TRACE(std::to_string(graph.size()) + " vertices, " + std::to_string(graph.edge_count()) + " edges");
  const FiedlerOptions options = to(1e-8);
  const FiedlerVectors result = fiedler_vectors(graph, options);
  expect_sound(graph, result, options);
  ASSERT_EQ(result.components.size(), 1U);
  EXPECT_TRUE(result.components[0].converged);
  EXPECT_NEAR(result.components[0].lambda2, lambda2, 1e-8 * lambda2);
  if (x.empty()) return;
  const double norm = std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), 0.0));
  const double product = std::inner_product(x.begin(), x.end(), result.values.begin(), 0.0) / norm;
  EXPECT_NEAR(std::abs(product), 1, 1e-10);
}

TEST(FiedlerVector, OfAPathIsACosine) {
  for (const Index n : {2, 3, 4, 7, 50, 100, 101, 102, 333, 1000, 3000}) {
    std::vector<double> cosine(n);
    for (Index k = 0; k < n; ++k) cosine[k] = std::cos(kPi * (k + 0.5) / n);
    expect_eigenpair(test::path(n), path_lambda2(n), cosine);
    if (HasFatalFailure()) return;
  }
}

TEST(FiedlerVector, OfACycleLiesInItsPlaneOfTwo) {
  for (const Index n : {3, 4, 9, 100, 101, 500, 2000}) {
    const CsrGraph cycle = test::cycle(n);
    expect_eigenpair(cycle, 2 - 2 * std::cos(2 * kPi / n));
    const FiedlerVectors result = fiedler_vectors(cycle, to(1e-8));
    double cosine = 0;
    double sine = 0;
    for (Index k = 0; k < n; ++k) {
      cosine += result.values[k] * std::cos(2 * kPi * k / n) * std::sqrt(2.0 / n);
      sine += result.values[k] * std::sin(2 * kPi * k / n) * std::sqrt(2.0 / n);
    }
    EXPECT_NEAR(cosine * cosine + sine * sine, 1, 1e-10) << n;
  }
}

TEST(FiedlerVector, OfAGridFollowsItsLongestSide) {
  const std::vector<std::array<Index, 3>> sides{{5, 3, 1},  {20, 10, 1}, {60, 20, 1}, {101, 2, 1},
                                                {30, 5, 4}, {12, 11, 9}, {20, 6, 5},  {41, 40, 1}};
  for (const auto& [a, b, c] : sides) {
    std::vector<double> cosine;
    for (Index v = 0; v < a * b * c; ++v) cosine.push_back(std::cos(kPi * (v % a + 0.5) / a));
    expect_eigenpair(test::grid(a, b, c), path_lambda2(a), cosine);
  }
}

TEST(FiedlerVector, OfSquaresAndCubesHasTheMultipleEigenvalue) {
  expect_eigenpair(test::grid(9, 9), path_lambda2(9));
  expect_eigenpair(test::grid(40, 40), path_lambda2(40));
  expect_eigenpair(test::grid(12, 12, 12), path_lambda2(12));
}

TEST(FiedlerVector, OfStarsCompleteGraphsAndHypercubes) {
  for (const Index n : {3, 4, 60, 100, 101, 102, 400}) expect_eigenpair(test::star(n), 1);
  for (const Index n : {2, 3, 60, 100, 101, 102, 300}) expect_eigenpair(test::complete(n), n);
  for (int d = 1; d <= 10; ++d) expect_eigenpair(test::hypercube(d), 2);
}

TEST(FiedlerVector, OfACompleteBipartiteGraphIsTheSmallerSide) {
  const std::vector<std::pair<Index, Index>> sides{{1, 2},   {2, 2},   {3, 5},  {7, 40},
                                                   {60, 50}, {3, 200}, {90, 90}};
  for (const auto& [a, b] : sides) expect_eigenpair(test::complete_bipartite(a, b), std::min(a, b));
}

TEST(FiedlerVector, SeparatesCloseEigenvalues) {
  // a spider: three paths from one centre; the two longest legs hold the vector
  std::vector<Edge> edges;
  Index next = 1;
  const std::array<Index, 3> legs =
      test::kSanitized ? std::array<Index, 3>{60, 59, 58} : std::array<Index, 3>{200, 198, 196};
  for (const Index length : legs) {
    for (Index k = 0; k < length; ++k, ++next) edges.push_back({k == 0 ? 0 : next - 1, next});
  }
  const CsrGraph spider = graph_from_edges(next, edges);
  const auto exact = test::dense_eigen(spider);
  ASSERT_LT(exact.eigenvalues()[2], 1.05 * exact.eigenvalues()[1]);
  const Eigen::VectorXd vector = exact.eigenvectors().col(1);
  expect_eigenpair(spider, exact.eigenvalues()[1], {vector.begin(), vector.end()});
}

TEST(FiedlerVector, OfRandomGraphsIsThatOfTheDenseSolver) {
  for (const Index n : {5, 20, 99, 100, 101, 102, 130, 200}) {
    for (const Index extra : {0, n / 10, n, 6 * n}) {
      for (const std::uint64_t seed : {1U, 2U}) {
        if (test::kSanitized && n > 102) continue;
        const CsrGraph graph = test::random_connected(n, extra, seed);
        const auto exact = test::dense_eigen(graph);
        const double lambda2 = exact.eigenvalues()[1];
        const bool simple = exact.eigenvalues()[2] > 1.01 * lambda2;
        const Eigen::VectorXd vector = exact.eigenvectors().col(1);
        expect_eigenpair(graph, lambda2,
                         simple ? std::vector<double>(vector.begin(), vector.end()) : std::vector<double>{});
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(FiedlerVector, OfEveryGraphOfUpToFourVertices) {
  for (Index n = 0; n <= 4; ++n) {
    std::vector<Edge> all;
    for (Index b = 0; b < n; ++b) {
      for (Index a = 0; a < b; ++a) all.push_back({a, b});
    }
    for (unsigned chosen = 0; chosen < 1U << all.size(); ++chosen) {
      SCOPED_TRACE(std::to_string(n) + " vertices, edges " + std::to_string(chosen));
      std::vector<Edge> edges;
      for (std::size_t e = 0; e < all.size(); ++e) {
        if ((chosen >> e & 1U) != 0) edges.push_back(all[e]);
      }
      const CsrGraph graph = graph_from_edges(n, edges);
      const FiedlerVectors result = fiedler_vectors(graph);
      expect_sound(graph, result);
      for (std::size_t c = 0; c < result.components.size(); ++c) {
        if (result.components[c].size == 1) continue;
        const auto exact = test::dense_eigen(induced_subgraph(graph, result.component_vertices[c]));
        EXPECT_NEAR(result.components[c].lambda2, exact.eigenvalues()[1], 1e-13);
        EXPECT_TRUE(result.components[c].converged);
        EXPECT_EQ(result.components[c].iterations, 0);
      }
    }
  }
}

TEST(FiedlerVector, SolvesEachComponentAsIfItWereAlone) {
  const std::vector<CsrGraph> parts{test::path(3),        test::path(1), test::random_connected(400, 300, 5),
                                    test::grid(30, 20),   test::path(2), test::path(1),
                                    test::grid(30, 20, 1)};
  const CsrGraph graph = test::disjoint_union(parts);
  const FiedlerVectors result = fiedler_vectors(graph);
  expect_sound(graph, result);
  std::vector<Index> sizes;
  for (const FiedlerComponent& report : result.components) sizes.push_back(report.size);
  EXPECT_EQ(sizes, (std::vector<Index>{600, 600, 400, 3, 2, 1, 1}));

  Index first = 0;
  for (const CsrGraph& part : parts) {
    const FiedlerVectors alone = fiedler_vectors(part);
    const std::vector<double> here(result.values.begin() + first,
                                   result.values.begin() + first + part.size());
    EXPECT_EQ(here, alone.values) << "component at vertex " << first;
    first += part.size();
  }
}

TEST(FiedlerVector, IsTheSameBitsOnEveryRun) {
  for (const CsrGraph& graph : {test::grid(30, 30), test::random_connected(2000, 3000, 3), test::star(300)}) {
    FiedlerOptions options;
    options.seed = 4;
    const FiedlerVectors once = fiedler_vectors(graph, options);
    const FiedlerVectors again = fiedler_vectors(graph, options);
    EXPECT_EQ(once.values, again.values);
    EXPECT_EQ(once.components[0].iterations, again.components[0].iterations);
  }
}

TEST(FiedlerVector, DoesNotDependOnTheNumberingBeyondRounding) {
  const CsrGraph graph = test::random_connected(1500, 700, 8);
  const Permutation order = test::shuffled(graph.size(), 2);
  const FiedlerVectors plain = fiedler_vectors(graph, to(1e-8));
  const FiedlerVectors renamed = fiedler_vectors(renumbered(graph, order.old_to_new()), to(1e-8));
  EXPECT_NEAR(plain.components[0].lambda2, renamed.components[0].lambda2, 1e-12);
  double product = 0;
  for (Index v = 0; v < graph.size(); ++v) product += plain.values[v] * renamed.values[order.old_to_new()[v]];
  EXPECT_NEAR(std::abs(product), 1, 1e-9);
}

TEST(FiedlerVector, SaysSoWhenIterationsRunOut) {
  FiedlerOptions options = to(1e-12);
  options.max_iterations = 1;
  const CsrGraph path = test::path(20000);
  const FiedlerVectors result = fiedler_vectors(path, options);
  expect_sound(path, result, options);
  EXPECT_FALSE(result.components[0].converged);
  EXPECT_EQ(result.components[0].iterations, 1);
  options.max_iterations = 0;
  const FiedlerVectors at_start = fiedler_vectors(path, options);
  expect_sound(path, at_start, options);
  EXPECT_EQ(at_start.components[0].iterations, 0);
}

TEST(FiedlerVector, DoesNotClaimMoreThanRoundingAllows) {
  // rounding leaves a residual of about 1e-15, a hundred times the requested one
  FiedlerOptions options = to(1e-11);
  options.max_iterations = 200;
  const CsrGraph path = test::path(5000);
  const FiedlerVectors result = fiedler_vectors(path, options);
  expect_sound(path, result, options);
  EXPECT_FALSE(result.components[0].converged);
  EXPECT_NEAR(result.components[0].lambda2, path_lambda2(5000), 1e-14);
}

TEST(FiedlerVector, OfALongPath) {
  const Index n = test::large(100000);
  const CsrGraph path = test::path(n);
  const FiedlerVectors result = fiedler_vectors(path, to(1e-4));
  expect_sound(path, result, to(1e-4));
  EXPECT_TRUE(result.components[0].converged);
  EXPECT_NEAR(result.components[0].lambda2, path_lambda2(n), 1e-6 * path_lambda2(n));
  EXPECT_LE(result.components[0].iterations, 100);
}

TEST(FiedlerVector, OfALongCycleAndALongComb) {
  const Index n = test::large(50000);
  const CsrGraph cycle = test::cycle(n);
  const FiedlerVectors of_cycle = fiedler_vectors(cycle);
  expect_sound(cycle, of_cycle);
  EXPECT_TRUE(of_cycle.components[0].converged);
  // a path with a leaf at each vertex: λ (λ − 2) = (λ − 1) μ for the path's eigenvalue μ
  std::vector<Edge> edges;
  for (Index v = 0; v < n; ++v) {
    edges.push_back({v, n + v});
    if (v > 0) edges.push_back({v - 1, v});
  }
  const CsrGraph comb = graph_from_edges(2 * n, edges);
  const FiedlerVectors of_comb = fiedler_vectors(comb, to(1e-3));
  expect_sound(comb, of_comb, to(1e-3));
  EXPECT_TRUE(of_comb.components[0].converged);
  const double mu = path_lambda2(n);
  const double lambda = 2 * mu / (2 + mu + std::sqrt(4 + mu * mu));
  EXPECT_NEAR(of_comb.components[0].lambda2, lambda, 1e-5 * lambda);
}

TEST(FiedlerVector, OfLargeStars) {
  for (const bool centre_first : {true, false}) {
    const Index n = test::large(100000);
    const CsrGraph star = test::star(n);
    std::vector<Index> reversed(n);
    for (Index v = 0; v < n; ++v) reversed[v] = n - 1 - v;
    const CsrGraph graph = centre_first ? star : renumbered(star, reversed);
    const FiedlerVectors result = fiedler_vectors(graph);
    expect_sound(graph, result);
    EXPECT_TRUE(result.components[0].converged);
    EXPECT_NEAR(result.components[0].lambda2, 1, 0.01);
  }
}

TEST(FiedlerVector, OfALargeCompleteGraph) {
  const CsrGraph complete = test::complete(1000);
  const FiedlerVectors result = fiedler_vectors(complete, to(1e-8));
  expect_sound(complete, result, to(1e-8));
  EXPECT_TRUE(result.components[0].converged);
  EXPECT_NEAR(result.components[0].lambda2, 1000, 1e-8);
}

TEST(FiedlerVector, OfAnExpander) {
  const CsrGraph small = test::random_regular(kDenseSize, 6, 1);
  expect_eigenpair(small, test::dense_eigen(small).eigenvalues()[1]);
  const CsrGraph graph = test::random_regular(test::large(10000), 6, 1);
  const FiedlerVectors result = fiedler_vectors(graph, to(1e-3));
  expect_sound(graph, result, to(1e-3));
  EXPECT_TRUE(result.components[0].converged);
  // Friedman's theorem: d − 2 √(d − 1) in the limit
  EXPECT_NEAR(result.components[0].lambda2, 6 - 2 * std::sqrt(5.0), 0.1);
}

TEST(FiedlerVector, OfAPowerLawGraph) {
  for (const Index m : {1, 3}) {
    const CsrGraph small = test::preferential_attachment(kDenseSize, m, 1);
    expect_eigenpair(small, test::dense_eigen(small).eigenvalues()[1]);
    const CsrGraph graph = test::preferential_attachment(test::large(10000), m, 1);
    const FiedlerVectors result = fiedler_vectors(graph);
    expect_sound(graph, result);
    EXPECT_TRUE(result.components[0].converged);
  }
}

TEST(FiedlerVector, OfManySmallComponents) {
  std::vector<CsrGraph> parts;
  for (Index k = 0; k < 10000; ++k)
    parts.push_back(k % 3 == 0 ? test::path(k % 7 + 1) : test::star(k % 5 + 2));
  const CsrGraph graph = test::disjoint_union(parts);
  const FiedlerVectors result = fiedler_vectors(graph);
  ASSERT_EQ(result.components.size(), 10000U);
  expect_sound(graph, result);
  EXPECT_TRUE(std::all_of(result.components.begin(), result.components.end(),
                          [](const FiedlerComponent& report) { return report.converged; }));
}

TEST(FiedlerVector, OfManyIsolatedVertices) {
  const CsrGraph graph = test::disjoint_union({graph_from_edges(50000, {}), test::path(500)});
  const FiedlerVectors result = fiedler_vectors(graph);
  expect_sound(graph, result);
  EXPECT_EQ(result.components[0].size, 500);
}

/// A weight for every neighbour, the same in both rows of an edge.
template <class WeightOf>
std::vector<double> weights_of(const CsrGraph& graph, WeightOf weight_of) {
  std::vector<double> weights;
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) weights.push_back(weight_of(std::min(u, v), std::max(u, v)));
  }
  return weights;
}

TEST(FiedlerVector, OfWeightsThatAreAllOneIsThatWithoutWeights) {
  const CsrGraph graph = test::grid(40, 15);
  const FiedlerVectors plain = fiedler_vectors(graph);
  const FiedlerVectors weighted = fiedler_vectors(graph, weights_of(graph, [](Index, Index) { return 1.0; }));
  for (Index v = 0; v < graph.size(); ++v) EXPECT_NEAR(weighted.values[v], plain.values[v], 1e-12);
}

TEST(FiedlerVector, OfWeightedGraphsIsThatOfTheDenseSolver) {
  for (const double decades : {1.0, 3.0, 6.0}) {
    const CsrGraph graph = test::random_connected(kDenseSize, 3 * kDenseSize, 5);
    const auto weights = weights_of(graph, [&](Index a, Index b) {
      return std::pow(10.0, decades * ((7919 * a + 104729 * b) % 1000 / 1000.0 - 0.5));
    });
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(graph.size(), graph.size());
    for (Index v = 0; v < graph.size(); ++v) {
      for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
        matrix(v, v) += weights[k];
        matrix(v, graph.neighbours[k]) -= weights[k];
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> exact(matrix);
    const FiedlerVectors result = fiedler_vectors(graph, weights, to(1e-6));
    ASSERT_TRUE(result.components[0].converged) << decades;
    EXPECT_NEAR(result.components[0].lambda2 / exact.eigenvalues()[1], 1, 1e-6) << decades;
    double along = 0;
    for (Index v = 0; v < graph.size(); ++v) along += result.values[v] * exact.eigenvectors()(v, 1);
    EXPECT_GT(std::abs(along), 1 - 1e-6) << decades;
  }
}

TEST(FiedlerVector, CutsWhereTheWeightsAreWeak) {
  // twelve decades: two halves of strong edges, joined by weak ones
  const CsrGraph graph = test::grid(40, 25);
  const auto half = [](Index v) { return v / 25 < 20; };
  const FiedlerVectors result = fiedler_vectors(
      graph, weights_of(graph, [&](Index a, Index b) { return half(a) == half(b) ? 1e6 : 1e-6; }));
  // λ₂ is that of two vertices of mass 500 joined by 25 weak edges. It is 14 decades below the largest
  // eigenvalue, where the vector itself has few digits left
  EXPECT_GE(result.components[0].lambda2, 0.999 * 25e-6 * 2 / 500);
  EXPECT_LT(result.components[0].lambda2, 3 * 25e-6 * 2 / 500);
  for (Index v = 1; v < graph.size(); ++v) {
    EXPECT_EQ(result.values[v] < 0, (result.values[0] < 0) == (half(v) == half(0)));
  }
}

TEST(FiedlerVector, ReturnsOnWeightsOverTwelveDecades) {
  for (const CsrGraph& graph : {test::grid(60, 50), test::random_connected(test::large(20000), 30000, 3),
                                test::path(test::large(20000))}) {
    const auto weights = weights_of(graph, [](Index a, Index b) {
      return std::pow(10.0, 12 * (static_cast<double>((7919LL * a + 104729LL * b) % 1000) / 1000 - 0.5));
    });
    FiedlerOptions options = to(0.1);
    options.max_iterations = 100;
    const FiedlerVectors result = fiedler_vectors(graph, weights, options);
    const FiedlerComponent& component = result.components[0];
    EXPECT_TRUE(std::isfinite(component.lambda2));
    EXPECT_GE(component.lambda2, 0);
    EXPECT_EQ(component.converged, component.residual <= 0.1 * component.lambda2);
    for (const double value : result.values) ASSERT_TRUE(std::isfinite(value));
  }
}

TEST(FiedlerVector, RejectsWeightsThatAreNone) {
  const CsrGraph graph = test::path(3);
  EXPECT_THROW(fiedler_vectors(graph, std::vector<double>{1, 1, 1}), InvalidArgument);
  EXPECT_THROW(fiedler_vectors(graph, std::vector<double>{1, 1, 0, 1}), InvalidArgument);
  EXPECT_THROW(fiedler_vectors(graph, std::vector<double>{1, -1, -1, 1}), InvalidArgument);
  EXPECT_THROW(fiedler_vectors(graph, std::vector<double>{1, 1, NAN, 1}), InvalidArgument);
  EXPECT_THROW(fiedler_vectors(graph, std::vector<double>{1, 1, INFINITY, 1}), InvalidArgument);
}

/// The second-smallest eigenvalue of a weighted Laplacian.
double dense_lambda2(const CsrGraph& graph, const std::vector<double>& weights) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(graph.size(), graph.size());
  for (Index v = 0; v < graph.size(); ++v) {
    for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
      const double weight = weights.empty() ? 1 : weights[k];
      matrix(v, v) += weight;
      matrix(v, graph.neighbours[k]) -= weight;
    }
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[1];
}

TEST(FiedlerVector, OfClusteredGraphsIsNoOtherEigenvector) {
  // at the default tolerance, x may mix eigenvectors whose eigenvalues differ by less than the 20 % below
  const std::uint64_t count = test::kSanitized ? 60 : 2600;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const test::ClusteredGraph clustered = test::clustered_graph(seed);
    const FiedlerVectors result = fiedler_vectors(clustered.graph, clustered.weights);
    ASSERT_EQ(result.components.size(), 1U);
    ASSERT_TRUE(result.components[0].converged) << clustered.name << ", seed " << seed;
    const double exact = dense_lambda2(clustered.graph, clustered.weights);
    ASSERT_LE(result.components[0].lambda2, 1.2 * exact) << clustered.name << ", seed " << seed;
  }
}

TEST(FiedlerVector, OfTwoCliquesAndABridgeCutsTheBridge) {
  for (const Index half : {60, 61, 200, 300}) {
    std::vector<Edge> edges{{0, half}};
    for (Index a = 0; a < half; ++a) {
      for (Index b = 0; b < a; ++b) edges.insert(edges.end(), {{a, b}, {half + a, half + b}});
    }
    const CsrGraph graph = graph_from_edges(2 * half, edges);
    for (std::uint64_t seed = 0; seed < (test::kSanitized ? 2 : 10); ++seed) {
      const FiedlerVectors result = fiedler_vectors(graph, {.seed = seed});
      EXPECT_TRUE(result.components[0].converged);
      EXPECT_LT(result.components[0].lambda2, 2.0 / half) << half << ", seed " << seed;
      for (Index v = 0; v < 2 * half; ++v)
        ASSERT_EQ(result.values[v] < 0, (result.values[0] < 0) == (v < half));
    }
  }
}

TEST(FiedlerVector, DoesNotStayAtAnotherEigenvectorThatItStartsFrom) {
  const CsrGraph graph = test::kSanitized ? test::grid(18, 12) : test::grid(30, 20);
  const auto exact = test::dense_eigen(graph);
  const Eigen::VectorXd third = exact.eigenvectors().col(2);
  const std::vector<double> start(third.begin(), third.end());
  const FiedlerVectors result = fiedler_vectors(graph, {.start = start});
  EXPECT_LE(result.components[0].lambda2, 1.1 * exact.eigenvalues()[1]);
}

TEST(FiedlerVector, OfWeightsNearTheEndsOfTheRangeIsThatOfOrdinaryOnes) {
  const CsrGraph graph = test::grid(20, 10);
  const FiedlerVectors plain = fiedler_vectors(graph, std::vector<double>(graph.neighbours.size(), 1.0));
  for (const int exponent : {-1022, -900, -500, 500, 900, 1023}) {
    const double weight = std::ldexp(1.0, exponent);
    const FiedlerVectors result =
        fiedler_vectors(graph, std::vector<double>(graph.neighbours.size(), weight));
    EXPECT_EQ(result.values, plain.values) << exponent;
    EXPECT_EQ(result.components[0].lambda2, std::ldexp(plain.components[0].lambda2, exponent));
    EXPECT_TRUE(result.components[0].converged);
  }
}

TEST(FiedlerVector, TakesWeightsUpToARatioAndRefusesOthers) {
  const CsrGraph graph = test::grid(20, 10);
  const auto spread = [&](int decades) {
    return weights_of(
        graph, [&](Index a, Index b) { return std::pow(10.0, (7 * a + b) % (decades + 1) - decades / 2); });
  };
  const FiedlerVectors result = fiedler_vectors(graph, spread(90));
  EXPECT_TRUE(std::isfinite(result.components[0].lambda2));
  EXPECT_TRUE(std::isfinite(result.components[0].residual));
  EXPECT_THROW(fiedler_vectors(graph, spread(600)), InvalidArgument);
}

TEST(FiedlerVector, IsTheSameBitsOnAnyNumberOfThreads) {
  const CsrGraph graph =
      test::disjoint_union({test::grid(test::large(200), 30, 20), test::random_connected(30000, 20000, 1),
                            test::path(20000), test::path(40)});
  std::vector<double> expected;
  for (const int threads : {1, 2, 3, 7}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(threads);
    const FiedlerVectors result = arena.execute([&] { return fiedler_vectors(graph); });
    if (expected.empty()) expected = result.values;
    EXPECT_EQ(result.values, expected) << threads << " threads";
  }
}

}  // namespace
}  // namespace meshorder
