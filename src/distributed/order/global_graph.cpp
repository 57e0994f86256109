// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/global_graph.hpp"

#include "distributed/comm/number_set.hpp"
#include "graph/incidence.hpp"
#include "metrics/edge_span.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace meshorder::distributed {
namespace {

/// Returns the dispatches that send each element to every rank that owns one of its vertices.
std::vector<Dispatch> to_owners(const Layout& layout, const Rows& elements) {
  std::vector<Dispatch> dispatches;
  std::vector<int> owners;
  for (Offset e = 0; e < elements.size(); ++e) {
    owners.clear();
    for (const GlobalIndex vertex : elements[e]) owners.push_back(layout.owner(vertex));
    std::sort(owners.begin(), owners.end());
    owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
    for (const int owner : owners) dispatches.push_back({owner, e});
  }
  return dispatches;
}

/// Returns the elements with each vertex replaced by its position in `numbers`.
Incidence renumbered(const Rows& elements, const NumberSet& numbers) {
  Incidence result;
  result.vertex_count = index_size(numbers.numbers());
  result.offsets = elements.offsets;
  result.vertices.reserve(elements.entries.size());
  for (const GlobalIndex vertex : elements.entries)
    result.vertices.push_back(static_cast<Index>(numbers.position(vertex)));
  return result;
}

/// Returns the rows of a rank's vertices in global numbers; vertex k of `graph` has the global number
/// `numbers[k]`. Vertices of the rank that are not in `numbers` get empty rows.
Rows own_rows(const CsrGraph& graph, const std::vector<GlobalIndex>& numbers, const Layout& layout,
              int rank) {
  const auto place_of = [&](GlobalIndex number) {
    return static_cast<Index>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
  };
  Index place = place_of(layout.begin(rank));
  const Offset entries = graph.offsets[place_of(layout.end(rank))] - graph.offsets[place];
  Rows rows;
  rows.offsets.reserve(static_cast<std::size_t>(layout.size(rank)) + 1);
  rows.entries.reserve(static_cast<std::size_t>(entries));
  for (GlobalIndex vertex = layout.begin(rank); vertex < layout.end(rank); ++vertex) {
    if (place < graph.size() && numbers[place] == vertex) {
      for (const Index neighbour : graph[place]) rows.entries.push_back(numbers[neighbour]);
      ++place;
    }
    rows.end_row();
  }
  return rows;
}

}  // namespace

GlobalGraph global_graph(const Communicator& communicator, const Layout& layout, Rows elements) {
  std::vector<Dispatch> dispatches = communicator.together([&] { return to_owners(layout, elements); });
  Rows received = send_rows(communicator, std::move(elements), std::move(dispatches));
  return communicator.together([&] {
    // local numbers ascend with the global ones, so that ascending rows still ascend in global numbers
    const NumberSet set(received.entries);
    const std::vector<GlobalIndex>& numbers = set.numbers();
    if (numbers.size() > static_cast<std::size_t>(kMaxIndex)) {
      throw TooLarge("more than 2,147,483,647 vertices on a rank; start more ranks");
    }
    Incidence incidence = renumbered(received, set);
    received = {};
    const CsrGraph local = joined_vertices(incidence);
    incidence = {};
    return GlobalGraph{layout, own_rows(local, numbers, layout, communicator.rank())};
  });
}

std::vector<GlobalIndex> ghosts(const GlobalGraph& graph, int rank) {
  std::vector<GlobalIndex> others;
  for (const GlobalIndex vertex : graph.rows.entries) {
    if (vertex < graph.layout.begin(rank) || vertex >= graph.layout.end(rank)) others.push_back(vertex);
  }
  return NumberSet(others).numbers();
}

GlobalEdgeSpan edge_span(const Communicator& communicator, const GlobalGraph& graph,
                         const HaloValues<GlobalIndex>& place_of) {
  SpanSums<GlobalIndex> own;
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    for (const GlobalIndex neighbour : graph.rows[row]) {
      const GlobalIndex span = std::abs(place_of[neighbour] - place_of.own(row));
      own += {1, span, span, std::log2(static_cast<double>(span))};
    }
  }
  const SpanSums<GlobalIndex> all = communicator.sum(own);
  if (all.entries == 0) return {};
  const auto entries = static_cast<double>(all.entries);
  return {static_cast<double>(all.sum) / entries, all.max, all.log2_sum / entries};
}

}  // namespace meshorder::distributed
