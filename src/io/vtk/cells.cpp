// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Cell types of VTK's file formats: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html and
// vtkCellType.h.
#include "io/vtk/vtk.hpp"
#include "io/wedges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace meshorder::vtk {
namespace {

struct CellType {
  int number;
  std::string_view name;
  Shape shape;
  int vertices;  // number of vertices; if negative, there are at least −vertices

  // pairs of positions to swap for a Mesh; {0, 0} swaps nothing
  std::array<std::pair<int, int>, 2> swapped{};
};

constexpr int kPixel = 8;
constexpr int kTetrahedron = 10;
constexpr int kVoxel = 11;
constexpr int kLinearWedge = 13;
constexpr int kPyramid = 14;

// The first triangle of a linear wedge faces outward in VTK up to 9.6 and in VTK files by Gmsh and meshio. It
// faces inward in a Mesh, in Gmsh's own files, in Lagrange wedges and in VTK 9.7. This direction decides
// faces, normals and volumes. Quadratic wedges are ordered as in a Mesh, also in the files of Gmsh and
// meshio; VTK 9.1 sees their faces from inside, which the release notes of a later version call a mistake.
constexpr std::array<std::pair<int, int>, 2> kWedge{{{1, 2}, {4, 5}}};

// for a shape and its number of vertices, the first type that fits is chosen
constexpr std::array kTypes{
    CellType{1, "VTK_VERTEX", Shape::vertex, 1},
    CellType{2, "VTK_POLY_VERTEX", Shape::poly_vertex, -1},
    CellType{3, "VTK_LINE", Shape::line, 2},
    CellType{4, "VTK_POLY_LINE", Shape::polyline, -1},
    CellType{5, "VTK_TRIANGLE", Shape::triangle, 3},
    CellType{6, "VTK_TRIANGLE_STRIP", Shape::triangle_strip, -3},
    CellType{7, "VTK_POLYGON", Shape::polygon, -1},
    CellType{9, "VTK_QUAD", Shape::quad, 4},
    CellType{kTetrahedron, "VTK_TETRA", Shape::tetrahedron, 4},
    CellType{12, "VTK_HEXAHEDRON", Shape::hexahedron, 8},
    CellType{kLinearWedge, "VTK_WEDGE", Shape::wedge, 6, kWedge},
    CellType{kPyramid, "VTK_PYRAMID", Shape::pyramid, 5},
    CellType{21, "VTK_QUADRATIC_EDGE", Shape::line, 3},
    CellType{22, "VTK_QUADRATIC_TRIANGLE", Shape::triangle, 6},
    CellType{23, "VTK_QUADRATIC_QUAD", Shape::quad, 8},
    CellType{24, "VTK_QUADRATIC_TETRA", Shape::tetrahedron, 10},
    CellType{25, "VTK_QUADRATIC_HEXAHEDRON", Shape::hexahedron, 20},
    CellType{26, "VTK_QUADRATIC_WEDGE", Shape::wedge, 15},
    CellType{27, "VTK_QUADRATIC_PYRAMID", Shape::pyramid, 13},
    CellType{28, "VTK_BIQUADRATIC_QUAD", Shape::quad, 9},
    CellType{29, "VTK_TRIQUADRATIC_HEXAHEDRON", Shape::hexahedron, 27},
    CellType{30, "VTK_QUADRATIC_LINEAR_QUAD", Shape::quad, 6},
    CellType{31, "VTK_QUADRATIC_LINEAR_WEDGE", Shape::wedge, 12},
    CellType{32, "VTK_BIQUADRATIC_QUADRATIC_WEDGE", Shape::wedge, 18},
    CellType{33, "VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON", Shape::hexahedron, 24},
    CellType{34, "VTK_BIQUADRATIC_TRIANGLE", Shape::triangle, 7},
    CellType{35, "VTK_CUBIC_LINE", Shape::line, 4},
    CellType{37, "VTK_TRIQUADRATIC_PYRAMID", Shape::pyramid, 19},
    CellType{68, "VTK_LAGRANGE_CURVE", Shape::line, -2},
    CellType{69, "VTK_LAGRANGE_TRIANGLE", Shape::triangle, -3},
    CellType{70, "VTK_LAGRANGE_QUADRILATERAL", Shape::quad, -4},
    CellType{71, "VTK_LAGRANGE_TETRAHEDRON", Shape::tetrahedron, -4},
    CellType{72, "VTK_LAGRANGE_HEXAHEDRON", Shape::hexahedron, -8},
    CellType{73, "VTK_LAGRANGE_WEDGE", Shape::wedge, -6},
    CellType{74, "VTK_LAGRANGE_PYRAMID", Shape::pyramid, -5},
    CellType{kPixel, "VTK_PIXEL", Shape::quad, 4, {{{2, 3}}}},
    CellType{kVoxel, "VTK_VOXEL", Shape::hexahedron, 8, {{{2, 3}, {6, 7}}}},
    CellType{36, "VTK_QUADRATIC_POLYGON", Shape::polygon, -3},
    CellType{kPolyhedron, "VTK_POLYHEDRON", Shape::polyhedron, -1},
    CellType{15, "VTK_PENTAGONAL_PRISM", Shape::polyhedron, 10},
    CellType{16, "VTK_HEXAGONAL_PRISM", Shape::polyhedron, 12},
    CellType{60, "VTK_HIGHER_ORDER_EDGE", Shape::line, -2},
    CellType{61, "VTK_HIGHER_ORDER_TRIANGLE", Shape::triangle, -3},
    CellType{62, "VTK_HIGHER_ORDER_QUAD", Shape::quad, -4},
    CellType{64, "VTK_HIGHER_ORDER_TETRAHEDRON", Shape::tetrahedron, -4},
    CellType{65, "VTK_HIGHER_ORDER_WEDGE", Shape::wedge, -6},
    CellType{66, "VTK_HIGHER_ORDER_PYRAMID", Shape::pyramid, -5},
    CellType{67, "VTK_HIGHER_ORDER_HEXAHEDRON", Shape::hexahedron, -8},
    CellType{75, "VTK_BEZIER_CURVE", Shape::line, -2},
    CellType{76, "VTK_BEZIER_TRIANGLE", Shape::triangle, -3},
    CellType{77, "VTK_BEZIER_QUADRILATERAL", Shape::quad, -4},
    CellType{78, "VTK_BEZIER_TETRAHEDRON", Shape::tetrahedron, -4},
    CellType{79, "VTK_BEZIER_HEXAHEDRON", Shape::hexahedron, -8},
    CellType{80, "VTK_BEZIER_WEDGE", Shape::wedge, -6},
    CellType{81, "VTK_BEZIER_PYRAMID", Shape::pyramid, -5},
};

/// Types with swapped vertices, by number; nullptr for the others.
constexpr std::array<const CellType*, 256> kSwappedTypes = [] {
  std::array<const CellType*, 256> types{};
  for (const CellType& type : kTypes) {
    if (type.swapped != decltype(type.swapped){}) types[static_cast<std::size_t>(type.number)] = &type;
  }
  return types;
}();

constexpr int kFirstLagrange = 68;
constexpr int kLastLagrange = 74;

const CellType* type_of(int number) {
  const auto found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const CellType& t) { return t.number == number; });
  return found == kTypes.end() ? nullptr : &*found;
}

