// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writers of Abaqus's and CalculiX's decks.

#include "io/abaqus/elements.hpp"
#include "io/deck/metadata.hpp"

#include <array>
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
  ElementKind kind = {};  ///< kind of the card's elements
};

struct Deck : DeckContents {
  std::vector<DeckCard> sections;
  /// Text at the ends of data lines, from a comma on, after the coordinates or after the last node that the
  /// element's type needs; by the position of the node or element in the file.
  std::map<Index, std::string> more_of_nodes;
  std::map<Index, std::string> more_of_elements;
};

/// A deck, and the positions of its nodes and elements in the mesh.
using AbaqusMetadata = DeckMetadata<Deck>;

/// A number in at most 20 characters: Abaqus and CalculiX read no more.
struct RealText {
  explicit RealText(double value);
  [[nodiscard]] std::string_view text() const { return {buffer.data(), size}; }

  std::array<char, 40> buffer{};
  std::size_t size = 0;
  bool is_rounded = false;  ///< whether the text reads back to another number
};

Mesh read(const FilePath& path, Notes& notes);

}  // namespace meshorder::abaqus
