// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>
#include <meshorder/shape.hpp>

#include <cstddef>
#include <optional>
#include <string_view>

namespace meshorder::abaqus {

/// The cells that elements of a type are.
struct ElementKind {
  Shape shape;
  int nodes;

  bool operator==(const ElementKind&) const = default;
};

/// Returns the cells that elements of a type such as "C3D8R" are, in capitals; none if the type is not known.
std::optional<ElementKind> kind_of(std::string_view type);

/// Returns the type that cells of a mesh of another format are written as; an empty text if there is none.
/// `flat` meshes, of two coordinates, get elements of plane stress in place of shells.
std::string_view type_of(ElementKind kind, bool flat);

/// Returns the place of the k-th vertex of a cell among the nodes of its element. Only lines of three nodes
/// have another order than VTK: their middle node is the second.
inline std::size_t node_place(ElementKind kind, std::size_t k) {
  const bool bent = kind.shape == Shape::line && kind.nodes == 3;
  return bent && k > 0 ? 3 - k : k;
}

}  // namespace meshorder::abaqus
