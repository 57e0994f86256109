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

enum class Part : std::uint8_t { text, nodes, elements };

/// A card of a deck.
struct Section {
  Part part = Part::text;
  /// All lines of the card, as they are in the file; of nodes and elements those of the keyword, and comments
  /// between the data.
  std::string text = {};
  Index first = 0;  ///< of the file's nodes or elements that the card has
  Index count = 0;
  ElementKind kind = {};  ///< of elements
};

/// What a deck says, in its own order.
struct Deck {
  std::vector<Section> sections;
  IdMap nodes;                  ///< numbers in the order of the file
  IdMap elements;               ///< of those that are cells
  std::vector<EntitySet> sets;  ///< of the deck; members are positions in the file
  /// What the lines of some nodes have after their coordinates, and those of some elements after the nodes of
  /// their type, from the comma on; by positions in the file.
  std::map<Index, std::string> more_of_nodes;
  std::map<Index, std::string> more_of_elements;
  std::string line_end = "\n";
  /// Cards that may name nodes or elements by number and are not understood: "*USER ELEMENT (line 12)". With
  /// one of them all numbers must stay.
  std::vector<std::string> unknown;
  std::vector<std::string> contents;  ///< what other formats lose
};

/// A deck, and where its nodes and elements are in the mesh.
using Metadata = DeckMetadata<Deck>;

/// Returns the deck that a mesh can be written into; null if it came from elsewhere or no longer fits. Valid
/// as long as the mesh. O(cells).
const Metadata* own_deck(const Mesh& mesh);

Mesh read(const FilePath& path, Notes& notes);

/// Writes a mesh into its deck; notes what has no place.
void write_into_deck(const Mesh& mesh, const Metadata& own, const FilePath& path, Notes& notes);

}  // namespace meshorder::abaqus
