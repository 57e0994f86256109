// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of AVS's unstructured cell data, as text.
//
// Format: AVS Developer's Guide (1992), appendix E, "UCD format"; as LaGriT documents it,
// https://lanl.github.io/LaGriT/pages/docs/read_avs.html. The order of a cell's nodes is that of meshio and
// deal.II: the first face of a hexahedron or prism faces outward, the first node of a pyramid is its apex.

#include "io/format.hpp"

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::ucd {

/// A type of cells.
struct CellKind {
  std::string_view name;
  Shape shape;
  int nodes;
  std::array<int, 8> places;  ///< for each vertex of the cell, its position in the line
};

inline constexpr std::array kCellKinds{
    CellKind{"pt", Shape::vertex, 1, {0}},
    CellKind{"line", Shape::line, 2, {0, 1}},
    CellKind{"tri", Shape::triangle, 3, {0, 1, 2}},
    CellKind{"quad", Shape::quad, 4, {0, 1, 2, 3}},
    CellKind{"tet", Shape::tetrahedron, 4, {0, 1, 3, 2}},
    CellKind{"pyr", Shape::pyramid, 5, {1, 2, 3, 4, 0}},
    CellKind{"prism", Shape::wedge, 6, {3, 4, 5, 0, 1, 2}},
    CellKind{"hex", Shape::hexahedron, 8, {4, 5, 6, 7, 0, 1, 2, 3}},
};

/// Data of the files beyond the mesh.
struct UcdMetadata final : FormatMetadata {
  std::string comments_before;
  /// The lines "label, unit" of the file, by the names of their arrays.
  std::map<std::pair<Association, std::string>, std::string> labels;
  std::int64_t model_values = 0;
  std::string model_data;  ///< all lines after the data of nodes and cells, verbatim

  [[nodiscard]] std::vector<std::string> contents() const override;
};

/// Returns whether a file that begins with these bytes is UCD, as text or binary.
bool begins_ucd(std::string_view bytes);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

}  // namespace meshorder::ucd
