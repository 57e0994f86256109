// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Elements of Nastran that are cells, and the order of their nodes.

#include <meshorder/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace meshorder::nastran {

/// Further fields in which an element may name a node or a point.
enum class Extra : std::uint8_t {
  none,
  orientation,  ///< field 5 is a node if it is an integer and fields 6 and 7 are blank; else a direction
  warping       ///< as `orientation`; fields 17 and 18 are points
};

/// A type of element card.
struct ElementType {
  std::string_view name;
  Shape shape;
  int corners;               ///< number of nodes that every element has
  int most;                  ///< greatest number of nodes, with those of edges, faces and the interior
  bool has_property = true;  ///< whether field 2 is the number of a property
  Extra extra = Extra::none;

  /// Returns the field of the first node; field 1 is the number of the element.
  [[nodiscard]] std::size_t first_node() const { return has_property ? 3 : 2; }
};

constexpr std::size_t kMostNodes = 20;
constexpr std::size_t kOrientation = 5;
constexpr std::size_t kWarpingA = 17;
constexpr std::size_t kWarpingB = 18;

/// Returns the type of a card by its name in capitals; null if the card's elements are not cells. Valid for
/// the life of the program.
const ElementType* element_type(std::string_view name);

/// Returns whether elements of a type may end after their first `nodes` nodes.
bool has_size(const ElementType& type, int nodes);

/// Returns the card for cells of this shape and size from another format; an empty text if there is none.
std::string_view card_of(Shape shape, int nodes);

/// Returns the place of the k-th vertex of a cell among the nodes of its element. Nastran lists the nodes on
/// edges between bottom and top before those on edges of the top, VTK after them.
std::size_t node_place(Shape shape, int nodes, std::size_t k);

}  // namespace meshorder::nastran
