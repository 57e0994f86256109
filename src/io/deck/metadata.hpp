// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/deck/numbers.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {

/// The contents that all decks have, in the order of the deck.
struct DeckContents {
  IdMap nodes;                  ///< numbers of the nodes
  IdMap elements;               ///< numbers of the elements that are cells
  std::vector<EntitySet> sets;  ///< members are positions in the file
  std::string line_end = "\n";
  /// Cards or datasets that meshorder does not know and that may name nodes or elements by number: "CWELD
  /// (line 12)". If there are any, all numbers must stay.
  std::vector<std::string> unknown;
  std::vector<std::string> contents;  ///< contents that other formats lose
};

/// The contents of a deck or a similar file, and the positions of its nodes and elements in the mesh. The
/// contents stay the same while the mesh is reordered.
///
/// @tparam Deck  derived from DeckContents
template <class Deck>
struct DeckMetadata final : FormatMetadata {
  explicit DeckMetadata(std::shared_ptr<const Deck> of_file) : deck(std::move(of_file)) {}

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

  /// Returns the numbers of the nodes and elements in a mesh that fits the deck.
  [[nodiscard]] DeckNumbers numbers(const Mesh& mesh) const {
    return {{deck->nodes, vertex_of, mesh.vertex_ids}, {deck->elements, cell_of, mesh.cell_ids}};
  }
  /// Returns the numbers of a mesh that came from elsewhere: its ids if they can be numbers up to `largest`,
  /// else 1, 2, 3 …
  [[nodiscard]] DeckNumbers new_numbers(const Mesh& mesh, std::int64_t largest) const {
    return {{deck->nodes, {}, ids_as_numbers(mesh.vertex_ids, largest)},
            {deck->elements, {}, ids_as_numbers(mesh.cell_ids, largest)}};
  }
};

/// Throws InputError unless a deck has nodes and elements that are cells.
///
/// @param others  types of its other elements, as one text
inline void require_mesh(const DeckContents& deck, const std::string& file, const std::string& no_nodes,
                         const std::string& no_elements, const std::string& others,
                         const std::string& remedy_of_others = "nothing can be reordered") {
  const std::string no_mesh = "the file may be cut short, or its mesh may be in another file";
  if (deck.nodes.size() == 0) throw InputError(file, no_nodes, no_mesh);
  if (deck.elements.size() > 0) return;
  if (others.empty()) throw InputError(file, no_elements, no_mesh);
  throw InputError(file, fmt::format("its only elements are of types that are not cells here ({})", others),
                   remedy_of_others);
}

/// Gives a mesh the ids and metadata of a deck. Vertices and cells must be in the deck's order.
template <class Deck>
void keep_deck(Mesh& mesh, std::shared_ptr<Deck> deck) {
  mesh.vertex_ids = deck->nodes.ids_unless_from(1);
  mesh.cell_ids = deck->elements.ids_unless_from(1);
  if (mesh.cell_blocks.size() < 2) mesh.cell_blocks.clear();
  mesh.format_metadata = std::make_shared<DeckMetadata<Deck>>(std::move(deck));
}

/// Returns the deck that a mesh can be written into; null if the mesh came from elsewhere or no longer fits
/// its deck. Valid as long as the mesh. O(cells).
///
/// @param fits  `fits(deck, k, shape, vertices)` returns whether such a cell fits the k-th element of the
///              deck; called for k = 0, 1, 2 …
template <class Deck, class Fits>
const DeckMetadata<Deck>* own_deck(const Mesh& mesh, Fits fits) {
  const auto* const own = dynamic_cast<const DeckMetadata<Deck>*>(mesh.format_metadata.get());
  if (own == nullptr || !own->whole) return nullptr;
  const Deck& deck = *own->deck;
  if (deck.nodes.size() != mesh.vertex_count() || deck.elements.size() != mesh.cell_count()) return nullptr;
  for (Index k = 0; k < mesh.cell_count(); ++k) {
    const Index c = own->cell_of.empty() ? k : own->cell_of[k];
    if (!fits(deck, k, mesh.cells.shapes[c], mesh.cells.vertex_count(c))) return nullptr;
  }
  return own;
}

/// A cell's vertex, whose node follows the element in the deck.
///
/// @tparam Place  type of the element's place in the deck, for a message
template <class Place>
struct LaterNode {
  Offset entry;         ///< position in Cells::vertices
  std::int64_t number;  ///< number of the node
  Place place;          ///< place of the element in the deck
};

/// Sets the vertices of `cells` that `nodes` lists. Calls `fail(later)`, which throws, if there is no such
/// node.
template <class Place, class Fail>
void resolve(const std::vector<LaterNode<Place>>& nodes, const IdMap& numbers, Cells& cells, Fail fail) {
  for (const LaterNode<Place>& later : nodes) {
    const Index v = numbers.find(later.number);
    if (v < 0) fail(later);
    cells.vertices[static_cast<std::size_t>(later.entry)] = v;
  }
}

}  // namespace meshorder
