// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/packed_arrays.hpp"

#include "unpacked.hpp"
#include <meshorder/error.hpp>

#include <cmath>

namespace meshorder {
namespace {

using test::unpacked;
using test::unpacked_places;
using Numbers = std::vector<std::uint32_t>;

void expect_near(const std::vector<Point>& actual, const std::vector<Point>& expected, const Point& within) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t v = 0; v < expected.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(actual[v][c], expected[v][c], within[c]) << v;
  }
}

TEST(PackedArrays, GiveBackWholeNumbersInTheSmallestType) {
  PackedArrays arrays;
  const std::vector<std::pair<Numbers, std::string>> examples{
      {{0, 255, 7, 1}, "uint8"}, {{0, 256, 65535, 1}, "uint16"}, {{65536, 4294967295, 2, 3}, "uint32"}};
  for (const auto& [numbers, type] : examples) {
    const auto array = arrays.add(numbers, {2, 2});
    EXPECT_EQ(array["type"], type);
    EXPECT_EQ(array["shape"].dump(), "[2,2]");
    EXPECT_EQ(unpacked(arrays.script_elements(), array), numbers);
  }
  EXPECT_EQ(unpacked(arrays.script_elements(), arrays.add(Numbers{}, {0})), Numbers{});
}

TEST(PackedArrays, ShareOneElementWhereTheyAreEqual) {
  PackedArrays arrays;
  const auto first = arrays.add(Numbers{1, 2}, {2});
  EXPECT_EQ(arrays.add(Numbers{1, 2}, {2})["blob"], first["blob"]);
  const auto other = arrays.add(Numbers{1, 3}, {2});
  EXPECT_NE(other["blob"], first["blob"]);
  EXPECT_EQ(unpacked(arrays.script_elements(), other), (Numbers{1, 3}));
  // the same bytes, but other numbers: 0x0201 in 16 bits
  EXPECT_NE(arrays.add(Numbers{0x0201}, {1})["blob"], first["blob"]);
}

TEST(PackedArrays, GiveBackTriangles) {
  PackedArrays arrays;
  const std::vector<std::array<Index, 3>> triangles{{0, 1, 2}, {2, 1, 300}};
  const auto array = arrays.add(triangles);
  EXPECT_EQ(unpacked(arrays.script_elements(), array), (Numbers{0, 1, 2, 2, 1, 300}));
}

TEST(PackedArrays, GiveBackPlacesWithinHalfAStep) {
  std::vector<Point> places;
  for (int i = 0; i < 500; ++i) places.push_back({1000 + std::sin(i), 1e-3 * std::cos(3 * i), 5});
  PackedArrays arrays;
  const auto array = arrays.add_places(places);
  const Point half_step{1.0 / 65535 * 1.001, 1e-3 / 65535 * 1.001, 1e-12};
  expect_near(unpacked_places(arrays.script_elements(), array), places, half_step);
}

TEST(PackedArrays, GiveBackFramesWithinHalfAStep) {
  // a body of size 2 falls by its size, turning
  std::vector<std::vector<Point>> frames(20);
  std::vector<Point> all;
  for (int f = 0; f < 20; ++f) {
    for (int v = 0; v < 50; ++v)
      frames[f].push_back({std::sin(v + 0.1 * f), std::cos(v + 0.1 * f) - 0.1 * f, 0.01 * v});
    all.insert(all.end(), frames[f].begin(), frames[f].end());
  }
  PackedArrays arrays;
  const auto array = arrays.add_frames(frames);
  EXPECT_EQ(array["shape"].dump(), "[20,50,3]");
  const double half_step = 1.0 / 4096 * 1.001;
  expect_near(unpacked_places(arrays.script_elements(), array), all, {half_step, half_step, half_step});
}

TEST(PackedArrays, TakeWiderStepsWhereABodyFliesFar) {
  const std::vector<std::vector<Point>> frames{{{0, 0, 0}, {1, 0, 0}}, {{1000, 0, 0}, {1001, 0, 0}}};
  PackedArrays arrays;
  const auto array = arrays.add_frames(frames);
  const double half_step = 1001.0 / 65535 / 2 * 1.001;
  expect_near(unpacked_places(arrays.script_elements(), array),
              {{0, 0, 0}, {1, 0, 0}, {1000, 0, 0}, {1001, 0, 0}}, {half_step, half_step, half_step});
}

TEST(PackedArrays, RefuseWhatDoesNotFitItsShape) {
  PackedArrays arrays;
  EXPECT_THROW((void)arrays.add(Numbers{1, 2, 3}, {2, 2}), InvalidArgument);
  EXPECT_THROW((void)arrays.add_frames({{{0, 0, 0}}, {}}), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