bool fits(const CellType& type, Offset vertices) {
  return type.vertices > 0 ? vertices == type.vertices : vertices >= -type.vertices;
}

void swap_vertices(const CellType& type, Index* vertices) {
  for (const auto& [a, b] : type.swapped) std::swap(vertices[a], vertices[b]);
}

/// Returns the default type of a shape with that number of vertices, or nullptr.
const CellType* default_type(Shape shape, int vertices) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const CellType& type) {
    return type.shape == shape && fits(type, vertices);
  });
  return found == kTypes.end() ? nullptr : &*found;
}

/// Returns whether a cell of this shape and number of vertices can have VTK's type `number`.
bool can_be(int number, Shape shape, int vertices) {
  const CellType* const type = type_of(number);
  return type != nullptr && type->shape == shape && fits(*type, vertices);
}

/// Returns the array of VTK's type numbers that the reader kept; null if there is none, or if a number does
/// not fit its cell. O(cells).
const std::vector<std::uint8_t>* kept_types(const Mesh& mesh) {
  const DataArray* const kept = find_array(mesh, kCellTypes, Association::cells);
  if (kept == nullptr || !kept->is_dense() || kept->components != 1) return nullptr;
  const auto* const numbers = std::get_if<std::vector<std::uint8_t>>(&kept->values);
  if (numbers == nullptr) return nullptr;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (!can_be((*numbers)[c], mesh.cells.shapes[c], mesh.cells.vertex_count(c))) return nullptr;
  }
  return numbers;
}

/// Caches default types: a mesh has few different types.
class DefaultTypes {
 public:
  const CellType* operator()(Shape shape, int vertices) {
    if (vertices >= kRemembered) return default_type(shape, vertices);
    auto& [known, type] = types_[static_cast<std::size_t>(shape)][static_cast<std::size_t>(vertices)];
    if (!known) type = default_type(shape, vertices);
    known = true;
    return type;
  }

 private:
  static constexpr int kRemembered = 32;
  std::array<std::array<std::pair<bool, const CellType*>, kRemembered>, kShapes> types_{};
};

