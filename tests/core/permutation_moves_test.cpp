// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/refusal.hpp"
#include <meshorder/error.hpp>
#include <meshorder/permutation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kTuples = 100000;  // more than one thread takes at once

Permutation shuffled(Index n) {
  std::vector<Index> map(static_cast<std::size_t>(n));
  std::iota(map.begin(), map.end(), 0);
  std::shuffle(map.begin(), map.end(), std::mt19937(5));
  return Permutation::from_old_to_new(std::move(map));
}

const Permutation kThree = Permutation::from_old_to_new({2, 0, 1});

TEST(Permutation, IsMadeFromAnyIntegers) {
  const std::vector<std::uint64_t> map{1, 2, 0};
  EXPECT_EQ(Permutation::from_new_to_old(map), kThree);
  const std::vector<std::int64_t> far{0, std::int64_t{1} << 32U};
  EXPECT_THROW(Permutation::from_new_to_old(far), InvalidArgument);
  EXPECT_THROW(Permutation::from_old_to_new({0, 0}), InvalidArgument);
  EXPECT_THROW(Permutation::identity(-1), InvalidArgument);
}

TEST(Permutation, InvertsChainsAndRepeats) {
  EXPECT_TRUE(kThree.then(kThree.inverse()).is_identity());
  EXPECT_TRUE(Permutation(kThree).inverse().then(kThree).is_identity());
  const std::vector<Index> node_major = kThree.repeated(2).old_to_new();
  const std::vector<Index> field_major = kThree.repeated(2, false).old_to_new();
  EXPECT_EQ(node_major, (std::vector<Index>{4, 5, 0, 1, 2, 3}));
  EXPECT_EQ(field_major, (std::vector<Index>{2, 0, 1, 5, 3, 4}));
  EXPECT_EQ(kThree.repeated(2), Permutation::from_old_to_new(node_major));
  EXPECT_THROW((void)kThree.repeated(0), InvalidArgument);
  EXPECT_THROW((void)kThree.repeated(1'000'000'000), TooLarge);
}

TEST(Permutation, MovesRowsOfAnyType) {
  const std::vector<std::string> words{"a", "b", "c"};
  std::vector<std::string> moved(3);
  kThree.move(words, moved);
  EXPECT_EQ(moved, (std::vector<std::string>{"b", "c", "a"}));
  std::vector<int> pairs{1, 2, 3, 4, 5, 6};
  kThree.move_in_place(pairs, 2);
  EXPECT_EQ(pairs, (std::vector<int>{3, 4, 5, 6, 1, 2}));
  kThree.inverse().move_in_place(moved);
  EXPECT_EQ(moved, words);
  EXPECT_THROW(kThree.move(pairs, pairs, 2), InvalidArgument);
  EXPECT_THROW(kThree.move_in_place(pairs, 3), InvalidArgument);
  EXPECT_EQ(
      test::refusal([&] { kThree.move_in_place(pairs); }),
      "permutation: 6 values, wanted 3 rows of 1; for rows of 2 pass that width, and for lists of vertex "
      "numbers call renumber");
  EXPECT_EQ(test::refusal([&] { kThree.move_in_place(std::span(pairs).first(4)); }),
            "permutation: 4 values, wanted 3 rows of 1; for lists of vertex numbers call renumber");
}

TEST(Permutation, MovesInPlaceWhatACopyWouldMove) {
  const Permutation order = shuffled(kTuples);
  std::vector<std::array<char, 7>> rows(kTuples);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].fill(static_cast<char>(i % 127));
  std::vector<std::array<char, 7>> copy(rows.size());
  order.move(rows, copy);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ASSERT_EQ(copy[k], rows[static_cast<std::size_t>(order.new_to_old()[k])]);
  }
  order.move_in_place(std::span(rows));
  EXPECT_EQ(rows, copy);
}

TEST(Permutation, MovesStridedRows) {
  const std::array<float, 6> from{1, -1, 2, -2, 3, -3};
  std::array<float, 3> to{};
  kThree.move_rows(from.data(), 8, to.data(), 4, 4, {.threads = 1});
  EXPECT_EQ(to, (std::array<float, 3>{2, 3, 1}));
  EXPECT_THROW(kThree.move_rows(nullptr, 8, to.data(), 4, 4), InvalidArgument);
}

TEST(Permutation, RenumbersConnectivity) {
  std::vector<std::array<std::uint32_t, 2>> edges{{1, 2}, {2, 3}};
  kThree.renumber(edges, 1);
  EXPECT_EQ(edges, (std::vector<std::array<std::uint32_t, 2>>{{3, 1}, {1, 2}}));
  std::vector<std::int64_t> numbers{0, 1, 3};
  EXPECT_THROW(kThree.renumber(numbers), InvalidArgument);
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{0, 1, 3}));
  EXPECT_THROW(kThree.renumber(edges, 2), InvalidArgument);
  std::vector<std::int64_t> below{1, 0};
  EXPECT_THROW(kThree.renumber(below, 1), InvalidArgument);
}

TEST(Permutation, MovesSparseMatrices) {
  // 10 20  .      rows and columns 0, 1, 2 go to 2, 0, 1
  //  .  . 30
  // 40  . 50      in base 1
  const std::vector<int> offsets{1, 3, 4, 6};
  const std::vector<int> columns{2, 1, 3, 1, 3};
  const std::vector<float> values{20, 10, 30, 40, 50};
  const GraphView matrix{offsets, columns, {}, 1};
  std::vector<std::int64_t> moved_offsets(4);
  std::vector<std::uint32_t> moved_columns(5);
  std::vector<float> moved(5);
  kThree.move_csr(matrix, std::as_bytes(std::span(values)), moved_offsets, moved_columns,
                  std::as_writable_bytes(std::span(moved)));
  EXPECT_EQ(moved_offsets, (std::vector<std::int64_t>{1, 2, 4, 6}));
  EXPECT_EQ(moved_columns, (std::vector<std::uint32_t>{2, 2, 3, 1, 3}));
  EXPECT_EQ(moved, (std::vector<float>{30, 50, 40, 20, 10}));
  EXPECT_EQ(kThree.csr_entry_map(matrix), (std::vector<Offset>{2, 4, 3, 0, 1}));

  EXPECT_THROW(kThree.move_csr(matrix, std::as_bytes(std::span(values)), moved_offsets, moved_columns, {}),
               InvalidArgument);
  const std::vector<int> faulty{2, 1, 4, 1, 3};
  EXPECT_THROW((void)kThree.csr_entry_map({offsets, faulty, {}, 1}), InvalidArgument);
  EXPECT_THROW((void)Permutation::identity(2).csr_entry_map(matrix), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
