// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/method.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>

namespace meshorder {
namespace {

Incidence elements_of_any_size(Index vertices, Index count, Index most, unsigned seed) {
  std::mt19937 random(seed);
  Incidence result;
  result.vertex_count = vertices;
  for (Index e = 0; e < count; ++e) {
    for (auto k = static_cast<Index>(random() % static_cast<unsigned>(most)); k >= 0; --k) {
      result.vertices.push_back(static_cast<Index>(random() % static_cast<unsigned>(vertices)));
    }
    result.offsets.push_back(static_cast<Offset>(result.vertices.size()));
  }
  return result;
}

using Ranks = std::vector<Index>;

/// All elements, sorted stably with `before` on their vertices' ranks in descending order.
Ranks sorted_elements(const Incidence& elements, const Permutation& vertices,
                      const std::function<bool(const Ranks&, const Ranks&)>& before) {
  std::vector<Ranks> ranks(elements.size());
  for (Index e = 0; e < elements.size(); ++e) {
    for (const Index v : elements[e]) ranks[e].push_back(vertices.old_to_new()[v]);
    std::sort(ranks[e].begin(), ranks[e].end(), std::greater<>());
  }
  Ranks order(elements.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return before(ranks[a], ranks[b]); });
  return order;
}

void expect_sorted(const char* method, const std::function<bool(const Ranks&, const Ranks&)>& before) {
  // few vertices, so that many elements tie
  for (const Index vertices : {4, 12, 100}) {
    const Incidence elements = elements_of_any_size(vertices, 300, 4, static_cast<unsigned>(vertices));
    const Permutation order = test::shuffled(vertices, 2);
    EXPECT_EQ(order_incidence(method, {elements, order, {}, {}}).permutation.new_to_old(),
              sorted_elements(elements, order, before))
        << method << ", " << vertices << " vertices";
  }
}

TEST(ElementsByRanks, LexmaxComparesFallingRanksLikeWords) {
  expect_sorted("lexmax", [](const Ranks& a, const Ranks& b) { return a < b; });
}

TEST(ElementsByRanks, LexmaxComparesAllRanksOfLargeElements) {
  // elements of up to nine of only three different vertices: many tie in their largest four ranks, or in all
  const Incidence elements = elements_of_any_size(3, 500, 9, 5);
  const Permutation order = test::shuffled(3, 2);
  EXPECT_EQ(order_incidence("lexmax", {elements, order, {}, {}}).permutation.new_to_old(),
            sorted_elements(elements, order, [](const Ranks& a, const Ranks& b) { return a < b; }));
}

TEST(ElementsByRanks, LexmaxSortsElementsThatSeveralThreadsShare) {
  for (const Index vertices : {50, 150000}) {
    const Incidence elements = elements_of_any_size(vertices, 150000, 4, 6);
    const Permutation order = test::shuffled(vertices, 2);
    EXPECT_EQ(order_incidence("lexmax", {elements, order, {}, {}}).permutation.new_to_old(),
              sorted_elements(elements, order, [](const Ranks& a, const Ranks& b) { return a < b; }));
  }
}

TEST(ElementsByRanks, MaxComparesTheLargest) {
  expect_sorted("max", [](const Ranks& a, const Ranks& b) { return a.front() < b.front(); });
}

TEST(ElementsByRanks, MinComparesTheLeast) {
  expect_sorted("min", [](const Ranks& a, const Ranks& b) { return a.back() < b.back(); });
}

TEST(ElementsByRanks, MeanComparesTheMeans) {
  expect_sorted("mean", [](const Ranks& a, const Ranks& b) {
    // sums scaled to the same number of ranks, exact
    const auto sum = [](const Ranks& r) { return std::accumulate(r.begin(), r.end(), Offset{0}); };
    return sum(a) * static_cast<Offset>(b.size()) < sum(b) * static_cast<Offset>(a.size());
  });
}

TEST(ElementsByRanks, LexmaxOfAPathOfEdgesIsThePath) {
  Incidence edges;
  edges.vertex_count = 6;
  for (const Index v : {3, 0, 4, 2, 1}) {
    edges.vertices.push_back(v + 1);
    edges.vertices.push_back(v);
    edges.offsets.push_back(static_cast<Offset>(edges.vertices.size()));
  }
  const Permutation vertices = Permutation::identity(6);
  EXPECT_EQ(order_incidence("lexmax", {edges, vertices, {}, {}}).permutation.new_to_old(),
            (Ranks{1, 4, 3, 0, 2}));
}

}  // namespace
}  // namespace meshorder