/// Returns whether linear wedges are numbered as in VTK 9.7. Cells of a wrong size do not count.
bool wedges_face_inward(const std::vector<Point>& points, const FileCells& cells) {
  if (std::find(cells.types.begin(), cells.types.end(), kLinearWedge) == cells.types.end()) return false;
  WedgeVote vote(points);
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    if (cells.types[c] < kTetrahedron || cells.types[c] > kPyramid || cells.types[c] == kVoxel) continue;
    const auto corners = static_cast<std::size_t>(cells.offsets[c + 1] - cells.offsets[c]);
    vote.add(type_of(cells.types[c])->shape, {cells.vertices.data() + cells.offsets[c], corners});
  }
  return vote.wedges_face_inward();
}

InputError unknown_type(int number, Index cell, const ErrorAt& error) {
  std::string what = "cell " + std::to_string(cell) + " (counted from 0) ";
  if (number == 0) {
    what += "is empty (VTK_EMPTY_CELL)";
  } else {
    what += "has the type " + std::to_string(number);
  }
  return error(what, "VTK's types 1 to 16, 21 to 37, 42, 60 to 62 and 64 to 81 are supported");
}

}  // namespace

bool take_cells(Mesh& mesh, FileCells& cells, const ErrorAt& error, Notes& notes) {
  std::array<const CellType*, 256> known{};
  for (const CellType& type : kTypes) known[static_cast<std::size_t>(type.number)] = &type;

  const bool inward_wedges = wedges_face_inward(mesh.points, cells);
  DefaultTypes defaults;
  Index converted = 0;
  bool plain = true;  // whether shapes and numbers of vertices determine all types
  const Index count = index_size(cells.types);
  mesh.cells.shapes.resize(count);
  const CellType* usual_type = nullptr;  // type of cell c − 1, if it swaps nothing: most cells are alike
  Offset usual_vertices = 0;
  for (Index c = 0; c < count; ++c) {
    const CellType* type = known[cells.types[c]];
    if (type == nullptr) throw unknown_type(cells.types[c], c, error);
    const Offset vertices = cells.offsets[c + 1] - cells.offsets[c];
    mesh.cells.shapes[c] = type->shape;
    if (type == usual_type && vertices == usual_vertices) continue;
    if (!fits(*type, vertices) || vertices > kMaxIndex) {
      throw error(
          "cell " + std::to_string(c) + " (counted from 0) is a " + std::string(type->name) + " of " +
              std::to_string(vertices) + " vertices",
          (type->vertices > 0 ? "it has " : "it has at least ") + std::to_string(std::abs(type->vertices)));
    }
    usual_type = kSwappedTypes[cells.types[c]] == nullptr ? type : nullptr;
    usual_vertices = vertices;
    if (!inward_wedges || type->number != kLinearWedge) {
      swap_vertices(*type, cells.vertices.data() + cells.offsets[c]);
    }
    if (type->number == kPixel || type->number == kVoxel) {
      ++converted;
    } else {
      plain = plain && defaults(type->shape, static_cast<int>(vertices))->number == type->number;
    }
  }
  mesh.cells.offsets = std::move(cells.offsets);
  mesh.cells.vertices = std::move(cells.vertices);
  const Index unfit = first_unfit_polyhedron(mesh.cells, cells.types, cells.polyhedra, mesh.vertex_count());
  if (unfit >= 0) {
    const std::string what = "cell " + std::to_string(unfit) + " (counted from 0) is a polyhedron ";
    if (cells.polyhedra.empty())
      throw error(what + "without faces", "polyhedra are read from .vtu and legacy .vtk files");
    throw error(what + "whose faces are not on its points",
                "the points of a polyhedron are the corners of its faces");
  }
  if (converted > 0) {
    notes.push_back(std::to_string(converted) +
                    " cells of type VTK_PIXEL or VTK_VOXEL became quads and hexahedra");
  }
  if (plain) return inward_wedges;
  for (Index c = 0; c < count; ++c) {
    if (cells.types[c] == kPixel) cells.types[c] = 9;
    if (cells.types[c] == kVoxel) cells.types[c] = 12;
  }
  std::erase_if(mesh.data, [](const DataArray& a) {
    return a.association == Association::cells && a.name == kCellTypes;
  });
  mesh.data.push_back({std::string(kCellTypes), Association::cells, 1, std::move(cells.types), {}, {}});
  return inward_wedges;
}

