// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writers of Nastran's bulk data.

#include "io/deck/metadata.hpp"
#include "io/format.hpp"
#include "io/nastran/card.hpp"
#include "io/nastran/elements.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::nastran {

/// Numbers of nodes, elements and properties fit 8 columns.
constexpr std::int64_t kLargestNumber = 99'999'999;

/// A card of an element that is a cell.
struct ElementCard {
  Piece place;
  const ElementType* type = nullptr;
  int nodes = 0;  ///< vertices of the cell: nodes of the card, or only its corners if others are missing
};

/// A file, and the places of nodes and elements in it.
struct Deck : DeckContents {
  std::string text;  ///< all lines; lines of included files are in place
  Piece bulk;        ///< the lines between BEGIN BULK and ENDDATA, or all lines
  std::vector<Piece> node_cards;
  std::vector<ElementCard> element_cards;
  std::vector<Point> points;        ///< positions of the nodes in the basic system
  bool has_default_system = false;  ///< whether GRDSET gives a system to nodes that name no system
  /// Default properties from BAROR and BEAMOR, by the name of the elements' card.
  std::map<std::string_view, std::int64_t> default_properties;
  std::vector<std::int64_t> other_points;    ///< numbers of points that are not nodes, ascending
  std::vector<std::int64_t> other_elements;  ///< numbers of elements that are not cells, ascending
  std::int64_t last_set = 0;                 ///< largest number of a set; `sets` has the sets of SET3
};

/// A deck, and where its nodes and elements are in the mesh.
using BulkMetadata = DeckMetadata<Deck>;

/// Returns the deck that a mesh can be written into; null if there is none. Valid as long as the mesh.
const BulkMetadata* deck_of(const Mesh& mesh);

/// The words before the name of a set, in the comment above its SET3.
constexpr std::string_view kSetComment = "$ set: ";

// ---- reading

Mesh read(const FilePath& path, Notes& notes);

/// Thrown for a card that cannot be read.
struct Fault {
  std::size_t byte = 0;  ///< byte of the text at which the card begins
  std::string what;
  std::string remedy;
};

/// A card, and its contents if it is a node or an element that is a cell.
struct Card {
  enum class Kind : std::uint8_t { node, element, other };
  static constexpr std::int64_t kBlank = -1;

  Piece place;
  Kind kind = Kind::other;
  bool has_more = false;        ///< whether the card has fields that are not stored here
  bool lacks_nodes = false;     ///< whether some nodes of edges are missing, so that only corners count
  std::int64_t number = 0;      ///< number of the node or element
  std::int64_t group = kBlank;  ///< system of the node or property of the element; kBlank if none is named
  Point point{};
  const ElementType* type = nullptr;
  int nodes = 0;                         ///< number of the cell's vertices
  std::array<Index, kMostNodes> cell{};  ///< numbers of the nodes, in the order of the cell's vertices
};

/// Returns the number of a node, element or property in a field of that card; throws Fault if the field holds
/// no such number.
std::int64_t number_in(const CardFields& fields, std::size_t field, std::string_view what, Piece card);

/// Parses the present card; uses the memory of `fields`. Throws Fault for a line that continues no card, and
/// for a faulty node or element.
Card parse_card(const Cards& cards, CardFields& fields);

// ---- writing

/// Writes a mesh into its deck; notes contents of the mesh that the deck cannot hold.
void write_into_deck(const Mesh& mesh, const BulkMetadata& own, const FilePath& path, Notes& notes);

/// Appends a set as SET3, with its name in a comment. Notes a set without members, which is left out, and a
/// name that changes.
///
/// @param number   of the set
/// @param numbers  of the nodes and elements
void append_set(std::string& out, std::int64_t number, const EntitySet& set, const DeckNumbers& numbers,
                std::string_view line_end, Notes& notes);

constexpr std::string_view kWidestField = "16 characters of a field of Nastran";

}  // namespace meshorder::nastran
