// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/quotient.hpp"

#include <meshorder/order.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr double kTolerance = 1e-6;  // of a vector that costs nothing beside the rest

/// Edges between two parts, of which `a` is the smaller number.
struct Border {
  Index a;
  Index b;
  GlobalIndex edges;
};

bool have_same_parts(const Border& x, const Border& y) { return x.a == y.a && x.b == y.b; }

/// Adds up the edges of borders between the same parts.
std::vector<Border> merged(std::vector<Border> borders) {
  std::sort(borders.begin(), borders.end(),
            [](const Border& x, const Border& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  std::vector<Border> result;
  for (const Border& border : borders) {
    if (!result.empty() && have_same_parts(result.back(), border)) {
      result.back().edges += border.edges;
    } else {
      result.push_back(border);
    }
  }
  return result;
}

/// The borders that this rank sees from the part of smaller number: each edge of the graph is seen once.
std::vector<Border> borders_of(const GlobalGraph& graph, const HaloValues<Index>& part_of) {
  constexpr std::size_t kEnough = 1 << 20;  // borders before they are merged
  std::vector<Border> borders;
  std::size_t limit = kEnough;
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    const Index part = part_of.own(row);
    for (const GlobalIndex neighbour : graph.rows[row]) {
      const Index other = part_of[neighbour];
      if (other > part) borders.push_back({part, other, 1});
    }
    if (borders.size() < limit) continue;
    borders = merged(std::move(borders));
    limit = std::max(kEnough, 2 * borders.size());
  }
  return merged(std::move(borders));
}

/// The places of the parts along the Fiedler vector of their graph; parts that touch no other come last.
std::vector<Index> places_of(const std::vector<Border>& borders, Index parts) {
  std::vector<Offset> offsets(static_cast<std::size_t>(parts) + 1, 0);
  for (const Border& border : borders) {
    ++offsets[static_cast<std::size_t>(border.a) + 1];
    ++offsets[static_cast<std::size_t>(border.b) + 1];
  }
  for (std::size_t p = 0; p < static_cast<std::size_t>(parts); ++p) offsets[p + 1] += offsets[p];
  std::vector<Index> neighbours(2 * borders.size());
  std::vector<double> weights(2 * borders.size());
  std::vector<Offset> next(offsets.begin(), offsets.end() - 1);
  const auto add = [&](Index part, Index neighbour, GlobalIndex edges) {
    const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(part)]++);
    neighbours[place] = neighbour;
    weights[place] = static_cast<double>(edges);
  };
  for (const Border& border : borders) {
    add(border.a, border.b, border.edges);
    add(border.b, border.a, border.edges);
  }
  const Order order = order_vertices({.offsets = offsets, .neighbours = neighbours, .weights = weights},
                                     "fiedler", {.tolerance = kTolerance});
  const std::span<const Index> places = order.permutation.old_to_new();
  return {places.begin(), places.end()};
}

}  // namespace

Quotient order_of_parts(const Communicator& communicator, const GlobalGraph& graph,
                        const HaloValues<Index>& part_of, Index parts) {
  const std::vector<Border> own = communicator.together([&] { return borders_of(graph, part_of); });
  const std::vector<Border> all = communicator.gathered_at_root(own);
  Quotient quotient;
  for (const Border& border : own) quotient.cut += border.edges;
  quotient.cut = communicator.sum(quotient.cut);
  quotient.place_of =
      communicator.broadcast(communicator.at_root([&] { return places_of(merged(all), parts); }));
  return quotient;
}

}  // namespace meshorder::distributed
