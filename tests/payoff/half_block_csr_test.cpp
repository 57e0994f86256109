// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/half_block_csr.hpp"

#include "base/random.hpp"
#include "kernels/block_csr.hpp"
#include "payoff/deformed.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Vertices in a row, each joined to the next and some to others at random.
CsrGraph row_with_chords(Index n, Index chords, std::uint64_t seed) {
  std::vector<Edge> edges;
  Random random(seed);
  for (Index v = 0; v + 1 < n; ++v) edges.push_back({v, v + 1});
  for (Index i = 0; i < chords; ++i) {
    const auto a = static_cast<Index>(random.below(static_cast<std::uint64_t>(n)));
    const auto b = static_cast<Index>(random.below(static_cast<std::uint64_t>(n)));
    if (a != b) edges.push_back({a, b});
  }
  return graph_from_edges(n, edges);
}

/// A matrix of random blocks with A_vw = A_wvᵀ.
BlockCsr symmetric_matrix(const CsrGraph& graph, std::uint64_t seed = 5) {
  BlockCsr matrix = zero_block_csr(graph);
  Random random(seed);
  for (Index v = 0; v < matrix.size(); ++v) {
    for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
      const Offset mirrored = matrix.find(matrix.columns[k], v);
      if (mirrored < k) continue;
      for (Index i = 0; i < 9; ++i) {
        if (mirrored == k && i / 3 > i % 3) continue;
        matrix.values[9 * k + i] = matrix.values[9 * mirrored + 3 * (i % 3) + i / 3] = random.unit() - 0.5;
      }
    }
  }
  return matrix;
}

std::vector<double> random_entries(Index n, std::uint64_t seed) {
  std::vector<double> x(3 * static_cast<std::size_t>(n));
  Random random(seed);
  for (double& value : x) value = random.unit() - 0.5;
  return x;
}

template <class Value = double>
HalfBlockCsrOf<Value> half_of(const BlockCsr& matrix) {
  HalfBlockCsrOf<Value> half;
  store_half(matrix, half);
  return half;
}

double norm_of(std::span<const double> x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum);
}

/// EXPECTs the same product with every instruction set, also if y held other values before.
template <class Value>
void expect_same_product(const HalfBlockCsrOf<Value>& half, const BlockCsrOf<Value>& matrix) {
  ASSERT_EQ(half.size(), matrix.size());
  // allocated at their exact size, so that a sanitizer detects reads past the end
  const std::vector<double> x = random_entries(matrix.size(), 6);
  std::vector<double> expected(x.size());
  multiply(matrix, x, expected);
  double expected_dot = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) expected_dot += x[i] * expected[i];
  test::for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    std::vector<double> y(x.size(), 1e9);
    multiply(half, x, y);
    std::vector<double> difference(y);
    for (std::size_t i = 0; i < y.size(); ++i) difference[i] -= expected[i];
    EXPECT_LE(norm_of(difference), 1e-14 * norm_of(expected));
    std::vector<double> by_slabs(x.size(), 1e9);
    double dot = 0.0;
    for (Index slab = 0; slab < half.slab_count(); ++slab) dot += multiply_slab_dot(half, x, by_slabs, slab);
    EXPECT_EQ(by_slabs, y);
    EXPECT_NEAR(dot, expected_dot, 1e-13 * norm_of(x) * norm_of(expected));
  });
}

/// EXPECTs the product in double and in float.
void expect_product_of(const BlockCsr& matrix) {
  expect_same_product(half_of(matrix), matrix);
  BlockCsrOf<float> rounded;
  round_to_single(matrix, rounded);
  expect_same_product(half_of<float>(matrix), rounded);
}

