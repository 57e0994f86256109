// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/view.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace meshorder {
namespace {

template <class From, class To>
constexpr bool kConverts = std::is_convertible_v<From, To>;

static_assert(kConverts<std::vector<int>, IndexView>);
static_assert(kConverts<const std::vector<std::uint64_t>&, IndexView>);
static_assert(kConverts<std::span<const std::int64_t>, IndexView>);
static_assert(kConverts<std::span<long long>, IndexView>);
static_assert(kConverts<unsigned (&)[3], IndexView>);
static_assert(kConverts<std::vector<std::array<int, 4>>&, IndexView>);
static_assert(kConverts<IndexSpan, IndexView>);
static_assert(!kConverts<std::array<bool, 4>&, IndexView>);
static_assert(!kConverts<std::vector<bool>&, IndexView>);
static_assert(!kConverts<std::vector<short>&, IndexView>);
static_assert(!kConverts<std::vector<double>&, IndexView>);
static_assert(!kConverts<std::u32string&, IndexView>);

static_assert(kConverts<std::vector<int>&, IndexSpan>);
static_assert(kConverts<const std::span<int>&, IndexSpan>);
static_assert(!kConverts<std::vector<int>, IndexSpan>, "a temporary that would be written to in vain");
static_assert(!kConverts<const std::vector<int>&, IndexSpan>);
static_assert(!kConverts<std::span<const int>, IndexSpan>);

static_assert(kConverts<std::vector<float>&, RealView> && !kConverts<std::vector<int>&, RealView>);
static_assert(kConverts<std::vector<std::array<double, 3>>&, PointsView>);
static_assert(kConverts<std::span<const std::array<float, 2>>, PointsView>);
static_assert(!kConverts<std::vector<std::array<double, 4>>&, PointsView>);
static_assert(!kConverts<std::vector<double>&, PointsView>, "the dimension has to be told");

static_assert(kConverts<const Graph&, GraphView> && kConverts<Graph&, GraphView>);
static_assert(!kConverts<Graph, GraphView> && !kConverts<const Graph, GraphView>, "would dangle");

TEST(IndexView, ReadsAllIntegerTypes) {
  const std::vector<std::uint32_t> narrow{1, 4'000'000'000};
  const std::array<std::int64_t, 2> wide{-7, 1'000'000'000'000};
  EXPECT_EQ(IndexView(narrow)[1], 4'000'000'000);
  EXPECT_EQ(IndexView(wide)[0], -7);
  EXPECT_EQ(IndexView(wide).bytes(), 8);
  const int count = -1;
  EXPECT_TRUE(IndexView(wide.data(), count).empty());
}

TEST(IndexView, FlattensArrays) {
  std::vector<std::array<int, 4>> tets{{0, 1, 2, 3}, {4, 5, 6, 7}};
  const IndexView view = tets;
  EXPECT_EQ(view.size(), 8U);
  EXPECT_EQ(view[5], 5);
  EXPECT_EQ(IndexSpan(tets).data(), tets.data());
  tets.clear();
  EXPECT_TRUE(IndexView(tets).empty());
}

TEST(PointsView, ReadsEveryLayout) {
  const std::vector<std::array<float, 2>> plane{{1, 2}, {3, 4}};
  const PointsView pairs = plane;
  EXPECT_EQ(pairs.dimension(), 2);
  EXPECT_EQ(pairs(1, 1), 4);
  EXPECT_EQ(pairs(1, 2), 0);
  const std::vector<double> separate{1, 2, 10, 20, 100, 200};  // x x y y z z
  const PointsView columns(separate.data(), 2, 3, 8, 16);
  EXPECT_EQ(columns(1, 0), 2);
  EXPECT_EQ(columns(0, 2), 100);
  EXPECT_EQ(PointsView(separate, 3).size(), 2U);
  EXPECT_THROW(PointsView(std::span(separate).first(5), 3), InvalidArgument);
  EXPECT_THROW(PointsView(separate, 4), InvalidArgument);
}

TEST(CellsView, CountsCellsOfEveryLayout) {
  const std::vector<std::array<int, 4>> tets{{0, 1, 2, 3}, {1, 2, 3, 4}};
  const std::vector<int> triangles{0, 1, 2};
  const std::vector<std::int64_t> offsets{0, 4, 7};
  const std::vector<int> vertices{0, 1, 2, 3, 0, 1, 2};
  EXPECT_EQ(CellsView().size(), 0U);
  EXPECT_EQ(CellsView::uniform(Shape::tetrahedron, 4, tets).size(), 2U);
  const std::array<CellBlock, 2> blocks{{{Shape::tetrahedron, 4, tets}, {Shape::triangle, 3, triangles}}};
  EXPECT_EQ(CellsView::blocks(blocks).size(), 3U);
  EXPECT_EQ(CellsView::mixed(offsets, vertices).size(), 2U);
  EXPECT_TRUE(CellsView::mixed(offsets, vertices).is_mixed());
}

TEST(Error, HasItsKindAndPlace) {
  const InputError error(Location{"a.msh", 7, -1}, "no number", "expected 3");
  EXPECT_STREQ(error.what(), "a.msh:7: no number; expected 3");
  const Error& base = error;
  EXPECT_EQ(base.code(), Code::bad_input);
  const InputError copy = error;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(copy.location().line, 7);
  EXPECT_EQ(Stopped().code(), Code::stopped);
}

}  // namespace
}  // namespace meshorder
