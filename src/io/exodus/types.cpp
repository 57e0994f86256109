// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/exodus/exodus.hpp"

#include <algorithm>

// Types of elements, their nodes and their sides.

namespace meshorder::exodus {
namespace {

struct TypeName {
  std::string_view begin;
  Shape shape;
};

constexpr Shape kVertex = Shape::vertex;

// shapes by the first letters of a type; the shape of SHELL depends on its number of nodes
constexpr std::array kTypeNames{
    TypeName{"SPHERE", kVertex},     TypeName{"CIRCLE", kVertex},         TypeName{"POINT", kVertex},
    TypeName{"NODE", kVertex},       TypeName{"BAR", Shape::line},        TypeName{"BEAM", Shape::line},
    TypeName{"TRUSS", Shape::line},  TypeName{"ROD", Shape::line},        TypeName{"EDGE", Shape::line},
    TypeName{"LINE", Shape::line},   TypeName{"SPRING", Shape::line},     TypeName{"TRI", Shape::triangle},
    TypeName{"QUAD", Shape::quad},   TypeName{"TET", Shape::tetrahedron}, TypeName{"PYR", Shape::pyramid},
    TypeName{"WEDGE", Shape::wedge}, TypeName{"PRISM", Shape::wedge},     TypeName{"HEX", Shape::hexahedron},
};

constexpr std::string_view kShell = "SHELL";

struct WrittenType {
  Shape shape;
  int nodes;
  std::string_view name;
};

// names that the format defines and that meshio reads as well
constexpr std::array kWrittenTypes{
    WrittenType{Shape::vertex, 1, "SPHERE"},        WrittenType{Shape::line, 2, "BAR2"},
    WrittenType{Shape::line, 3, "BEAM3"},           WrittenType{Shape::triangle, 3, "TRI3"},
    WrittenType{Shape::triangle, 6, "TRI6"},        WrittenType{Shape::triangle, 7, "TRI7"},
    WrittenType{Shape::quad, 4, "QUAD4"},           WrittenType{Shape::quad, 8, "QUAD8"},
    WrittenType{Shape::quad, 9, "QUAD9"},           WrittenType{Shape::tetrahedron, 4, "TETRA"},
    WrittenType{Shape::tetrahedron, 10, "TETRA10"}, WrittenType{Shape::pyramid, 5, "PYRAMID"},
    WrittenType{Shape::pyramid, 13, "PYRAMID13"},   WrittenType{Shape::pyramid, 14, "PYRAMID14"},
    WrittenType{Shape::wedge, 6, "WEDGE"},          WrittenType{Shape::wedge, 15, "WEDGE15"},
    WrittenType{Shape::wedge, 18, "WEDGE18"},       WrittenType{Shape::hexahedron, 8, "HEX8"},
    WrittenType{Shape::hexahedron, 20, "HEX20"},    WrittenType{Shape::hexahedron, 27, "HEX27"},
};

// order in the file: nodes on the edges between the two triangles precede the nodes on the edges of the upper
// triangle
constexpr std::array kWedge{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11, 15, 16, 17};
// nodes on edges as for wedges; then the centre, then the faces (bottom, top, left, right, front, back)
constexpr std::array kHexahedron{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 16, 17,
                                 18, 19, 12, 13, 14, 15, 23, 24, 25, 26, 21, 22, 20};

bool begins_with(std::string_view type, std::string_view word) {
  return same_but_for_case(type.substr(0, word.size()), word);
}

/// Returns the number of nodes of a face with `corners` corners.
int nodes_of_face(int corners, bool quadratic, bool has_centre) {
  return (quadratic ? 2 * corners : corners) + (has_centre ? 1 : 0);
}

}  // namespace

std::optional<Shape> shape_of(std::string_view type, int nodes, int dimension) {
  std::optional<Shape> shape;
  for (const TypeName& name : kTypeNames) {
    if (!shape && begins_with(type, name.begin)) shape = name.shape;
  }
  if (begins_with(type, kShell)) {
    // in two dimensions, a shell of up to three nodes is a line
    const bool is_line = dimension < 3 && nodes <= 3;
    const bool is_triangle = nodes == 3 || nodes == 6 || nodes == 7;
    shape = is_line ? Shape::line : is_triangle ? Shape::triangle : Shape::quad;
  }
  const bool fits = shape && (*shape == Shape::vertex ? nodes == 1 : nodes >= corners(*shape, nodes));
  return fits ? shape : std::nullopt;
}

std::string_view type_of(Shape shape, int nodes) {
  for (const WrittenType& type : kWrittenTypes) {
    if (type.shape == shape && type.nodes == nodes) return type.name;
  }
  return {};
}

std::span<const int> file_order(Shape shape, int nodes) {
  if (shape == Shape::wedge && (nodes == 15 || nodes == 18)) return std::span(kWedge).first(nodes);
  if (shape == Shape::hexahedron && (nodes == 20 || nodes == 27)) return std::span(kHexahedron).first(nodes);
  return {};
}

int faces_of(Shape shape, std::string_view type, int dimension) {
  const bool has_faces =
      (shape == Shape::triangle && dimension == 3) || (shape == Shape::quad && begins_with(type, kShell));
  return has_faces ? 2 : 0;
}

int nodes_of_side(Shape shape, int nodes, int side, int faces) {
  if (side < 1) return 0;
  switch (shape) {
    case Shape::tetrahedron:
      return side <= 4 ? nodes_of_face(3, nodes >= 10, nodes == 8 || nodes >= 14) : 0;
    case Shape::pyramid:
      if (side == 5) return nodes_of_face(4, nodes >= 13, nodes >= 14);
      return side < 5 ? nodes_of_face(3, nodes >= 13, nodes >= 18) : 0;
    case Shape::wedge:
      if (side > 5) return 0;
      return side < 4 ? nodes_of_face(4, nodes >= 15, nodes >= 18)
                      : nodes_of_face(3, nodes >= 15, nodes >= 20);
    case Shape::hexahedron:
      return side <= 6 ? nodes_of_face(4, nodes >= 20, nodes >= 27) : 0;
    case Shape::triangle:
    case Shape::quad: {
      const int edges = corners(shape, nodes);
      if (side <= faces) return nodes;
      return side <= faces + edges ? (nodes >= 2 * edges ? 3 : 2) : 0;
    }
    case Shape::line:
      return side <= 2 ? nodes : side <= 4 ? 1 : 0;
    case Shape::vertex:
      return side <= kMostSides ? 1 : 0;
    default:
      return 0;
  }
}

std::string title(const SetKind& kind, std::string_view in_mesh) {
  return in_mesh.starts_with(kind.word) ? std::string(in_mesh)
                                        : std::string(kind.word) + std::string(in_mesh);
}

std::string name_of_step(const std::string& name, std::size_t step, std::size_t steps) {
  return steps > 1 ? name + " step " + std::to_string(step + 1) : name;
}

}  // namespace meshorder::exodus
