// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/cgns.hpp"

#include <algorithm>

// Types of elements and the order of their nodes.

namespace meshorder::cgns {
namespace {

// if two types have the same shape and number of nodes, the first one is written
constexpr std::array kTypes{
    ElementType{2, "NODE", Shape::vertex, 1},
    ElementType{3, "BAR_2", Shape::line, 2},
    ElementType{4, "BAR_3", Shape::line, 3},
    ElementType{5, "TRI_3", Shape::triangle, 3},
    ElementType{6, "TRI_6", Shape::triangle, 6},
    ElementType{7, "QUAD_4", Shape::quad, 4},
    ElementType{8, "QUAD_8", Shape::quad, 8},
    ElementType{9, "QUAD_9", Shape::quad, 9},
    ElementType{10, "TETRA_4", Shape::tetrahedron, 4},
    ElementType{11, "TETRA_10", Shape::tetrahedron, 10},
    ElementType{12, "PYRA_5", Shape::pyramid, 5},
    ElementType{13, "PYRA_14", Shape::pyramid, 14},
    ElementType{14, "PENTA_6", Shape::wedge, 6},
    ElementType{15, "PENTA_15", Shape::wedge, 15},
    ElementType{16, "PENTA_18", Shape::wedge, 18},
    ElementType{17, "HEXA_8", Shape::hexahedron, 8},
    ElementType{18, "HEXA_20", Shape::hexahedron, 20},
    ElementType{19, "HEXA_27", Shape::hexahedron, 27},
    ElementType{21, "PYRA_13", Shape::pyramid, 13},
    ElementType{24, "BAR_4", Shape::line, 4},
    ElementType{25, "TRI_9", Shape::triangle, 9},
    ElementType{26, "TRI_10", Shape::triangle, 10},
    ElementType{27, "QUAD_12", Shape::quad, 12},
    ElementType{28, "QUAD_16", Shape::quad, 16},
    ElementType{29, "TETRA_16", Shape::tetrahedron, 16},
    ElementType{30, "TETRA_20", Shape::tetrahedron, 20},
    ElementType{31, "PYRA_21", Shape::pyramid, 21},
    ElementType{32, "PYRA_29", Shape::pyramid, 29},
    ElementType{33, "PYRA_30", Shape::pyramid, 30},
    ElementType{34, "PENTA_24", Shape::wedge, 24},
    ElementType{35, "PENTA_38", Shape::wedge, 38},
    ElementType{36, "PENTA_40", Shape::wedge, 40},
    ElementType{37, "HEXA_32", Shape::hexahedron, 32},
    ElementType{38, "HEXA_56", Shape::hexahedron, 56},
    ElementType{39, "HEXA_64", Shape::hexahedron, 64},
    ElementType{40, "BAR_5", Shape::line, 5},
    ElementType{41, "TRI_12", Shape::triangle, 12},
    ElementType{42, "TRI_15", Shape::triangle, 15},
    ElementType{43, "QUAD_P4_16", Shape::quad, 16},
    ElementType{44, "QUAD_25", Shape::quad, 25},
    ElementType{45, "TETRA_22", Shape::tetrahedron, 22},
    ElementType{46, "TETRA_34", Shape::tetrahedron, 34},
    ElementType{47, "TETRA_35", Shape::tetrahedron, 35},
    ElementType{48, "PYRA_P4_29", Shape::pyramid, 29},
    ElementType{49, "PYRA_50", Shape::pyramid, 50},
    ElementType{50, "PYRA_55", Shape::pyramid, 55},
    ElementType{51, "PENTA_33", Shape::wedge, 33},
    ElementType{52, "PENTA_66", Shape::wedge, 66},
    ElementType{53, "PENTA_75", Shape::wedge, 75},
    ElementType{54, "HEXA_44", Shape::hexahedron, 44},
    ElementType{55, "HEXA_98", Shape::hexahedron, 98},
    ElementType{56, "HEXA_125", Shape::hexahedron, 125},
};

// order in the file: nodes on the edges between the two triangles precede those on the edges of the upper
// triangle
constexpr std::array kWedge{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11, 15, 16, 17};
// nodes on edges as for wedges, then those on faces (bottom, front, right, back, left, top), then the centre
constexpr std::array kHexahedron{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 16, 17,
                                 18, 19, 12, 13, 14, 15, 24, 22, 21, 23, 20, 25, 26};

/// Returns the first type for which `is_wanted` returns true, null if there is none.
template <class IsWanted>
const ElementType* first_type(const IsWanted& is_wanted) {
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(), is_wanted);
  return found == kTypes.end() ? nullptr : found;
}

}  // namespace

const ElementType* element_type(std::int64_t number) {
  return first_type([=](const ElementType& type) { return type.number == number; });
}

const ElementType* element_type_of(Shape shape, int nodes) {
  return first_type([=](const ElementType& type) { return type.shape == shape && type.nodes == nodes; });
}

std::span<const int> file_order(Shape shape, int nodes) {
  if (shape == Shape::wedge && (nodes == 15 || nodes == 18)) return std::span(kWedge).first(nodes);
  if (shape == Shape::hexahedron && (nodes == 20 || nodes == 27)) return std::span(kHexahedron).first(nodes);
  return {};
}

}  // namespace meshorder::cgns
