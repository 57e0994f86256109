// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/aggregation.hpp"

#include "graph/traversal.hpp"
#include "spectral/hiding.hpp"
#include "support/clustered_graphs.hpp"
#include "support/dense.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

namespace meshorder {
namespace {

constexpr double kStrength = 0.1;

/// A path whose k-th edge has weight `weights[k]`.
Laplacian weighted_path(const std::vector<double>& weights) {
  const auto n = index_size(weights) + 1;
  Laplacian result;
  for (Index v = 0; v < n; ++v) {
    double sum = 0;
    for (const Index u : {v - 1, v + 1}) {
      if (u < 0 || u >= n) continue;
      result.neighbours.push_back(u);
      result.weights.push_back(weights[std::min(u, v)]);
      sum += result.weights.back();
    }
    result.offsets.push_back(static_cast<Offset>(result.neighbours.size()));
    result.diagonal.push_back(sum);
  }
  return result;
}

/// All rows in one chunk.
Aggregation aggregated(const Laplacian& laplacian) {
  return aggregate(laplacian, RowChunks::whole(laplacian.size()), kStrength);
}

TEST(Aggregation, PutsEveryVertexIntoAConnectedAggregate) {
  for (const CsrGraph& graph :
       {test::path(100), test::grid(17, 12), test::grid(7, 6, 5), test::star(50), test::complete(20),
        test::random_connected(500, 300, 1), test::preferential_attachment(500, 2, 2), test::hypercube(7)}) {
    const Aggregation aggregation = aggregated(test::combinatorial_laplacian(graph));
    ASSERT_EQ(index_size(aggregation.aggregate_of), graph.size());
    std::vector<std::vector<Index>> members(aggregation.count());
    for (Index v = 0; v < graph.size(); ++v) {
      ASSERT_GE(aggregation.aggregate_of[v], 0);
      ASSERT_LT(aggregation.aggregate_of[v], aggregation.count());
      members[aggregation.aggregate_of[v]].push_back(v);
    }
    for (const std::vector<Index>& of_one : members) {
      ASSERT_FALSE(of_one.empty());
      EXPECT_EQ(connected_components(induced_subgraph(graph, of_one)).size(), 1U);
      EXPECT_GT(of_one.size(), 1U) << "in a connected graph nothing needs to stay alone";
    }
  }
}

TEST(Aggregation, FoundsWithWholeFreeNeighbourhoodsInOrder) {
  // 0 takes 1; 2 takes none as its neighbour 1 is taken; 3 takes 2 and 4; 6 takes 5 and 7
  EXPECT_EQ(aggregated(test::combinatorial_laplacian(test::path(8))).aggregate_of,
            (std::vector<Index>{0, 0, 1, 1, 1, 2, 2, 2}));
  // 5 is left over and joins its only neighbour
  EXPECT_EQ(aggregated(test::combinatorial_laplacian(test::path(6))).aggregate_of,
            (std::vector<Index>{0, 0, 1, 1, 1, 1}));
}

TEST(Aggregation, DoesNotReachAcrossWeakEdges) {
  // the middle edge is weak for both of its ends
  const Aggregation cut = aggregated(weighted_path({1, 0.01, 1}));
  EXPECT_EQ(cut.aggregate_of, (std::vector<Index>{0, 0, 1, 1}));
  // the vertex left over joins the neighbour with the heavier edge
  EXPECT_EQ(aggregated(weighted_path({1, 0.4, 0.6, 10})).aggregate_of, (std::vector<Index>{0, 0, 1, 1, 1}));
  EXPECT_EQ(aggregated(weighted_path({1, 0.6, 0.4, 10})).aggregate_of, (std::vector<Index>{0, 0, 0, 1, 1}));
}

TEST(Aggregation, KeepsToTheChunksOfRows) {
  const Laplacian laplacian = test::combinatorial_laplacian(test::grid(300, 100));
  const RowChunks chunks(laplacian);
  ASSERT_GT(chunks.count(), 1);
  const Aggregation aggregation = aggregate(laplacian, chunks, kStrength);
  EXPECT_EQ(aggregation.alone, 0);
  ASSERT_EQ(index_size(aggregation.first_of_chunk), chunks.count() + 1);
  std::set<Index> seen;
  for (Index v = 0; v < laplacian.size(); ++v) {
    const Index chunk = chunks.chunk_of(v);
    ASSERT_GE(aggregation.aggregate_of[v], aggregation.first_of_chunk[chunk]);
    ASSERT_LT(aggregation.aggregate_of[v], aggregation.first_of_chunk[chunk + 1]);
    seen.insert(aggregation.aggregate_of[v]);
  }
  EXPECT_EQ(index_size(seen), aggregation.count());
}

TEST(Aggregation, CountsWhoIsAloneInItsChunk) {
  // the hub is in the first chunk, most leaves are not
  const Laplacian laplacian = test::combinatorial_laplacian(test::star(20000));
  const RowChunks chunks(laplacian);
  ASSERT_GT(chunks.count(), 1);
  EXPECT_EQ(aggregate(laplacian, chunks, kStrength).alone, 20000 - chunks.size());
}

TEST(Aggregation, OfOneVertexIsOne) {
  EXPECT_EQ(aggregated(test::combinatorial_laplacian(test::path(1))).count(), 1);
  EXPECT_EQ(aggregated(test::combinatorial_laplacian(test::path(0))).count(), 0);
}

/// Eigenvalues of L x = μ M x in ascending order, on the subgraph of some vertices.
Eigen::VectorXd eigenvalues_of_part(const Eigen::MatrixXd& laplacian, const std::vector<double>& masses,
                                    const std::vector<Index>& vertices) {
  const auto n = static_cast<Eigen::Index>(vertices.size());
  Eigen::MatrixXd part = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i != j) part(i, j) = laplacian(vertices[i], vertices[j]);
    }
  }
  part.diagonal() = -part.rowwise().sum();
  Eigen::VectorXd inverse_roots(n);
  for (Eigen::Index i = 0; i < n; ++i) inverse_roots[i] = 1 / std::sqrt(masses[vertices[i]]);
  part = inverse_roots.asDiagonal() * part * inverse_roots.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(part, Eigen::EigenvaluesOnly).eigenvalues();
}