Index first_unfit_polyhedron(const Cells& cells, const std::vector<std::uint8_t>& types,
                             const Polyhedra& polyhedra, Index vertex_count) {
  const auto first = std::find(types.begin(), types.end(), kPolyhedron);
  if (first == types.end()) return -1;
  if (Offset{cells.size()} + 1 != std::ssize(polyhedra.starts))
    return static_cast<Index>(first - types.begin());
  std::vector<Index> cell_of_vertex(static_cast<std::size_t>(vertex_count), -1);
  for (Index c = 0; c < cells.size(); ++c) {
    if (types[c] != kPolyhedron) continue;
    if (!are_faces(polyhedra[c])) return c;
    for (const Index vertex : cells[c]) cell_of_vertex[vertex] = c;
    bool fit = true;
    for_faces(polyhedra[c], [&](std::span<const Index> corners) {
      for (const Index corner : corners) {
        fit = fit && corner >= 0 && corner < vertex_count && cell_of_vertex[corner] == c;
      }
    });
    if (!fit) return c;
  }
  return -1;
}

bool has_polyhedra(const Mesh& mesh) {
  const auto* const own = dynamic_cast<const VtkMetadata*>(mesh.format_metadata.get());
  return own != nullptr && !own->polyhedra.empty();
}

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  const CellType* const type = default_type(shape, vertices);
  if (type == nullptr) return false;
  if (type->number == kPolyhedron) return has_polyhedra(mesh) || kept_types(mesh) != nullptr;
  const bool lagrange = type->number >= kFirstLagrange && type->number <= kLastLagrange;
  if (!lagrange || is_from_vtk(mesh)) return true;
  return kept_types(mesh) != nullptr;  // kept types mean that the nodes are in VTK's order
}

std::vector<std::uint8_t> cell_types(const Mesh& mesh) {
  if (const std::vector<std::uint8_t>* const numbers = kept_types(mesh); numbers != nullptr) return *numbers;
  DefaultTypes defaults;
  std::vector<std::uint8_t> types(mesh.cells.shapes.size());
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    types[c] = static_cast<std::uint8_t>(defaults(mesh.cells.shapes[c], mesh.cells.vertex_count(c))->number);
  }
  return types;
}

bool is_higher_order_hexahedron(std::uint8_t type) { return type == 67 || type == 72 || type == 79; }

bool may_be_reordered(std::uint8_t type) {
  return kSwappedTypes[type] != nullptr || is_higher_order_hexahedron(type);
}

void swap_hexahedron_edges(const Mesh& mesh, const std::vector<std::uint8_t>& types, Cells& cells) {
  const DataArray* array = find_array(mesh, "HigherOrderDegrees", Association::cells);
  const bool usable = array != nullptr && array->components == 3 && array->is_dense();
  for (Index c = 0; c < cells.size(); ++c) {
    if (!is_higher_order_hexahedron(types[c])) continue;
    const int n = cells.vertex_count(c);
    const Offset same = std::lround(std::cbrt(n)) - 1;
    std::array<Offset, 3> degrees{same, same, same};
    if (usable) {
      with_numbers(array->values, [&](const auto& values) {
        for (int i = 0; i < 3; ++i) {
          const auto degree = static_cast<double>(values[3 * Offset{c} + i]);
          degrees[i] = degree >= 1 && degree <= n ? static_cast<Offset>(degree) : same;
        }
      });
    }
    // the swapped edges come after 8 corners, the edges along x and y, and two edges along z
    const Offset along_z = degrees[2] - 1;
    const Offset first = 8 + 4 * (degrees[0] - 1 + degrees[1] - 1) + 2 * along_z;
    if (along_z <= 0 || first + 2 * along_z > n) continue;
    Index* const edge = cells[c].data() + first;
    std::swap_ranges(edge, edge + along_z, edge + along_z);
  }
}

const Cells& WriteContext::cells(bool old_hexahedra) {
  const bool swapped =
      std::any_of(types.begin(), types.end(), [](std::uint8_t t) { return kSwappedTypes[t] != nullptr; });
  if (!swapped && !old_hexahedra) return mesh.cells;
  changed_ = mesh.cells;
  for (Index c = 0; swapped && c < changed_.size(); ++c) {
    const CellType* const type = kSwappedTypes[types[c]];
    if (type == nullptr || (metadata.inward_wedges && type->number == kLinearWedge)) continue;
    swap_vertices(*type, changed_[c].data());
  }
  if (old_hexahedra) swap_hexahedron_edges(mesh, types, changed_);
  return changed_;
}

const Cells& WriteContext::cells_with_faces(bool old_hexahedra) {
  const Cells& plain = cells(old_hexahedra);
  if (metadata.polyhedra.empty()) return plain;
  Cells result;
  for (Index c = 0; c < plain.size(); ++c) {
    result.push_back(plain.shapes[c], types[c] == kPolyhedron ? metadata.polyhedra[c] : plain[c]);
  }
  changed_ = std::move(result);
  return changed_;
}

}  // namespace meshorder::vtk
