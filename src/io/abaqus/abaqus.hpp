// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writers of Abaqus's and CalculiX's decks.

#include "io/abaqus/elements.hpp"
#include "io/deck/metadata.hpp"
#include "io/format.hpp"
#include "io/stream/id_map.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::abaqus {

inline constexpr std::int64_t kLargest = 999'999'999;  ///< largest number of a node or element

enum class CardKind : std::uint8_t { text, nodes, elements };

/// A card of a deck.
struct DeckCard {
  CardKind part = CardKind::text;
  /// All lines of the card, as in the file. For nodes and elements: only the keyword lines and the comments
  /// between the data lines.
  std::string text = {};
  Index first = 0;  ///< position in the file of the card's first node or element
  Index count = 0;
  ElementKind kind = {};  ///< of the card's elements
};

/// The contents of a deck, in its own order.
struct Deck {
  std::vector<DeckCard> sections;
  IdMap nodes;                  ///< numbers in the order of the file
  IdMap elements;               ///< numbers of the elements that are cells, in the same way
  std::vector<EntitySet> sets;  ///< of the deck; members are positions in the file
  /// Ends of some lines, from a comma on, by position in the file. For a node: the text after the
  /// coordinates. For an element: the text after the last node that its type needs.
  std::map<Index, std::string> more_of_nodes;
  std::map<Index, std::string> more_of_elements;
  std::string line_end = "\n";
  /// Cards that may name nodes or elements by number but are not understood: "*USER ELEMENT (line 12)". If
  /// there are any, all numbers must stay.
  std::vector<std::string> unknown;
  std::vector<std::string> contents;  ///< contents that other formats lose
};

/// A deck, and the positions of its nodes and elements in the mesh.
using AbaqusMetadata = DeckMetadata<Deck>;

/// Returns the deck that a mesh was read from; null if there is none or if the mesh no longer fits it. Valid
/// as long as the mesh. O(cells).
const AbaqusMetadata* own_deck(const Mesh& mesh);

Mesh read(const FilePath& path, Notes& notes);

/// Writes a mesh as its deck, in the present order; notes the parts of the mesh that have no place in it.
void write_into_deck(const Mesh& mesh, const AbaqusMetadata& own, const FilePath& path, Notes& notes);

}  // namespace meshorder::abaqus
