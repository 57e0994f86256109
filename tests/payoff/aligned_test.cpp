// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/apart.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <thread>
#include <vector>

namespace meshorder {
namespace {

constexpr std::size_t kKiB = 1024;
constexpr std::size_t kMiB = 1024 * kKiB;

/// The offset from the last multiple of 4096, in bytes.
std::size_t place_in_page(const void* address) { return reinterpret_cast<std::uintptr_t>(address) % 4096; }

std::size_t distance(const void* a, const void* b) {
  const std::size_t between = (place_in_page(a) + 4096 - place_in_page(b)) % 4096;
  return std::min(between, 4096 - between);
}

TEST(Aliases, WhereAddressesModulo4096AreNear) {
  const char* const base = reinterpret_cast<const char*>(std::uintptr_t{1} << 30);
  for (const std::size_t near : {0, 64, 1087, 3009, 4095, 4096, 8192 + 100}) {
    EXPECT_TRUE(aliases(base, base + near)) << near;
    EXPECT_TRUE(aliases(base + near, base)) << near;
  }
  for (const std::size_t far : {1088, 2048, 3008, 40960 + 1500}) {
    EXPECT_FALSE(aliases(base, base + far)) << far;
    EXPECT_FALSE(aliases(base + far, base)) << far;
  }
}

TEST(AlignedVector, OfWhicheverSizeBeginsAtACacheLine) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{64}, 64 * kKiB - 1, 64 * kKiB, kMiB - 1, kMiB,
                                  2 * kMiB, 2 * kMiB + 1, 5 * kMiB}) {
    for (int i = 0; i < 4; ++i) {
      const AlignedVector<char> array(bytes, 'a');
      EXPECT_EQ(place_in_page(array.data()) % 64, 0U) << bytes;
    }
  }
}

TEST(AlignedVector, IsApartFromTheTwoMadeBefore) {
  // groups of vectors of one size, and of different sizes
  const std::vector<std::vector<std::size_t>> groups{{64 * kKiB, 64 * kKiB, 64 * kKiB, 64 * kKiB},
                                                     {700'000, 700'000, 700'000},
                                                     {kMiB, kMiB, kMiB, kMiB, kMiB},
                                                     {2 * kMiB, 2 * kMiB, 2 * kMiB},
                                                     {kMiB, 64 * kKiB, 3 * kMiB, 200'000, kMiB - 1, kMiB}};
  for (const std::vector<std::size_t>& sizes : groups) {
    std::vector<AlignedVector<char>> arrays;
    arrays.reserve(sizes.size());
    for (const std::size_t size : sizes) arrays.emplace_back(size);
    for (std::size_t i = 0; i < arrays.size(); ++i) {
      for (std::size_t before = i < 2 ? 0 : i - 2; before < i; ++before) {
        EXPECT_GE(distance(arrays[i].data(), arrays[before].data()), 1088U) << sizes[i] << ' ' << before;
      }
    }
  }
}

TEST(AlignedVector, IsApartWhateverOtherThreadsMake) {
  const AlignedVector<char> first(kMiB);
  // as many vectors as would bring a counter shared by threads back to the same turn
  std::thread([] {
    const AlignedVector<char> one(kMiB);
    const AlignedVector<char> another(kMiB);
  }).join();
  const AlignedVector<char> second(kMiB);
  EXPECT_GE(distance(first.data(), second.data()), 1088U);
}

TEST(AlignedVector, KeepsItsNumbersWhileItGrowsThroughAllSizes) {
  constexpr int kCount = 1'000'000;
  AlignedVector<int> grown;
  for (int i = 0; i < kCount; ++i) grown.push_back(i);
  AlignedVector<int> expected(kCount);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(grown, expected);
  grown.resize(10);
  grown.shrink_to_fit();
  EXPECT_EQ(grown, AlignedVector<int>(expected.begin(), expected.begin() + 10));
}

TEST(ReservedApart, IsApartFromArraysInAllTurns) {
  const AlignedVector<double> a(kMiB);
  for (int turns = 0; turns < 4; ++turns) {
    for (int i = 0; i < turns; ++i) const AlignedVector<double> between(kMiB);
    const AlignedVector<double> b = reserved_apart<double>(kMiB, {a.data()});
    EXPECT_TRUE(b.empty());
    EXPECT_GE(b.capacity(), kMiB);
    EXPECT_GE(distance(a.data(), b.data()), 1088U) << turns;
    for (int i = 0; i < turns; ++i) const AlignedVector<double> between(kMiB);
    const AlignedVector<double> c = reserved_apart<double>(kMiB, {a.data(), b.data()});
    EXPECT_GE(distance(a.data(), c.data()), 1088U) << turns;
    EXPECT_GE(distance(b.data(), c.data()), 1088U) << turns;
  }
}

TEST(ReservedApart, HasRoomWhereItIsTooSmallToBeApart) {
  const AlignedVector<double> a(8);
  AlignedVector<double> b = reserved_apart<double>(8, {a.data()});
  EXPECT_GE(b.capacity(), 8U);
  b.assign(8, 1.0);
  EXPECT_EQ(b, AlignedVector<double>(8, 1.0));
}

}  // namespace
}  // namespace meshorder
