// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// What the cards of nodes and elements say.

#include "io/nastran/card.hpp"
#include "io/nastran/elements.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace meshorder::nastran {

/// Thrown for a card that cannot be read.
struct Fault {
  std::size_t byte = 0;  ///< of the text, where the card begins
  std::string what;
  std::string remedy;
};

/// A card, and its contents if it is a node or an element that is a cell.
struct Card {
  enum class Kind : std::uint8_t { node, element, other };
  static constexpr std::int64_t kBlank = -1;

  Piece place;
  Kind kind = Kind::other;
  bool has_more = false;        ///< whether other fields follow these
  bool lacks_nodes = false;     ///< whether some nodes of edges are missing, so that only corners count
  std::int64_t number = 0;      ///< of the node or element
  std::int64_t group = kBlank;  ///< system of the node or property of the element; kBlank if it names none
  Point point{};
  const ElementType* type = nullptr;
  int nodes = 0;                         ///< of the cell
  std::array<Index, kMostNodes> cell{};  ///< numbers of the nodes, in the order of the cell's vertices
};

/// Returns the number of a node, element or property in a field of that card; throws Fault if the field holds
/// no such number.
std::int64_t number_in(const CardFields& fields, std::size_t field, std::string_view what, Piece card);

/// Parses the present card; uses the memory of `fields`. Throws Fault if it is a line that continues no card,
/// or a node or an element with a fault.
Card parse_card(const Cards& cards, CardFields& fields);

}  // namespace meshorder::nastran
