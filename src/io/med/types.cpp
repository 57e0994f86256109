// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/med/med.hpp"

#include <fmt/format.h>

#include <algorithm>

// Types of cells, the order of their nodes, and their groups in a file.

namespace meshorder::med {
namespace {

constexpr std::array kGeometryTypes{
    GeometryType{"TE4", 304, Shape::tetrahedron, 4}, GeometryType{"T10", 310, Shape::tetrahedron, 10},
    GeometryType{"PY5", 305, Shape::pyramid, 5},     GeometryType{"P13", 313, Shape::pyramid, 13},
    GeometryType{"PE6", 306, Shape::wedge, 6},       GeometryType{"P15", 315, Shape::wedge, 15},
    GeometryType{"P18", 318, Shape::wedge, 18},      GeometryType{"HE8", 308, Shape::hexahedron, 8},
    GeometryType{"H20", 320, Shape::hexahedron, 20}, GeometryType{"H27", 327, Shape::hexahedron, 27},
    GeometryType{"TR3", 203, Shape::triangle, 3},    GeometryType{"TR6", 206, Shape::triangle, 6},
    GeometryType{"TR7", 207, Shape::triangle, 7},    GeometryType{"QU4", 204, Shape::quad, 4},
    GeometryType{"QU8", 208, Shape::quad, 8},        GeometryType{"QU9", 209, Shape::quad, 9},
    GeometryType{"SE2", 102, Shape::line, 2},        GeometryType{"SE3", 103, Shape::line, 3},
    GeometryType{"SE4", 104, Shape::line, 4},        GeometryType{"PO1", 1, Shape::vertex, 1},
};

// MED lists the corners of a volume's first face in the opposite direction
constexpr std::array kTetrahedron{0, 2, 1, 3, 6, 5, 4, 7, 9, 8};
constexpr std::array kPyramid{0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10};
constexpr std::array kWedge{0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13, 17, 16, 15};
constexpr std::array kHexahedron{0,  3,  2,  1,  4,  7,  6,  5,  11, 10, 9,  8,  15, 14,
                                 13, 12, 16, 19, 18, 17, 24, 20, 23, 21, 22, 25, 26};

/// Returns the first type for which `is_wanted` returns true, null if there is none.
template <class IsWanted>
const GeometryType* first_type(const IsWanted& is_wanted) {
  const auto* const found = std::find_if(kGeometryTypes.begin(), kGeometryTypes.end(), is_wanted);
  return found == kGeometryTypes.end() ? nullptr : found;
}

}  // namespace

std::span<const GeometryType> geometry_types() { return kGeometryTypes; }

const GeometryType* geometry_type(std::string_view name) {
  return first_type([&](const GeometryType& type) { return type.name == name; });
}

const GeometryType* geometry_type(Shape shape, int nodes) {
  return first_type([&](const GeometryType& type) { return type.shape == shape && type.nodes == nodes; });
}

std::span<const int> mesh_order(const GeometryType& type) {
  const auto nodes = static_cast<std::size_t>(type.nodes);
  switch (type.shape) {
    case Shape::tetrahedron:
      return std::span(kTetrahedron).first(nodes);
    case Shape::pyramid:
      return std::span(kPyramid).first(nodes);
    case Shape::wedge:
      return std::span(kWedge).first(nodes);
    case Shape::hexahedron:
      return std::span(kHexahedron).first(nodes);
    default:
      return {};
  }
}

Range range_in(const Ranges& ranges, const GeometryType* type) {
  const auto found = ranges.find(type);
  return found == ranges.end() ? Range{} : found->second;
}

std::string MedLayout::path_of(const GeometryType* type) const {
  return type == nullptr ? step_path() + "/NOE" : fmt::format("{}/{}", cells_path(), type->name);
}

std::span<const int> MedLayout::order_of_points(const Piece& piece) const {
  const bool by_node = piece.at_nodes && !in_mesh_order && std::cmp_equal(piece.points, piece.type->nodes);
  return by_node ? mesh_order(*piece.type) : std::span<const int>();
}

}  // namespace meshorder::med
