// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>
#include <meshorder/shape.hpp>

#include <cstddef>
#include <optional>
#include <string_view>

namespace meshorder::abaqus {

/// The shape and the number of nodes of elements, or of the cells that they become.
struct ElementKind {
  Shape shape;
  int nodes;

  bool operator==(const ElementKind&) const = default;
};

/// Returns the kind of an element type such as "C3D8R", given in capitals; nullopt if the type is not known.
std::optional<ElementKind> kind_of(std::string_view type);

/// Returns the element type for cells of a mesh of another format; an empty text if there is none. `flat`:
/// the mesh has two coordinates and gets elements of plane stress in place of shells.
std::string_view type_of(ElementKind kind, bool flat);

/// Returns the place of the k-th vertex of a cell among the nodes of its element. Only lines of three nodes
/// differ from VTK's order: their middle node comes second.
inline std::size_t node_place(ElementKind kind, std::size_t k) {
  const bool bent = kind.shape == Shape::line && kind.nodes == 3;
  return bent && k > 0 ? 3 - k : k;
}

}  // namespace meshorder::abaqus