TEST(HalfBlockCsr, HasEveryPairOfASlabOnceAndThoseBetweenSlabsTwice) {
  const BlockCsr matrix = symmetric_matrix(row_with_chords(500, 300, 1));
  const HalfBlockCsr half = half_of(matrix);
  ASSERT_EQ(half.slab_count(), 16);
  const auto slab_of = [&](Index v) {
    return std::upper_bound(half.slabs.begin(), half.slabs.end(), v) - half.slabs.begin();
  };
  std::set<std::pair<Index, Index>> stored;
  Offset between = 0;
  for (Index v = 0; v < half.size(); ++v) {
    for (Offset k = half.offsets[2 * v]; k < half.offsets[2 * v + 2]; ++k) {
      const Index column = half.columns[k];
      const bool both = k >= half.offsets[2 * v + 1];
      EXPECT_EQ(both, column > v && slab_of(column) == slab_of(v));
      EXPECT_TRUE(stored.insert({v, column}).second);
      if (both) {
        EXPECT_TRUE(stored.insert({column, v}).second);
      }
      between += slab_of(column) != slab_of(v) ? 1 : 0;
      const Offset of_full = matrix.find(v, column);
      ASSERT_GE(of_full, 0);
      EXPECT_TRUE(std::equal(half.values.begin() + 9 * k, half.values.begin() + 9 * k + 9,
                             matrix.values.begin() + 9 * of_full));
    }
  }
  EXPECT_EQ(static_cast<Offset>(stored.size()), matrix.block_count());
  EXPECT_GT(between, 30);
  EXPECT_DOUBLE_EQ(share_between_slabs(matrix),
                   static_cast<double>(between) / static_cast<double>(matrix.block_count()));
  // a block on the diagonal is stored once, too
  EXPECT_EQ(2 * half.block_count(), matrix.block_count() + between + matrix.size());
}

