// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/shared_hierarchy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace meshorder::distributed {
namespace {

/// A rank's rows of the graph of a grid whose vertices are numbered by rows.
SharedLevel grid_level(const Communicator& communicator, GlobalIndex width, GlobalIndex height) {
  const Layout layout = Layout::even(width * height, communicator.size());
  const int rank = communicator.rank();
  std::vector<std::vector<GlobalIndex>> rows;
  std::vector<GlobalIndex> others;
  for (GlobalIndex v = layout.begin(rank); v < layout.end(rank); ++v) {
    std::vector<GlobalIndex>& row = rows.emplace_back();
    if (v % width > 0) row.push_back(v - 1);
    if (v % width < width - 1) row.push_back(v + 1);
    if (v >= width) row.push_back(v - width);
    if (v < width * (height - 1)) row.push_back(v + width);
    for (const GlobalIndex u : row) {
      if (layout.owner(u) != rank) others.push_back(u);
    }
  }
  SharedLevel level{layout, Halo(communicator, layout, others), {}};
  for (const std::vector<GlobalIndex>& row : rows) {
    for (const GlobalIndex u : row) {
      const bool is_own = layout.owner(u) == rank;
      const auto column =
          is_own ? static_cast<std::size_t>(u - layout.begin(rank)) : rows.size() + level.halo.position(u);
      level.laplacian.neighbours.push_back(static_cast<Index>(column));
    }
    level.laplacian.offsets.push_back(static_cast<Offset>(level.laplacian.neighbours.size()));
    level.laplacian.diagonal.push_back(static_cast<double>(row.size()));
  }
  return level;
}

/// This rank's rows of a vector that is a sum of two waves and sums to 0 over all ranks.
VectorBlock<1> waves(const Communicator& communicator, const Layout& layout, double frequency) {
  VectorBlock<1> x;
  double sum = 0;
  for (GlobalIndex v = layout.begin(communicator.rank()); v < layout.end(communicator.rank()); ++v) {
    x.push_back({std::sin(frequency * static_cast<double>(v)) + std::cos(1.7 * static_cast<double>(v))});
    sum += x.back()[0];
  }
  const double mean = communicator.sum(sum) / static_cast<double>(layout.size());
  for (auto& [value] : x) value -= mean;
  return x;
}

double product(const Communicator& communicator, const VectorBlock<1>& x, const VectorBlock<1>& y) {
  double own = 0;
  for (std::size_t v = 0; v < x.size(); ++v) own += x[v][0] * y[v][0];
  return communicator.sum(own);
}

class SharedHierarchies : public testing::TestWithParam<GlobalIndex> {};

TEST_P(SharedHierarchies, HaveASymmetricCycleNearTheInverse) {
  const Communicator communicator;
  SharedHierarchy hierarchy(communicator, grid_level(communicator, 30, 40), GetParam());
  const SharedLevel& finest = hierarchy.levels().front();
  const VectorBlock<1> a = waves(communicator, finest.layout, 0.05);
  const VectorBlock<1> b = waves(communicator, finest.layout, 0.31);
  VectorBlock<1> of_a;
  VectorBlock<1> of_b;
  hierarchy.cycle<1>(0, a, of_a);
  hierarchy.cycle<1>(0, b, of_b);
  const double size = std::sqrt(product(communicator, a, of_a) * product(communicator, b, of_b));
  EXPECT_NEAR(product(communicator, a, of_b), product(communicator, b, of_a), 1e-10 * size);

  VectorBlock<1> image(finest.rows());
  const auto residual = [&](VectorBlock<1> x) {
    fetch_others(finest, x);
    finest.laplacian.apply<1>(x, image);
    VectorBlock<1> result(a);
    for (std::size_t v = 0; v < result.size(); ++v) result[v][0] -= image[v][0];
    return result;
  };
  const VectorBlock<1> left = residual(of_a);
  EXPECT_LT(product(communicator, left, left), 0.5 * product(communicator, a, a));
}

// the root alone has the levels from the second on, or from about the fourth on
INSTANTIATE_TEST_SUITE_P(Depths, SharedHierarchies, testing::Values(1'000'000, 12),
                         [](const auto& test) { return test.param > 12 ? "Two" : "Several"; });

}  // namespace
}  // namespace meshorder::distributed
