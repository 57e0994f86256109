// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/method.hpp"
#include "support/graph_orders.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kChunk = 2048;
constexpr Index kSection = 32 * kChunk;

/// The order by its definition; slow.
Permutation fronts_by_definition(const CsrGraph& graph, const Permutation& order) {
  std::vector<Index> new_to_old;
  std::vector<Index> number(graph.size(), -1);
  for (Index begin = 0; begin < graph.size(); begin += kChunk) {
    const Index end = std::min(graph.size(), begin + kChunk);
    const Index section = begin / kSection * kSection;
    const auto neighbours = [&](Index v) {  // as places in the order
      std::vector<Index> places;
      for (const Index u : graph[v]) places.push_back(order.old_to_new()[u]);
      return places;
    };
    std::vector<std::pair<Index, Index>> seeds;
    for (Index place = begin; place < end; ++place) {
      Index earliest = begin;
      for (const Index there : neighbours(order.new_to_old()[place])) {
        if (there >= begin) continue;
        earliest = std::min(earliest, there < section ? there : number[order.new_to_old()[there]]);
      }
      if (earliest < begin) seeds.emplace_back(earliest, place);
    }
    std::ranges::sort(seeds);
    std::deque<Index> queue;
    const auto enqueue = [&](Index place) {
      const Index v = order.new_to_old()[place];
      if (number[v] != -1) return;
      number[v] = static_cast<Index>(new_to_old.size());
      new_to_old.push_back(v);
      queue.push_back(v);
    };
    for (const auto& [earliest, place] : seeds) enqueue(place);
    for (Index first = begin; first < end; ++first) {
      for (; !queue.empty(); queue.pop_front()) {
        for (const Index there : neighbours(queue.front())) {
          if (there >= begin && there < end) enqueue(there);
        }
      }
      enqueue(first);
    }
  }
  return Permutation::from_new_to_old(std::move(new_to_old));
}

/// The share of jumps among the lines that rows of the windows are the first of all rows to touch, from a
/// history of the first touches in each window.
double jump_share_by_definition(const CsrGraph& graph, const Permutation& order,
                                const std::vector<std::pair<Index, Index>>& windows) {
  const CsrGraph rows = renumbered(graph, order.old_to_new());
  double jumps = 0;
  double lines = 0;
  for (const auto& [begin, end] : windows) {
    std::vector<char> is_touched(static_cast<std::size_t>(rows.size()) / 8 + 1, 0);
    std::vector<Index> history;
    for (Index row = 0; row < end; ++row) {
      std::vector<Index> entries(rows[row].begin(), rows[row].end());
      entries.push_back(row);
      std::ranges::sort(entries);
      for (const Index entry : entries) {
        const Index line = entry / 8;
        if (std::exchange(is_touched[line], 1) != 0 || row < begin) continue;
        const auto recent = history.end() - std::min<std::ptrdiff_t>(32, std::ssize(history));
        const auto precedes = [&](Index other) { return other < line && other >= line - 3; };
        jumps += std::none_of(recent, history.end(), precedes) ? 1 : 0;
        history.push_back(line);
      }
    }
    lines += static_cast<double>(history.size());
  }
  return jumps / lines;
}

TEST(Fronts, AreWhatTheyAreDefinedToBe) {
  const std::vector<CsrGraph> graphs{test::path(1), test::path(5000), test::random_connected(9000, 30000, 3),
                                     test::disjoint_union({test::grid(50, 50), test::cycle(3000)}),
                                     test::grid(60, 40, 40)};
  for (const CsrGraph& graph : graphs) {
    for (const Permutation& order : {Permutation::identity(graph.size()), test::shuffled(graph.size(), 7)}) {
      EXPECT_EQ(in_fronts(graph, order), fronts_by_definition(graph, order)) << graph.size();
    }
  }
}

TEST(Fronts, MoveVerticesWithinTheirChunksOnly) {
  const CsrGraph graph = test::random_connected(10'000, 40'000, 5);
  const Permutation order = test::shuffled(graph.size(), 2);
  const Permutation fronts = in_fronts(graph, order);
  for (Index v = 0; v < graph.size(); ++v) {
    ASSERT_EQ(fronts.old_to_new()[v] / kChunk, order.old_to_new()[v] / kChunk);
  }
}

TEST(Fronts, ReadMemoryForward) {
  const Index side = test::kSanitized ? 24 : 48;
  const CsrGraph graph = test::grid(side, side, side);
  std::vector<Point> points;
  for (Index v = 0; v < graph.size(); ++v) {
    points.push_back({1.0 * (v % side), 1.0 * (v / side % side), 1.0 * (v / side / side)});
  }
  const VertexInput input{graph, points};
  const Permutation hilbert = order_graph("hilbert", input).permutation;
  const Permutation fronts = order_graph("hilbert-fronts", input).permutation;
  EXPECT_GT(jump_share(graph, hilbert), 0.3);
  EXPECT_LT(jump_share(graph, fronts), 0.1);
  EXPECT_LT(edge_span(graph, fronts).mean, 1.1 * edge_span(graph, hilbert).mean);
}

TEST(JumpShare, IsWhatItIsDefinedToBe) {
  for (const CsrGraph& graph : {test::grid(30, 20), test::random_connected(1500, 3000, 4), test::star(400)}) {
    for (const Permutation& order : {Permutation::identity(graph.size()), test::shuffled(graph.size(), 9)}) {
      EXPECT_DOUBLE_EQ(jump_share(graph, order), jump_share_by_definition(graph, order, {{0, graph.size()}}));
    }
  }
}

TEST(JumpShare, CanBeSampled) {
  const CsrGraph graph = test::grid(40, 40, 50);
  for (const char* const method : {"bfs", "rcm", "spectral", "scrambled"}) {
    const Permutation order = test::order_of(graph, method);
    EXPECT_NEAR(sampled_jump_share(graph, order), jump_share(graph, order), 0.04) << method;
    EXPECT_DOUBLE_EQ(sampled_jump_share(graph, order),
                     jump_share_by_definition(graph, order, {{0, 4096}, {65536, 69632}}));
  }
  // 147 windows, of which one in 18 is counted
  const CsrGraph path = test::path(600'000);
  const Permutation order = test::shuffled(path.size(), 3);
  std::vector<std::pair<Index, Index>> windows;
  for (Index begin = 0; begin < path.size(); begin += 18 * 4096) windows.emplace_back(begin, begin + 4096);
  ASSERT_EQ(windows.size(), 9U);
  EXPECT_DOUBLE_EQ(sampled_jump_share(path, order), jump_share_by_definition(path, order, windows));
}

TEST(JumpShare, IsLeastForBreadthFirstOrdersAndLargeForRandomOnes) {
  const CsrGraph graph = test::grid(40, 40, 20);
  const double lines = graph.size() / 8.0;
  EXPECT_DOUBLE_EQ(jump_share(test::path(8000), Permutation::identity(8000)), 1 / 1000.0);  // the first line
  EXPECT_LE(jump_share(graph, test::order_of(graph, "bfs")), 1 / lines);
  EXPECT_GT(jump_share(graph, test::shuffled(graph.size(), 1)), 0.9);
  EXPECT_EQ(jump_share(CsrGraph(), Permutation::identity(0)), 0);
}

}  // namespace
}  // namespace meshorder
