// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/bisection.hpp"

#include "slices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <numeric>
#include <vector>

namespace meshorder::distributed {
namespace {

/// The part of every vertex, on all ranks.
std::vector<Index> bisected_parts(const Communicator& communicator, const Mesh& mesh, Index parts,
                                  const std::vector<GlobalIndex>& weights = {}) {
  const GlobalGraph graph = test::graph_in_file(communicator, mesh);
  const Halo halo(communicator, graph.layout, ghosts(graph, communicator.rank()));
  const GlobalIndex first = graph.layout.begin(communicator.rank());
  const GlobalIndex end = graph.layout.end(communicator.rank());
  std::vector<GlobalIndex> in_file(static_cast<std::size_t>(end - first));
  std::iota(in_file.begin(), in_file.end(), first);
  std::vector<GlobalIndex> own;
  if (!weights.empty()) own.assign(weights.begin() + first, weights.begin() + end);
  return communicator.broadcast(
      communicator.gathered_at_root(bisected(communicator, graph, halo, in_file, parts, own, {})));
}

constexpr Index kPathVertices = 61;
constexpr Index kPathStep = 7;

/// The parts of a path's vertices, in the order of the path.
std::vector<Index> along_path(const std::vector<Index>& part_of) {
  std::vector<Index> along;
  for (Index k = 0; k < kPathVertices; ++k)
    along.push_back(part_of[static_cast<std::size_t>(k * kPathStep % kPathVertices)]);
  return along;
}

TEST(Bisection, CutsAPathIntoEqualLengths) {
  const Communicator communicator;
  for (const Index parts : {1, 2, 3, 4, 5, 7, 16}) {
    const std::vector<Index> along =
        along_path(bisected_parts(communicator, test::path(kPathVertices, kPathStep), parts));
    std::vector<Index> lengths(1, 1);
    for (std::size_t k = 1; k < along.size(); ++k) {
      if (along[k] == along[k - 1]) {
        ++lengths.back();
      } else {
        lengths.push_back(1);
      }
    }
    EXPECT_EQ(lengths.size(), static_cast<std::size_t>(parts)) << "each part is one length";
    for (const Index length : lengths) EXPECT_LE(std::abs(length - kPathVertices / parts), 2) << parts;
    EXPECT_EQ(*std::max_element(along.begin(), along.end()), parts - 1);
  }
}

TEST(Bisection, HalvesWeights) {
  const Communicator communicator;
  std::vector<GlobalIndex> weights(kPathVertices, 1);
  for (Index k = 0; k < 20; ++k) weights[static_cast<std::size_t>(k * kPathStep % kPathVertices)] = 9;
  const std::vector<Index> part_of =
      bisected_parts(communicator, test::path(kPathVertices, kPathStep), 4, weights);
  std::vector<GlobalIndex> sums(4, 0);
  for (std::size_t v = 0; v < part_of.size(); ++v) sums[static_cast<std::size_t>(part_of[v])] += weights[v];
  const GlobalIndex total = std::accumulate(sums.begin(), sums.end(), GlobalIndex{0});
  for (const GlobalIndex sum : sums) EXPECT_LE(std::abs(4 * sum - total), 4 * 9);
}

TEST(Bisection, TakesComponentsApart) {
  const Communicator communicator;
  Mesh both = test::path(40, 3);
  const Mesh other = test::path(40, 7);
  for (Index c = 0; c < other.cell_count(); ++c)
    both.cells.push_back(Shape::line, std::vector<Index>{40 + other.cells[c][0], 40 + other.cells[c][1]});
  both.points.insert(both.points.end(), other.points.begin(), other.points.end());
  const std::vector<Index> part_of = bisected_parts(communicator, both, 2);
  for (std::size_t v = 0; v < 80; ++v) EXPECT_EQ(part_of[v], v < 40 ? part_of[0] : 1 - part_of[0]);
}

TEST(Bisection, LeavesPartsEmptyWhereThereAreTooMany) {
  const Communicator communicator;
  const std::vector<Index> part_of = bisected_parts(communicator, test::path(5, 2), 9);
  std::vector<Index> sorted = part_of;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end()) << "one vertex in a part";
  EXPECT_LT(sorted.back(), 9);
}

}  // namespace
}  // namespace meshorder::distributed
