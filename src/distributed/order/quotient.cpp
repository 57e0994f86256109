// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/partition.hpp"
#include "ordering/arrangement_graph.hpp"
#include <meshorder/order.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr double kTolerance = 1e-6;  // tolerance of the Fiedler vector, cheap for a graph this small
constexpr int kPasses = 20;          // maximum number of passes over all parts; a few usually suffice

/// Two parts, a < b, and the number of edges between them.
struct Border {
  Index a;
  Index b;
  GlobalIndex edges;
};

bool have_same_parts(const Border& x, const Border& y) { return x.a == y.a && x.b == y.b; }

/// Returns one border for each pair of parts, with the sum of the edges of all given borders of the pair.
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

/// Returns the borders on this rank. An edge is counted once, by the rank of its vertex in the lower part.
std::vector<Border> borders_of(const GlobalGraph& graph, const HaloValues<Index>& part_of) {
  constexpr std::size_t kEnough = 1 << 20;  // minimum number of borders at which they are merged
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

/// Returns the quotient graph. Each part has volume 1, because parts are about equally large.
ArrangementGraph graph_of(const std::vector<Border>& borders, Index parts) {
  ArrangementGraph graph;
  graph.offsets.assign(static_cast<std::size_t>(parts) + 1, 0);
  graph.volumes.assign(static_cast<std::size_t>(parts), 1);
  for (const Border& border : borders) {
    ++graph.offsets[static_cast<std::size_t>(border.a) + 1];
    ++graph.offsets[static_cast<std::size_t>(border.b) + 1];
  }
  std::partial_sum(graph.offsets.begin(), graph.offsets.end(), graph.offsets.begin());
  graph.neighbours.resize(2 * borders.size());
  graph.weights.resize(2 * borders.size());
  std::vector<Offset> next(graph.offsets.begin(), graph.offsets.end() - 1);
  const auto add = [&](Index part, Index neighbour, GlobalIndex edges) {
    const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(part)]++);
    graph.neighbours[place] = neighbour;
    graph.weights[place] = edges;
  };
  for (const Border& border : borders) {
    add(border.a, border.b, border.edges);
    add(border.b, border.a, border.edges);
  }
  return graph;
}

/// Returns the positions of the parts: first along the Fiedler vector of their graph, then improved by moving
/// single parts as long as that shortens edges. Parts without borders come last.
std::vector<Index> places_of(const std::vector<Border>& borders, Index parts) {
  const ArrangementGraph graph = graph_of(borders, parts);
  const std::vector<double> weights(graph.weights.begin(), graph.weights.end());
  const Order start =
      order_vertices({.offsets = graph.offsets, .neighbours = graph.neighbours, .weights = weights},
                     "fiedler", {.tolerance = kTolerance});
  std::vector<Index> part_at(start.permutation.new_to_old().begin(), start.permutation.new_to_old().end());
  improve_by_insertions(graph, part_at, kPasses);
  std::vector<Index> places(part_at.size());
  for (std::size_t place = 0; place < part_at.size(); ++place)
    places[static_cast<std::size_t>(part_at[place])] = static_cast<Index>(place);
  return places;
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
