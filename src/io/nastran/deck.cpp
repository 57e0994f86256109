// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/nastran/nastran.hpp"

namespace meshorder::nastran {
namespace {

/// Returns whether the cell of each element of the deck has the element's shape and number of nodes.
bool has_cells_of(const Mesh& mesh, const Metadata& metadata) {
  const Deck& deck = *metadata.deck;
  for (Index k = 0; k < mesh.cell_count(); ++k) {
    const Index c = metadata.cell(k);
    const ElementCard& card = deck.elements[k];
    if (mesh.cells.shapes[c] != card.type->shape || mesh.cells.vertex_count(c) != card.nodes) return false;
  }
  return true;
}

}  // namespace

const Metadata* own_deck(const Mesh& mesh) {
  const auto* const own = dynamic_cast<const Metadata*>(mesh.format_metadata.get());
  if (own == nullptr || !own->whole) return nullptr;
  const Deck& deck = *own->deck;
  if (deck.node_numbers.size() != mesh.vertex_count() || deck.element_numbers.size() != mesh.cell_count()) {
    return nullptr;
  }
  return has_cells_of(mesh, *own) ? own : nullptr;
}

}  // namespace meshorder::nastran
