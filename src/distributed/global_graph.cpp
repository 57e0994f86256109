// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/global_graph.hpp"

#include "distributed/number_set.hpp"
#include "graph/incidence.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace meshorder::distributed {
namespace {

/// A dispatch of each element to each rank that owns one of its vertices.
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

/// The elements with their vertices numbered by their places in `numbers`.
Incidence renumbered(const Rows& elements, const NumberSet& numbers) {
  Incidence result;
  result.vertex_count = index_size(numbers.numbers());
  result.offsets = elements.offsets;
  result.vertices.reserve(elements.entries.size());
  for (const GlobalIndex vertex : elements.entries)
    result.vertices.push_back(static_cast<Index>(numbers.position(vertex)));
  return result;
}

}  // namespace

GlobalGraph global_graph(const Communicator& communicator, const Layout& layout, const Rows& elements) {
  const std::vector<Dispatch> dispatches = communicator.together([&] { return to_owners(layout, elements); });
  Rows received = send_rows(communicator, elements, dispatches);
  return communicator.together([&] {
    // numbers of the rank's own, which rise with those among all ranks: the serial graph's rows then do, too
    const NumberSet set(received.entries);
    const std::vector<GlobalIndex>& numbers = set.numbers();
    if (numbers.size() > static_cast<std::size_t>(kMaxIndex)) {
      throw TooLarge("more than 2,147,483,647 vertices on a rank; start more ranks");
    }
    const CsrGraph local = joined_vertices(renumbered(received, set));
    received = {};
    GlobalGraph graph{layout, {}};
    const GlobalIndex begin = layout.begin(communicator.rank());
    const GlobalIndex end = layout.end(communicator.rank());
    auto place = std::lower_bound(numbers.begin(), numbers.end(), begin) - numbers.begin();
    for (GlobalIndex vertex = begin; vertex < end; ++vertex) {
      const bool is_there = place < std::ssize(numbers) && numbers[static_cast<std::size_t>(place)] == vertex;
      if (is_there) {
        for (const Index u : local[static_cast<Index>(place)])
          graph.rows.entries.push_back(numbers[static_cast<std::size_t>(u)]);
        ++place;
      }
      graph.rows.end_row();
    }
    return graph;
  });
}

std::vector<GlobalIndex> ghosts(const GlobalGraph& graph, int rank) {
  std::vector<GlobalIndex> others;
  for (const GlobalIndex vertex : graph.rows.entries) {
    if (vertex < graph.layout.begin(rank) || vertex >= graph.layout.end(rank)) others.push_back(vertex);
  }
  return NumberSet(others).numbers();
}

}  // namespace meshorder::distributed
