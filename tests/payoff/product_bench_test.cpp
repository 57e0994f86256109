// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/product_bench.hpp"

#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/advice.hpp"
#include "payoff/band.hpp"
#include "payoff/race.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using Places = std::set<std::pair<Index, Index>>;

struct Stored final : StoredMatrix {
  [[nodiscard]] std::vector<std::string> contents() const override { return {}; }
};

/// A matrix as read from a file. If `is_half`, the file stores only one half of it.
Mesh matrix_of(Index rows, const std::vector<std::pair<Index, Index>>& entries, bool is_half) {
  Mesh mesh;
  mesh.points.resize(rows, {0, 0, 0});
  for (const auto& [row, column] : entries) {
    const std::array ends{row, column};
    mesh.cells.push_back(row == column ? Shape::vertex : Shape::line,
                         std::span(ends).first(row == column ? 1 : 2));
  }
  const auto stored = std::make_shared<Stored>();
  stored->is_half = is_half;
  mesh.format_metadata = stored;
  return mesh;
}

/// Random entries, some of them twice; the pattern is not symmetric.
std::vector<std::pair<Index, Index>> scattered_entries(Index rows, int count) {
  std::mt19937 random(7);
  std::vector<std::pair<Index, Index>> entries;
  for (int i = 0; i < count; ++i) {
    entries.emplace_back(static_cast<Index>(random() % rows), static_cast<Index>(random() % rows));
  }
  return entries;
}

Places places_of(const EntryPattern& pattern) {
  Places places;
  for (Index row = 0; row < pattern.rows(); ++row) {
    for (const Index column : pattern[row]) places.emplace(row, column);
  }
  return places;
}

Permutation some_order(Index n) {
  std::vector<Index> places(n);
  std::iota(places.begin(), places.end(), 0);
  std::shuffle(places.begin(), places.end(), std::mt19937(3));
  return Permutation::from_old_to_new(std::move(places));
}

/// The product with the vector 1, 2, 3 …
std::vector<double> expected_product(const Places& places, Index rows) {
  std::vector<double> result(rows, 0);
  for (const auto& [row, column] : places) result[row] += column + 1;
  return result;
}

/// One half of a symmetric matrix of bandwidth 3, with scrambled rows.
Mesh scrambled_band(Index rows) {
  std::vector<std::pair<Index, Index>> entries;
  const Permutation order = some_order(rows);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = i; j < std::min(rows, i + 4); ++j)
      entries.emplace_back(order.old_to_new()[j], order.old_to_new()[i]);
  }
  return matrix_of(rows, entries, true);
}

TEST(EntryPattern, HasEachEntryOnceAndBothOfAHalf) {
  const auto entries = scattered_entries(50, 300);
  Places all(entries.begin(), entries.end());
  EXPECT_EQ(places_of(entry_pattern(matrix_of(50, entries, false))), all);
  const EntryPattern pattern = entry_pattern(matrix_of(50, entries, true));
  for (const auto& [row, column] : entries) all.emplace(column, row);
  EXPECT_EQ(places_of(pattern), all);
  EXPECT_EQ(pattern.entries(), std::ssize(all));
  EXPECT_TRUE(facts_of(pattern).is_symmetric);
}

TEST(EntryPattern, MovesAsTheMeshDoes) {
  Mesh mesh = matrix_of(50, scattered_entries(50, 300), false);
  const EntryPattern before = entry_pattern(mesh);
  const Permutation order = some_order(50);
  apply_reordering(mesh, order, Permutation::identity(mesh.cell_count()));
  EXPECT_EQ(moved(order, before), entry_pattern(mesh));
  EXPECT_NE(before, entry_pattern(mesh));
  EXPECT_NE(stored_matrix(mesh), nullptr);
}

TEST(PatternFacts, AreThoseOfTheDenseMatrix) {
  const auto entries = scattered_entries(48, 400);
  const Places all(entries.begin(), entries.end());
  const PatternFacts facts = facts_of(entry_pattern(matrix_of(48, entries, false)));
  Index missing = 0;
  Index most = 0;
  std::vector<Offset> bins(6, 0);
  for (Index i = 0; i < 48; ++i) {
    Index in_row = 0;
    for (Index j = 0; j < 48; ++j) in_row += all.contains({i, j}) ? 1 : 0;
    most = std::max(most, in_row);
    missing += all.contains({i, i}) ? 0 : 1;
  }
  for (const auto& [i, j] : all) {
    int bin = -1;
    for (Index distance = std::abs(i - j); distance > 0; distance /= 2) ++bin;
    if (bin >= 0) ++bins[bin];
  }
  EXPECT_EQ(facts.missing_diagonal, missing);
  EXPECT_EQ(facts.most_in_row, most);
  EXPECT_EQ(facts.histogram_log2, bins);
  EXPECT_FALSE(facts.is_symmetric);
  EXPECT_EQ(facts.block, 1);
}