TEST(HalfBlockCsr, HasSlabsOfAboutEqualNumbersOfBlocks) {
  const BlockCsr matrix = symmetric_matrix(row_with_chords(3000, 20'000, 2));
  const std::vector<Index> slabs = slabs_of(matrix);
  for (std::size_t i = 0; i + 1 < slabs.size(); ++i) {
    const auto blocks = static_cast<double>(matrix.offsets[slabs[i + 1]] - matrix.offsets[slabs[i]]);
    EXPECT_NEAR(blocks, static_cast<double>(matrix.block_count()) / 16, 60);
  }
}

TEST(HalfBlockCsr, StoresAllBlocksWhereRowsOfASlabAreNotJoined) {
  // neighbours are in other slabs: v and v + 50 of 100
  std::vector<Edge> edges;
  for (Index v = 0; v < 50; ++v) edges.push_back({v, v + 50});
  const BlockCsr matrix = symmetric_matrix(graph_from_edges(100, edges));
  EXPECT_EQ(half_of(matrix).block_count(), matrix.block_count());
  EXPECT_DOUBLE_EQ(share_between_slabs(matrix), 0.5);
  expect_product_of(matrix);
}

TEST(MultiplyHalf, EqualsTheFullProduct) {
  for (const Index n : {1, 2, 3, 15, 16, 17, 40, 1000}) {
    for (const Index chords : {0, n, 8 * n}) {
      SCOPED_TRACE(std::to_string(n) + " " + std::to_string(chords));
      expect_product_of(symmetric_matrix(row_with_chords(n, chords, 3)));
    }
  }
}

TEST(MultiplyHalf, EqualsTheFullProductWhereEntriesAreAskedForEarly) {
  // more vertices than a cache near the processor holds
  expect_product_of(symmetric_matrix(row_with_chords(70'000, 70'000, 4)));
}

TEST(MultiplyHalf, HasRowsWithoutBlocks) {
  // rows 1 and 4 (the last) have no blocks, not even on the diagonal
  BlockCsr matrix;
  matrix.columns = {0, 2, 0, 2, 3};
  matrix.offsets = {0, 2, 2, 4, 5, 5};
  matrix.values.resize(45);
  Random random(7);
  for (double& value : matrix.values) value = random.unit();
  for (Index i = 0; i < 9; ++i) matrix.values[18 + 3 * (i % 3) + i / 3] = matrix.values[9 + i];
  expect_product_of(matrix);
}

TEST(MultiplyHalf, OfNothingIsNothing) {
  const HalfBlockCsr half = half_of(BlockCsr{});
  EXPECT_EQ(half.size(), 0);
  EXPECT_EQ(half.block_count(), 0);
  multiply(half, {}, {});
  EXPECT_EQ(share_between_slabs(BlockCsr{}), 0.0);
}

TEST(MultiplyHalf, HasTheSameBitsOnAnyNumberOfThreads) {
  const BlockCsr matrix = symmetric_matrix(row_with_chords(5000, 20'000, 8));
  const std::vector<double> x = random_entries(matrix.size(), 9);
  std::vector<double> first;
  for (int threads = 1; threads <= 8; ++threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    HalfBlockCsr half;
    std::vector<double> y(x.size());
    arena.execute([&] {
      store_half(matrix, half);
      multiply(half, x, y);
    });
    if (threads == 1) first = y;
    EXPECT_EQ(y, first) << threads;
  }
}

TEST(MultiplyHalf, ForgetsWhatTheMatrixHeldBefore) {
  HalfBlockCsr half = half_of(symmetric_matrix(row_with_chords(300, 900, 10)));
  const BlockCsr smaller = symmetric_matrix(row_with_chords(100, 50, 11));
  store_half(smaller, half);
  const std::vector<double> x = random_entries(100, 12);
  std::vector<double> y(x.size());
  std::vector<double> expected(x.size());
  multiply(half, x, y);
  multiply(half_of(smaller), x, expected);
  EXPECT_EQ(y, expected);
}

TEST(MultiplyHalf, LeavesTheNextProductNothingOfNumbersThatAreNotFinite) {
  const BlockCsr matrix = symmetric_matrix(row_with_chords(200, 400, 13));
  const HalfBlockCsr half = half_of(matrix);
  const std::vector<double> x = random_entries(200, 14);
  std::vector<double> expected(x.size());
  multiply(half, x, expected);
  std::vector<double> y(x.size());
  multiply(half, std::vector<double>(x.size(), std::numeric_limits<double>::quiet_NaN()), y);
  EXPECT_TRUE(std::isnan(y[5]));
  multiply(half, x, y);
  EXPECT_EQ(y, expected);
}

template <class Value>
void expect_infinity_in_one_row(const HalfBlockCsrOf<Value>& half) {
  const std::vector<double> x = random_entries(half.size(), 16);
  test::for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    std::vector<double> y(x.size());
    multiply(half, x, y);
    for (std::size_t i = 0; i < y.size(); ++i) EXPECT_EQ(std::isfinite(y[i]), i != 300) << i;
  });
}

TEST(MultiplyHalf, KeepsWhatIsNotFiniteToTheRowsThatHaveIt) {
  BlockCsr matrix = symmetric_matrix(row_with_chords(200, 0, 15));
  // a block on the diagonal, which loads for the preceding row could read, too
  matrix.values[9 * matrix.find(100, 100)] = std::numeric_limits<double>::infinity();
  expect_infinity_in_one_row(half_of(matrix));
  expect_infinity_in_one_row(half_of<float>(matrix));
}

TEST(MultiplyHalf, RefusesVectorsOfAnotherSize) {
  const HalfBlockCsr half = half_of(symmetric_matrix(row_with_chords(7, 0, 1)));
  std::vector<double> right(21);
  std::vector<double> wrong(20);
  EXPECT_THROW(multiply(half, wrong, right), InvalidArgument);
  EXPECT_THROW(multiply(half, right, wrong), InvalidArgument);
}

TEST(HalfStorage, PaysForLargeMatricesInGoodOrders) {
  constexpr Index kN = 30'000;
  const BlockCsr band = zero_block_csr(row_with_chords(kN, 0, 1));
  EXPECT_LT(share_between_slabs(band), 0.01);
  EXPECT_TRUE(half_storage_pays(band));
  // nearly all blocks are between slabs, except those on the diagonal and next to it
  EXPECT_FALSE(half_storage_pays(zero_block_csr(row_with_chords(kN, 5 * kN, 1))));
  EXPECT_FALSE(half_storage_pays(zero_block_csr(row_with_chords(kN / 10, 0, 1))));
  EXPECT_FALSE(half_storage_pays(BlockCsr{}));
}

}  // namespace
}  // namespace meshorder
