// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/abaqus/abaqus.hpp"

#include <algorithm>

namespace meshorder::abaqus {
namespace {

/// Returns whether the cells of a card's elements still have the type of the card.
bool has_kind(const Mesh& mesh, const Metadata& metadata, const Section& section) {
  for (Index k = section.first; k < section.first + section.count; ++k) {
    const Index c = metadata.cell(k);
    if (ElementKind{mesh.cells.shapes[c], mesh.cells.vertex_count(c)} != section.kind) return false;
  }
  return true;
}

}  // namespace

const Metadata* own_deck(const Mesh& mesh) {
  const auto* const own = dynamic_cast<const Metadata*>(mesh.format_metadata.get());
  if (own == nullptr || !own->whole) return nullptr;
  const Deck& deck = *own->deck;
  if (deck.nodes.size() != mesh.vertex_count() || deck.elements.size() != mesh.cell_count()) return nullptr;
  const bool fits = std::all_of(deck.sections.begin(), deck.sections.end(), [&](const Section& section) {
    return section.part != Part::elements || has_kind(mesh, *own, section);
  });
  return fits ? own : nullptr;
}

}  // namespace meshorder::abaqus
