// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells/warp_sectors.hpp"

#include "mesh/procedural.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/mesh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// The sectors of x alone. The cost of a product also counts those of offsets, columns and values.
Offset vector_sectors(const CsrGraph& graph) {
  CsrGraph matrix;
  for (Index v = 0; v < graph.size(); ++v) {
    std::vector<Index> row(graph[v].begin(), graph[v].end());
    row.push_back(v);
    std::ranges::sort(row);
    matrix.neighbours.insert(matrix.neighbours.end(), row.begin(), row.end());
    matrix.offsets.push_back(std::ssize(matrix.neighbours));
  }
  return loads_of_lists({.offsets = matrix.offsets, .records = matrix.neighbours}, 1).records;
}

TEST(WarpSectors, OfAProductAreThoseOfTheRenumberedMatrix) {
  for (const CsrGraph& graph : {test::random_connected(1000, 3000, 1), test::grid(9, 11), test::star(70)}) {
    for (const Permutation& order : {Permutation::identity(graph.size()), test::shuffled(graph.size(), 5)}) {
      EXPECT_EQ(sectors_of_product(graph, order), vector_sectors(renumbered(graph, order.old_to_new())));
    }
  }
  EXPECT_EQ(sectors_of_product(CsrGraph(), Permutation::identity(0)), 0);
}

TEST(WarpSectors, AreThoseOfEveryWarpThatIsLookedAt) {
  // a path costs the same in each warp except the first, whose vertex 0 has no smaller neighbour
  const CsrGraph path = test::path(3200);
  const Permutation as_is = Permutation::identity(3200);
  const Offset all = sectors_of_product(path, as_is);
  EXPECT_NEAR(static_cast<double>(10 * sectors_of_product(path, as_is, 10)), static_cast<double>(all), 20);
}

/// The geometric mean over all layouts of the cost of the cells' additions.
double cost_of(const Mesh& mesh) {
  double sum = 0;
  for (const GpuLayout layout : {GpuLayout::packed, GpuLayout::apart, GpuLayout::padded})
    sum += std::log(gpu_cost(view(mesh).cells, mesh.points.size(), layout).sectors);
  return std::exp(sum / 3);
}

TEST(ForGpu, AdditionsCostATenthLessOrElementsStay) {
  for (const std::string method : {"original", "scrambled", "hilbert", "rcm"}) {
    for (const std::string elements : {"original", "scrambled", "lexmax"}) {
      SCOPED_TRACE(method + " " + elements);
      Mesh mesh = make_grid({.size = 9});
      (void)reorder(mesh, {.methods = {method, elements}});
      const double before = cost_of(mesh);
      ReorderOptions options;
      options.order.workload = Workload::gpu;
      const MeshOrder result = reorder(mesh, options);
      EXPECT_THAT(result.vertices.method.name, testing::AnyOf("rcm", "original"));
      const bool stays = result.cells.method.name == "original" && result.vertices.method.name == "original";
      if (stays) {
        EXPECT_EQ(cost_of(mesh), before);
      } else {
        EXPECT_LT(cost_of(mesh), 0.95 * before);
      }
      if (method == "scrambled" || elements == "scrambled") {
        EXPECT_LT(cost_of(mesh), 0.6 * before);
      }
    }
  }
}

TEST(ForGpu, ALatticeStaysAsItsGeneratorNumbersIt) {
  Mesh mesh = make_grid({.size = 9});
  ReorderOptions options;
  options.order.workload = Workload::gpu;
  const MeshOrder result = reorder(mesh, options);
  EXPECT_TRUE(result.vertices.permutation.is_identity()) << result.vertices.method.reason;
  EXPECT_TRUE(result.cells.permutation.is_identity()) << result.cells.method.reason;
  EXPECT_THAT(result.cells.method.reason, testing::HasSubstr("atomic additions"));
}

}  // namespace
}  // namespace meshorder