TEST(PatternFacts, FindTheLargestBlocksThatAreFull) {
  for (const Index b : {2, 3, 5, 8}) {
    std::vector<std::pair<Index, Index>> entries;
    for (Index block = 0; block < 30; ++block) {
      for (const Index other : {block, (block + 7) % 30}) {
        for (Index i = 0; i < b; ++i) {
          for (Index j = 0; j < b; ++j) entries.emplace_back(b * block + i, b * other + j);
        }
      }
    }
    const PatternFacts full = facts_of(entry_pattern(matrix_of(30 * b, entries, false)));
    EXPECT_EQ(full.block, b);
    EXPECT_EQ(full.block_fill, 1);
    std::vector<std::pair<Index, Index>> fewer;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (i % 4 != 1) fewer.push_back(entries[i]);
    }
    EXPECT_EQ(facts_of(entry_pattern(matrix_of(30 * b, fewer, false))).block, 1) << b;
  }
}

TEST(ProductBench, MultipliesByExactlyTheEntries) {
  for (const bool is_half : {false, true}) {
    const Mesh mesh = matrix_of(200, scattered_entries(200, 900), is_half);
    const Places places = places_of(entry_pattern(mesh));
    for (const int threads : {1, 3}) {
      const auto bench = prepare_kernels(KernelSet::plain, mesh, vertex_graph(mesh), threads);
      ASSERT_EQ(bench->kernels().size(), 1U);
      bench->run(Kernel::spmv);
      const auto result = bench->result(Kernel::spmv);
      EXPECT_EQ(std::vector<double>(result.begin(), result.end()), expected_product(places, 200)) << threads;
      EXPECT_THROW(bench->run(Kernel::assembly), InvalidArgument);
    }
  }
}

TEST(ProductBench, IsNotTuned) {
  const Mesh mesh = matrix_of(20, scattered_entries(20, 60), false);
  EXPECT_THROW((void)prepare_kernels(KernelSet::tuned, mesh, vertex_graph(mesh)), InvalidArgument);
}

TEST(KernelsOfAMesh, AreProductsAloneOfAMatrix) {
  Mesh mesh = matrix_of(20, scattered_entries(20, 60), false);
  EXPECT_EQ(kernels_of(mesh).size(), 1U);
  EXPECT_EQ(kernels_of(mesh).front(), Kernel::spmv);
  mesh.format_metadata = nullptr;
  EXPECT_EQ(kernels_of(mesh).size(), kKernels.size());
}

TEST(ReuseOfProduct, GathersOncePerEntry) {
  const EntryPattern pattern = entry_pattern(matrix_of(300, scattered_entries(300, 2000), false));
  Offset gathered = 0;
  AccessStream(pattern).visit(
      [&](Index /*line*/, Access how) { gathered += how == Access::gathered ? 1 : 0; });
  EXPECT_EQ(gathered, pattern.entries());
}

TEST(ReuseOfProduct, IsThatOfTheGraphWhereTheDiagonalIsComplete) {
  const Mesh mesh = scrambled_band(3000);
  const CsrGraph graph = vertex_graph(mesh);
  const RunReuse of_graph = reuse_of(Kernel::spmv, graph, {1, {}});
  EXPECT_EQ(reuse_of_product(entry_pattern(mesh)), of_graph);
  const Permutation order = some_order(3000);
  const KernelReuse moved_reuse = reuse_of_kernels(KernelInput(mesh, graph).moved({{order}, {}}));
  EXPECT_EQ(moved_reuse[0], reuse_of(Kernel::spmv, renumbered(graph, order.old_to_new()), {1, {}}));
  for (std::size_t k = 1; k < kKernels.size(); ++k) EXPECT_EQ(moved_reuse[k].all.accesses(), 0);
}

