// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/shape.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace meshorder::unv {

/// The cells that elements are.
struct ElementKind {
  Shape shape;
  int nodes;

  bool operator==(const ElementKind&) const = default;
};

/// Returns the cells that elements of a type ("FE descriptor id") with so many nodes are; none if they are
/// not known.
std::optional<ElementKind> kind_of(std::int64_t type, std::int64_t nodes);

/// Returns the type that cells of a mesh of another format are written as; 0 if there is none.
int type_of(ElementKind kind);

/// Returns whether a line of three numbers follows the first one of an element: always for beams, which these
/// types are.
bool is_beam(std::int64_t type);

/// Returns the vertex of the cell that each node of an element is, in the order of the file: middle nodes
/// come between their corners. Empty where the order is the cell's.
std::span<const int> file_order(ElementKind kind);

}  // namespace meshorder::unv
