// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/measures.hpp"
#include "support/graph_orders.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <set>
#include <vector>

namespace meshorder {
namespace {

/// Entries of the Cholesky factor below the diagonal, by elimination on sets.
Offset factor_entries_on_sets(const CsrGraph& graph, const Permutation& order) {
  const CsrGraph matrix = renumbered(graph, order.old_to_new());
  std::vector<std::set<Index>> later(matrix.size());
  Offset entries = 0;
  for (Index v = 0; v < matrix.size(); ++v) {
    for (const Index u : matrix[v]) {
      if (u > v) later[v].insert(u);
    }
  }
  for (Index v = 0; v < matrix.size(); ++v) {
    entries += static_cast<Offset>(later[v].size());
    if (later[v].empty()) continue;
    const Index parent = *later[v].begin();
    later[parent].insert(std::next(later[v].begin()), later[v].end());
  }
  return entries;
}

TEST(FactorEntries, AreThoseOfEliminationOnSets) {
  for (const CsrGraph& graph :
       {CsrGraph{}, test::path(1), test::path(30), test::cycle(17), test::star(12), test::complete(9),
        test::grid(9, 7), test::grid(5, 4, 6), test::hypercube(6), test::random_connected(120, 90, 3),
        test::preferential_attachment(150, 3, 5),
        test::disjoint_union({test::grid(6, 5), test::path(7), test::path(1), test::cycle(9)})}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const CsrGraph scrambled = test::scrambled(graph, seed);
      for (const char* const method : {"original", "rcm", "spectral"}) {
        const Permutation order = test::order_of(scrambled, method);
        EXPECT_EQ(factor_entries(scrambled, order), factor_entries_on_sets(scrambled, order))
            << graph.size() << " vertices, seed " << seed << ", " << method;
      }
    }
  }
}

TEST(FactorEntries, OfSimpleOrdersAreKnown) {
  const Index n = 40;
  // the centre of a star joins all leaves if eliminated first, none if last
  EXPECT_EQ(factor_entries(test::star(n), Permutation::identity(n)), Offset{n} * (n - 1) / 2);
  EXPECT_EQ(factor_entries(test::star(n), test::order_of(test::star(n), "rcm")), n - 1);
  // a band of width 8 fills completely except in its first rows
  EXPECT_EQ(factor_entries(test::grid(8, 100), Permutation::identity(800)), 8 * (800 - 8) + 7);
}

}  // namespace
}  // namespace meshorder
