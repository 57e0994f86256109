// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/bisection.hpp"

#include "distributed/order/fiedler.hpp"

#include <algorithm>
#include <cstddef>

namespace meshorder::distributed {
namespace {

/// Returns the graph without the edges between pieces. A piece is a set of consecutive parts that are not yet
/// separated; its number is that of its first part.
GlobalGraph within_pieces(const GlobalGraph& graph, const HaloValues<Index>& piece_of) {
  GlobalGraph within{graph.layout, {}};
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    for (const GlobalIndex neighbour : graph.rows[row]) {
      if (piece_of[neighbour] == piece_of.own(row)) within.rows.entries.push_back(neighbour);
    }
    within.rows.end_row();
  }
  return within;
}

/// Weight of each piece: on the ranks before this one, and on all ranks.
struct PieceWeights {
  std::vector<GlobalIndex> before;
  std::vector<GlobalIndex> all;
};

PieceWeights weights_of(const Communicator& communicator, const std::vector<Index>& pieces,
                        const std::vector<GlobalIndex>& weights, Index parts) {
  std::vector<GlobalIndex> own(static_cast<std::size_t>(parts), 0);
  for (std::size_t k = 0; k < pieces.size(); ++k) own[static_cast<std::size_t>(pieces[k])] += weights[k];
  // the root adds up the weights of each piece in rank order
  const std::vector<GlobalIndex> of_ranks = communicator.gathered_at_root(own);
  std::vector<GlobalIndex> sums = communicator.at_root([&] {
    const auto ranks = static_cast<std::size_t>(communicator.size());
    const auto count = static_cast<std::size_t>(parts);
    std::vector<GlobalIndex> before((ranks + 1) * count, 0);
    for (std::size_t k = 0; k < ranks * count; ++k) before[k + count] = before[k] + of_ranks[k];
    return before;
  });
  sums = communicator.broadcast(std::move(sums));
  const auto row = [&](int rank) { return sums.begin() + Offset{parts} * rank; };
  return {{row(communicator.rank()), row(communicator.rank() + 1)},
          {row(communicator.size()), row(communicator.size() + 1)}};
}

}  // namespace

std::vector<Index> bisected(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                            const std::vector<GlobalIndex>& number_in_file, Index parts,
                            const std::vector<GlobalIndex>& weights, const OrderOptions& options) {
  const GlobalIndex first = graph.layout.begin(communicator.rank());
  const auto own_count = static_cast<std::size_t>(graph.rows.size());
  const bool is_weighted = communicator.sum(static_cast<GlobalIndex>(weights.size())) > 0;
  const std::vector<GlobalIndex> of_vertices =
      communicator.together([&] { return is_weighted ? weights : std::vector<GlobalIndex>(own_count, 1); });
  std::vector<Index> piece_of = communicator.together([&] { return std::vector<Index>(own_count, 0); });
  // for each part: the number of parts in the piece that begins with this part; 0 if there is no such piece
  std::vector<Index> parts_of(static_cast<std::size_t>(parts), 0);
  parts_of[0] = parts;
  while (*std::max_element(parts_of.begin(), parts_of.end()) > 1) {
    const HaloValues<Index> pieces(halo, first, communicator.together([&] { return piece_of; }));
    const GlobalGraph within = communicator.together([&] { return within_pieces(graph, pieces); });
    const std::vector<GlobalIndex> numbers =
        fiedler_order(communicator, within, halo, number_in_file, options).new_numbers;
    // piece and weight of the vertex with each new number; in a piece, new numbers follow the Fiedler vector
    std::vector<Index> halves = delivered<Index>(communicator, graph.layout, numbers, pieces.own(), Index{0});
    const std::vector<GlobalIndex> in_order =
        delivered<GlobalIndex>(communicator, graph.layout, numbers, of_vertices, GlobalIndex{0});
    PieceWeights sums = weights_of(communicator, halves, in_order, parts);
    for (std::size_t k = 0; k < halves.size(); ++k) {
      const auto piece = static_cast<std::size_t>(halves[k]);
      const double middle = static_cast<double>(sums.before[piece]) + 0.5 * static_cast<double>(in_order[k]);
      sums.before[piece] += in_order[k];
      const Index of_left = parts_of[piece] / 2;
      const double share = static_cast<double>(of_left) / static_cast<double>(parts_of[piece]);
      if (of_left > 0 && middle >= share * static_cast<double>(sums.all[piece])) halves[k] += of_left;
    }
    const Halo places(communicator, graph.layout, numbers);
    const std::vector<Index> of_places = places.fetch(halves);
    for (std::size_t v = 0; v < own_count; ++v) piece_of[v] = of_places[places.position(numbers[v])];
    for (Index piece = parts; piece-- > 0;) {
      const Index count = parts_of[static_cast<std::size_t>(piece)];
      if (count < 2) continue;
      const Index right = piece + count / 2;
      parts_of[static_cast<std::size_t>(piece)] = right - piece;
      parts_of[static_cast<std::size_t>(right)] = piece + count - right;
    }
  }
  return piece_of;
}

}  // namespace meshorder::distributed
