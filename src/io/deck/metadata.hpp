// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/deck/numbers.hpp"
#include <meshorder/mesh.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// A deck, or another file that stays whole while its nodes and elements move, and where these are in the
/// mesh.
///
/// @tparam Deck  what the file says, in its own order. Of its members, `contents` lists what other formats
///               lose, and `unknown` what may name nodes or elements by number and is not understood: with
///               one of these all numbers must stay.
template <class Deck>
struct DeckMetadata final : FormatMetadata {
  std::shared_ptr<const Deck> deck;
  std::vector<Index> vertex_of;  ///< of each node of the file; empty if they are in its order
  std::vector<Index> cell_of;    ///< of each element of the file; likewise
  bool whole = true;             ///< false after cells were left out: the deck no longer fits the mesh

  [[nodiscard]] std::vector<std::string> contents() const override { return deck->contents; }
  [[nodiscard]] bool binds_ids() const override { return whole && !deck->unknown.empty(); }
  [[nodiscard]] std::shared_ptr<const FormatMetadata> moved(std::span<const Index> vertices,
                                                            std::span<const Index> cells) const override {
    auto result = std::make_shared<DeckMetadata>(*this);
    if (!whole) return result;
    const bool all_vertices = move_places(result->vertex_of, vertices);
    const bool all_cells = move_places(result->cell_of, cells);
    result->whole = all_vertices && all_cells;
    return result;
  }

  /// Returns the cell that the k-th element of the file is.
  [[nodiscard]] Index cell(Index k) const { return cell_of.empty() ? k : cell_of[k]; }
};

}  // namespace meshorder
