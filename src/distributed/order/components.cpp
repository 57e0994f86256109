// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/components.hpp"

#include "graph/csr_graph.hpp"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

namespace meshorder::distributed {
namespace {

/// Returns the subgraph of the vertices that a rank owns.
CsrGraph own_graph(const GlobalGraph& graph, int rank) {
  const GlobalIndex first = graph.layout.begin(rank);
  const GlobalIndex count = graph.layout.size(rank);
  CsrGraph own;
  own.offsets.reserve(static_cast<std::size_t>(count) + 1);
  own.neighbours.reserve(graph.rows.entries.size());
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    for (const GlobalIndex neighbour : graph.rows[row]) {
      const GlobalIndex other = neighbour - first;
      if (other >= 0 && other < count) own.neighbours.push_back(static_cast<Index>(other));
    }
    own.offsets.push_back(static_cast<Offset>(own.neighbours.size()));
  }
  return own;
}

/// Two pieces, on different ranks, joined by an edge.
struct Link {
  GlobalIndex smaller;
  GlobalIndex larger;

  auto operator<=>(const Link&) const = default;
};

/// Returns the links whose smaller piece is on this rank, each once.
std::vector<Link> links_of(const GlobalGraph& graph, const HaloValues<GlobalIndex>& piece_of, int rank) {
  const GlobalIndex first = graph.layout.begin(rank);
  const GlobalIndex end = graph.layout.end(rank);
  std::vector<Link> links;
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    for (const GlobalIndex neighbour : graph.rows[row]) {
      if (neighbour >= first && neighbour < end) continue;
      const Link link{piece_of.own(row), piece_of[neighbour]};
      if (link.smaller < link.larger && (links.empty() || links.back() != link)) links.push_back(link);
    }
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

/// Returns for each piece the smallest piece number in its component (union–find).
std::vector<GlobalIndex> smallest_pieces(std::size_t count, const std::vector<Link>& links) {
  std::vector<GlobalIndex> parent(count);
  std::iota(parent.begin(), parent.end(), GlobalIndex{0});
  const auto root_of = [&](GlobalIndex piece) {
    while (parent[static_cast<std::size_t>(piece)] != piece) {
      GlobalIndex& above = parent[static_cast<std::size_t>(piece)];
      above = parent[static_cast<std::size_t>(above)];  // halves the path
      piece = above;
    }
    return piece;
  };
  for (const Link& link : links) {
    const auto [low, high] = std::minmax({root_of(link.smaller), root_of(link.larger)});
    parent[static_cast<std::size_t>(high)] = low;
  }
  for (GlobalIndex piece = 0; piece < std::ssize(parent); ++piece)
    parent[static_cast<std::size_t>(piece)] = root_of(piece);
  return parent;
}

/// The component of each piece, and the components that all ranks solve.
struct Found {
  std::vector<Component> of_piece;
  std::vector<Component> of_all_ranks;
};

Found joined_pieces(const std::vector<GlobalIndex>& sizes, const std::vector<Link>& links,
                    const Layout& pieces, GlobalIndex alone) {
  const std::vector<GlobalIndex> first_piece = smallest_pieces(sizes.size(), links);
  std::vector<GlobalIndex> size_of(sizes.size(), 0);  // size of each component, at its first piece
  std::vector<char> is_shared(sizes.size(), 0);
  for (std::size_t piece = 0; piece < sizes.size(); ++piece) {
    const auto first = static_cast<std::size_t>(first_piece[piece]);
    size_of[first] += sizes[piece];
    if (pieces.owner(first_piece[piece]) != pieces.owner(static_cast<GlobalIndex>(piece)))
      is_shared[first] = 1;
  }
  std::vector<GlobalIndex> firsts;
  for (std::size_t piece = 0; piece < sizes.size(); ++piece) {
    if (size_of[piece] > 0) firsts.push_back(static_cast<GlobalIndex>(piece));
  }
  std::stable_sort(firsts.begin(), firsts.end(), [&](GlobalIndex a, GlobalIndex b) {
    return size_of[static_cast<std::size_t>(a)] > size_of[static_cast<std::size_t>(b)];
  });

  Found found;
  found.of_piece.resize(sizes.size());
  GlobalIndex start = 0;
  for (GlobalIndex place = 0; place < std::ssize(firsts); ++place) {
    const GlobalIndex first = firsts[static_cast<std::size_t>(place)];
    const GlobalIndex size = size_of[static_cast<std::size_t>(first)];
    const bool for_all = is_shared[static_cast<std::size_t>(first)] != 0 && size > alone;
    const Component component{place, start, size, for_all ? kAllRanks : pieces.owner(first)};
    found.of_piece[static_cast<std::size_t>(first)] = component;
    if (for_all) found.of_all_ranks.push_back(component);
    start += size;
  }
  for (std::size_t piece = 0; piece < sizes.size(); ++piece)
    found.of_piece[piece] = found.of_piece[static_cast<std::size_t>(first_piece[piece])];
  return found;
}

}  // namespace

Components components_of(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                         GlobalIndex alone) {
  const int rank = communicator.rank();
  Components components;
  std::vector<GlobalIndex> sizes;
  components.pieces = communicator.together([&] { return number_components(own_graph(graph, rank)); });
  const ComponentNumbering& own = components.pieces;
  const Layout pieces = Layout::of_sizes(communicator.gathered(GlobalIndex{own.component_count()}));
  std::vector<GlobalIndex> piece_of;
  communicator.together([&] {
    piece_of.resize(own.order.size());
    for (Index piece = 0; piece < own.component_count(); ++piece) {
      sizes.push_back(std::ssize(own.component(piece)));
      for (const Index vertex : own.component(piece))
        piece_of[static_cast<std::size_t>(vertex)] = pieces.begin(rank) + piece;
    }
  });
  const HaloValues<GlobalIndex> with_others(halo, graph.layout.begin(rank), std::move(piece_of));
  const std::vector<Link> links = communicator.gathered_at_root(
      communicator.together([&] { return links_of(graph, with_others, rank); }));
  sizes = communicator.gathered_at_root(sizes);
  Found found = communicator.at_root([&] { return joined_pieces(sizes, links, pieces, alone); });
  components.of_piece = communicator.scattered_from_root(found.of_piece, pieces.starts());
  components.of_all_ranks = communicator.broadcast(std::move(found.of_all_ranks));
  return components;
}

}  // namespace meshorder::distributed