TEST(Aggregation, HidesWhatDenseSolversFindWithinAggregates) {
  int hidden = 0;
  int shown = 0;
  for (std::uint64_t seed = 0; seed < 78; ++seed) {
    const test::ClusteredGraph clustered = test::clustered_graph(seed);
    Laplacian laplacian = test::combinatorial_laplacian(clustered.graph);
    laplacian.weights = clustered.weights;
    const Index n = laplacian.size();
    for (Index v = 0; v < n; ++v) {
      laplacian.diagonal[v] = 0;
      for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k)
        laplacian.diagonal[v] += laplacian.weight(k);
    }
    std::vector<double> masses(n);
    for (Index v = 0; v < n; ++v) masses[v] = seed % 2 == 0 ? 1 : 1 + (v * 7919 % 13);
    const Aggregation aggregation = aggregate(laplacian, RowChunks::whole(n), kStrength, masses);
    const Eigen::MatrixXd dense = test::dense(laplacian);
    // the smallest second eigenvalue of all aggregates
    double second = std::numeric_limits<double>::infinity();
    for (Index a = 0; a < aggregation.count(); ++a) {
      std::vector<Index> members;
      for (Index v = 0; v < n; ++v) {
        if (aggregation.aggregate_of[v] == a) members.push_back(v);
      }
      if (members.size() > 1) second = std::min(second, eigenvalues_of_part(dense, masses, members)[1]);
    }
    const double scale = *std::max_element(laplacian.diagonal.begin(), laplacian.diagonal.end());
    for (const double share : {0.00117, 0.1317, 0.4117, 0.9017, 0.9917, 1.0117, 1.1017, 4.017, 100.17}) {
      const double eigenvalue = share * second * kDoubtful;
      if (eigenvalue < 1e-10 * scale) continue;  // the eigenvalue would be lost in rounding errors
      const bool hides = may_hide(laplacian, aggregation, masses, eigenvalue);
      if (share < 1) {
        EXPECT_FALSE(hides) << clustered.name << ", seed " << seed << ", " << share;
      }
      if (share > 2.001) {  // the slack estimates `second` up to a factor of 2
        EXPECT_TRUE(hides) << clustered.name << ", seed " << seed << ", " << share;
      }
      ++(hides ? hidden : shown);
    }
    std::vector<Index> all(n);
    std::iota(all.begin(), all.end(), Index{0});
    const double lambda2 = eigenvalues_of_part(dense, masses, all)[1];
    if (lambda2 < 1e-10 * scale) continue;
    EXPECT_FALSE(has_two_below(laplacian, masses, 0.999 * lambda2)) << clustered.name << ", seed " << seed;
    EXPECT_TRUE(has_two_below(laplacian, masses, 1.001 * lambda2)) << clustered.name << ", seed " << seed;
  }
  EXPECT_GT(hidden, 150);
  EXPECT_GT(shown, 150);
}

TEST(Aggregation, OfTwoCliquesAndABridgeMayHideTheirDifference) {
  // all vertices are one aggregate: its founder is one end of the bridge, and the other clique is joined to
  // the other end
  constexpr Index kSize = 20;
  std::vector<Edge> edges;
  for (Index first : {Index{0}, kSize}) {
    for (Index u = first; u < first + kSize; ++u) {
      for (Index v = first; v < u; ++v) edges.push_back({u, v});
    }
  }
  edges.push_back({0, kSize});
  const Laplacian laplacian = test::combinatorial_laplacian(graph_from_edges(2 * kSize, edges));
  const Aggregation aggregation = aggregated(laplacian);
  ASSERT_EQ(aggregation.count(), 1);
  EXPECT_TRUE(may_hide(laplacian, aggregation, {}, 20));
  EXPECT_FALSE(may_hide(laplacian, aggregation, {}, 0.02));
}

}  // namespace
}  // namespace meshorder
