// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/shape.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace meshorder::unv {

/// A kind of cells: the shape and the number of nodes.
struct ElementKind {
  Shape shape;
  int nodes;

  bool operator==(const ElementKind&) const = default;
};

/// Returns the kind of cells for elements of a type ("FE descriptor id") with that many nodes; nullopt if
/// there is none.
std::optional<ElementKind> kind_of(std::int64_t type, std::int64_t nodes);

/// Returns the element type for cells of a mesh of another format; 0 if there is none.
int type_of(ElementKind kind);

/// Returns whether elements of a type are beams. Such elements have a line of three numbers after the first
/// line.
bool is_beam(std::int64_t type);

/// Returns, for each node of an element in the file's order, the position in the cell. In that order, middle
/// nodes come between their corners. Empty if both orders agree.
std::span<const int> file_order(ElementKind kind);

}  // namespace meshorder::unv
