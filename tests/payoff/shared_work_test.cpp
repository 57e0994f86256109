// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/shared_work.hpp"

#include "kernels/owned_batches.hpp"
#include "kernels/springs.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "payoff/kernel_bench.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

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
      const double expected = 1 + KernelBench(mesh, threads).redundancy();
      EXPECT_NEAR(computed(mesh, Kernel::element, threads), expected, 1e-12) << threads;
      EXPECT_EQ(computed(mesh, Kernel::assembly, threads), computed(mesh, Kernel::element, threads));
    }
  }
}

TEST(TimesComputed, SpringsAreThoseOfTheShares) {
  const Mesh mesh = scrambled(test::tetrahedral_bar(30));
  const CsrGraph graph = vertex_graph(mesh);
  const KernelBench bench(mesh, graph);
  const Springs springs = springs_on_edges(graph, mesh.points);
  for (const int threads : {2, 5}) {
    Offset batches = 0;
    for (const OwnedBatches& share :
         owned_batches(springs.ends, 2, balanced_ranges(bench.matrix().offsets, threads))) {
      batches += static_cast<Offset>(share.batches.size());
    }
    const double all = static_cast<double>((springs.count + kBatch - 1) / kBatch);
    // the last batch is filled up with springs of the first vertex
    EXPECT_NEAR(computed(mesh, Kernel::springs, threads), static_cast<double>(batches) / all, 1.01 / all);
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
