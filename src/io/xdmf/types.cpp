// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/xdmf/xdmf.hpp"

#include <algorithm>
#include <array>

namespace meshorder::xdmf {
namespace {

// for each shape, the first type that fits is chosen
constexpr std::array kTopologyTypes{
    TopologyType{"Polyvertex", kPolyvertex, 2, Shape::vertex, 0},
    TopologyType{"Polyline", kPolyline, 4, Shape::line, 0},
    TopologyType{"Polygon", 3, 7, Shape::polygon, 0},
    TopologyType{"Triangle", 4, 5, Shape::triangle, 3},
    TopologyType{"Quadrilateral", 5, 9, Shape::quad, 4},
    TopologyType{"Tetrahedron", 6, 10, Shape::tetrahedron, 4},
    TopologyType{"Pyramid", 7, 14, Shape::pyramid, 5},
    TopologyType{"Wedge", 8, 13, Shape::wedge, 6},
    TopologyType{"Hexahedron", 9, 12, Shape::hexahedron, 8},
    TopologyType{"Edge_3", 0x22, 21, Shape::line, 3},
    TopologyType{"Quadrilateral_9", 0x23, 28, Shape::quad, 9},
    TopologyType{"Triangle_6", 0x24, 22, Shape::triangle, 6},
    TopologyType{"Quadrilateral_8", 0x25, 23, Shape::quad, 8},
    TopologyType{"Tetrahedron_10", 0x26, 24, Shape::tetrahedron, 10},
    TopologyType{"Pyramid_13", 0x27, 27, Shape::pyramid, 13},
    TopologyType{"Wedge_15", 0x28, 26, Shape::wedge, 15},
    TopologyType{"Wedge_18", 0x29, 32, Shape::wedge, 18},
    TopologyType{"Hexahedron_20", 0x30, 25, Shape::hexahedron, 20},
    TopologyType{"Hexahedron_24", 0x31, 33, Shape::hexahedron, 24},
    TopologyType{"Hexahedron_27", 0x32, 29, Shape::hexahedron, 27},
    TopologyType{"Hexahedron_64", 0x33, 72, Shape::hexahedron, 64},
    TopologyType{"Hexahedron_125", 0x34, 72, Shape::hexahedron, 125},
    TopologyType{"Hexahedron_216", 0x35, 72, Shape::hexahedron, 216},
    TopologyType{"Hexahedron_343", 0x36, 72, Shape::hexahedron, 343},
    TopologyType{"Hexahedron_512", 0x37, 72, Shape::hexahedron, 512},
    TopologyType{"Hexahedron_729", 0x38, 72, Shape::hexahedron, 729},
    TopologyType{"Hexahedron_1000", 0x39, 72, Shape::hexahedron, 1000},
    TopologyType{"Hexahedron_1331", 0x40, 72, Shape::hexahedron, 1331},
};
constexpr int kFirstOfHigherOrder = 0x33;

constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kOtherNames{{
    {"Tri", "Triangle"},
    {"Quad", "Quadrilateral"},
    {"Tet", "Tetrahedron"},
    {"Hex", "Hexahedron"},
    {"Tri_6", "Triangle_6"},
    {"Quad_8", "Quadrilateral_8"},
    {"Quad_9", "Quadrilateral_9"},
    {"Tet_10", "Tetrahedron_10"},
    {"Hex_20", "Hexahedron_20"},
    {"Hex_24", "Hexahedron_24"},
    {"Hex_27", "Hexahedron_27"},
    {"Hex_64", "Hexahedron_64"},
}};

}  // namespace

const TopologyType* topology_type(std::string_view name) {
  for (const auto& [other, usual] : kOtherNames) {
    if (same_but_for_case(other, name)) name = usual;
  }
  const auto found =
      std::find_if(kTopologyTypes.begin(), kTopologyTypes.end(),
                   [&](const TopologyType& type) { return same_but_for_case(type.name, name); });
  return found == kTopologyTypes.end() ? nullptr : &*found;
}

const TopologyType* topology_type(std::int64_t number) {
  const auto found = std::find_if(kTopologyTypes.begin(), kTopologyTypes.end(),
                                  [&](const TopologyType& type) { return type.number == number; });
  return found == kTopologyTypes.end() ? nullptr : &*found;
}

const TopologyType* topology_type_of(Shape shape, int vertices) {
  if (shape == Shape::poly_vertex) return topology_type(std::int64_t{kPolyvertex});
  if (shape == Shape::polyline || (shape == Shape::line && vertices == 2))
    return topology_type(std::int64_t{kPolyline});
  const auto found =
      std::find_if(kTopologyTypes.begin(), kTopologyTypes.end(), [&](const TopologyType& type) {
        const bool any = type.nodes == 0 && shape != Shape::line;
        return type.shape == shape && (any || type.nodes == vertices);
      });
  return found == kTopologyTypes.end() ? nullptr : &*found;
}

int vtk_type(const TopologyType& type, std::int64_t nodes) {
  constexpr int kVtkVertex = 1;
  constexpr int kVtkLine = 3;
  if (type.number == kPolyvertex && nodes == 1) return kVtkVertex;
  if (type.number == kPolyline && nodes == 2) return kVtkLine;
  return type.vtk;
}

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  const TopologyType* const type = topology_type_of(shape, vertices);
  if (type == nullptr || (shape == Shape::vertex && vertices != 1)) return false;
  return type->number < kFirstOfHigherOrder ||
         dynamic_cast<const XdmfLayout*>(mesh.format_metadata.get()) != nullptr;
}

}  // namespace meshorder::xdmf
