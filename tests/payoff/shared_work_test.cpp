// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT

#include "kernels/owned_batches.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "payoff/kernel_bench.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace meshorder {
namespace {

double computed(const Mesh& mesh, Kernel kernel, int threads) {
  return times_computed(kernel, vertex_graph(mesh), cut_into_simplices(mesh), threads);
}

Mesh scrambled(Mesh mesh) {
  apply_reordering(mesh, test::shuffled(mesh.vertex_count(), 3), test::shuffled_cells(mesh, 4));
  return mesh;
}

TEST(TimesComputed, ElementsAreThoseThatKernelBenchShares) {
  const Mesh bar = test::tetrahedral_bar(30);
  for (const Mesh& mesh : {bar, scrambled(bar), test::cells_of_type(Shape::quad, 4, 50)}) {
    for (const int threads : {1, 2, 3, 8}) {
      const double expected =
          1 + prepare_kernels(KernelSet::plain, mesh, vertex_graph(mesh), threads)->redundancy();
      EXPECT_NEAR(computed(mesh, Kernel::element, threads), expected, 1e-12) << threads;
      EXPECT_EQ(computed(mesh, Kernel::assembly, threads), computed(mesh, Kernel::element, threads));
    }
  }
}

TEST(TimesComputed, SpringsAreThoseThatTouchARange) {
  const Mesh mesh = scrambled(test::tetrahedral_bar(30));
  const CsrGraph graph = vertex_graph(mesh);
  std::vector<Offset> rows(graph.offsets.begin(), graph.offsets.end());
  for (std::size_t v = 0; v < rows.size(); ++v) rows[v] += static_cast<Offset>(v);
  for (const int threads : {2, 5}) {
    const std::vector<Index> bounds = balanced_ranges(rows, threads);
    const auto range_of = [&](Index v) { return std::upper_bound(bounds.begin(), bounds.end(), v); };
    Offset springs = 0;
    for (Index a = 0; a < graph.size(); ++a) {
      for (const Index b : graph[a]) {
        if (b > a) springs += range_of(a) == range_of(b) ? 1 : 2;
      }
    }
    EXPECT_DOUBLE_EQ(computed(mesh, Kernel::springs, threads),
                     static_cast<double>(springs) / static_cast<double>(graph.edge_count()));
  }
}

TEST(TimesComputed, ProductsAndSingleThreadsAndEmptyMeshesComputeOnce) {
  const Mesh mesh = scrambled(test::tetrahedral_bar(10));
  EXPECT_EQ(computed(mesh, Kernel::spmv, 8), 1);
  for (const Kernel kernel : kKernels) {
    EXPECT_EQ(computed(mesh, kernel, 1), 1);
    EXPECT_EQ(computed(Mesh{}, kernel, 8), 1);
  }
}

}  // namespace
}  // namespace meshorder