TEST(IdealPattern, HasTheRowsAndEntriesOfTheMatrix) {
  const EntryPattern pattern = entry_pattern(matrix_of(300, scattered_entries(300, 2000), false));
  const EntryPattern band = ideal_pattern(pattern);
  EXPECT_EQ(band.rows(), pattern.rows());
  EXPECT_EQ(band.entries(), pattern.entries());
  for (Index row = 0; row < band.rows(); ++row) {
    for (const Index column : band[row]) EXPECT_LE(std::abs(column - row), 7) << row;
    EXPECT_EQ(std::set<Index>(band[row].begin(), band[row].end()).size(), band[row].size());
  }
}

TEST(Advice, OfAMatrixIsOnProductsAlone) {
  const Mesh mesh = scrambled_band(60'000);
  AdviceOptions options;
  options.machine = choose_machine("zen3");
  options.describe = false;
  const Advice advice = advise(mesh, vertex_graph(mesh), options);
  ASSERT_TRUE(advice.is_matrix);
  ASSERT_EQ(advice.candidates.size(), 1U);
  EXPECT_EQ(advice.candidates[0].elements.name, "original");
  for (const Candidate* const candidate : {&advice.as_is, &advice.candidates[0]}) {
    EXPECT_GT((*candidate->costs.predicted)[0], 0);
    for (std::size_t k = 1; k < kKernels.size(); ++k) EXPECT_EQ((*candidate->costs.predicted)[k], 0);
  }
  EXPECT_GT(gain_for(Workload::all, advice, 0).ratio, 1.3);
  EXPECT_DOUBLE_EQ(gain_for(Workload::all, advice, 0).ratio, gain_for(Workload::spmv, advice, 0).ratio);
  EXPECT_EQ(winner_for(Workload::all, advice), 0U);
  EXPECT_THROW((void)gain_for(Workload::springs, advice, 0), InvalidArgument);
  EXPECT_EQ(steps_to_pay(advice, 0), advice.kernels[0].runs_to_pay);
  const std::string words = to_string(advice);
  EXPECT_NE(words.find("as it is, products take "), std::string::npos) << words;
  EXPECT_NE(words.find("`meshorder order` takes"), std::string::npos) << words;
  EXPECT_EQ(words.find("time step"), std::string::npos) << words;
}

TEST(Advice, OfAMatrixThatIsOrderedGainsNothing) {
  Mesh mesh = scrambled_band(20'000);
  (void)reorder(mesh, {});
  AdviceOptions options;
  options.machine = choose_machine("zen3");
  const Advice advice = advise(mesh, vertex_graph(mesh), options);
  EXPECT_TRUE(to_string(advice).starts_with(
      "nothing to gain: products are not more than 1.25 times as fast in another order"));
}

TEST(Advice, OfAMatrixIsMeasured) {
  const Mesh mesh = scrambled_band(2000);
  AdviceOptions options;
  options.predict = false;
  options.measure_within = 0;
  const Advice advice = advise(mesh, vertex_graph(mesh), options);
  EXPECT_GT((*advice.as_is.costs.measured)[0], 0);
  for (std::size_t k = 1; k < kKernels.size(); ++k) EXPECT_EQ((*advice.as_is.costs.measured)[k], 0);
}

TEST(Race, OfAMatrixLeavesItsEntriesWhereTheyAre) {
  const Mesh mesh = scrambled_band(5000);
  RaceOptions options;
  options.machine = choose_machine("zen3");
  options.timer = {};  // predictions decide
  const Race result = race(mesh, vertex_graph(mesh), options);
  EXPECT_EQ(result.advice.candidates.size(), 3U);
  for (const Candidate& candidate : result.advice.candidates) EXPECT_EQ(candidate.elements.name, "original");
}

TEST(Reorder, LeavesTheEntriesOfAMatrixWhereTheyAre) {
  Mesh mesh = scrambled_band(300);
  Mesh other = mesh;
  const MeshOrder order = reorder(mesh, {});
  EXPECT_TRUE(order.cells.permutation.is_identity());
  EXPECT_EQ(order.cells.method.reason, "entries keep their places in the file");
  EXPECT_FALSE(order.vertices.permutation.is_identity());
  other.format_metadata = nullptr;
  EXPECT_FALSE(reorder(other, {.methods = {"auto", "lexmax"}}).cells.permutation.is_identity());
}

}  // namespace
}  // namespace meshorder
