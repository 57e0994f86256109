// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/deck/numbers.hpp"
#include <meshorder/mesh.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// The contents of a deck or a similar file, and the positions of its nodes and elements in the mesh. The
/// contents stay the same while the mesh is reordered.
///
/// @tparam Deck  contents of the file, in its own order. Two members are used: `contents` lists what other
///               formats lose; `unknown` lists the parts that may name nodes or elements by number but are
///               not understood. If `unknown` is not empty, all numbers must stay.
template <class Deck>
struct DeckMetadata final : FormatMetadata {
  std::shared_ptr<const Deck> deck;
  std::vector<Index> vertex_of;  ///< vertex of each node of the file; empty if both have the same order
  std::vector<Index> cell_of;    ///< cell of each element of the file; empty if both have the same order
  bool whole = true;             ///< false once vertices or cells are left out: the deck no longer fits

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

  /// Returns the cell of the k-th element of the file.
  [[nodiscard]] Index cell(Index k) const { return cell_of.empty() ? k : cell_of[k]; }
};

}  // namespace meshorder
