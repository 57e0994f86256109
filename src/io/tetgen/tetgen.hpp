// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of TetGen's files.
//
// Formats: H. Si, "TetGen, a Quality Tetrahedral Mesh Generator, User's Manual", version 1.5, section 5.2,
// https://wias-berlin.de/software/tetgen/1.5/doc/manual/manual006.html; for two dimensions J. R. Shewchuk's
// Triangle, https://www.cs.cmu.edu/~quake/triangle.html.

#include "io/format.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::tetgen {

/// The files of one mesh: points, tetrahedra (or triangles), faces and edges.
enum File : std::uint8_t { kNode, kEle, kFace, kEdge };
inline constexpr std::array<std::string_view, 4> kExtensions{".node", ".ele", ".face", ".edge"};
inline constexpr std::array kFiles{kNode, kEle, kFace, kEdge};
inline constexpr std::array kCellFiles{kEle, kFace, kEdge};

/// Data of TetGen's files beyond the mesh.
struct TetGenMetadata final : FormatMetadata {
  struct FileComments {
    bool present = false;
    std::string comments_before;
    std::string comments_after;
  };
  std::array<FileComments, 4> parts;
  int base = 1;  ///< 0 if the numbers of points begin at 0, else 1
  int nodes_in_ele = 4;
  /// Whether .face lists the nodes on the edges opposite to corners 1, 2, 3 in this order (TetGen's -f).
  bool faces_name_opposite_edges = false;

  [[nodiscard]] std::vector<std::string> contents() const override { return {}; }
};

/// For each node of a cell in VTK's order, its position in TetGen's line. In the tetrahedra that TetGen's -o2
/// writes, nodes 5 to 10 are on the edges (3,4) (1,4) (1,2) (2,3) (2,4) (1,3).
inline constexpr std::array<int, 10> kTetrahedron{0, 1, 2, 3, 6, 7, 9, 5, 8, 4};
/// Triangle's order: nodes 4 to 6 are on the edges opposite to corners 1 to 3.
inline constexpr std::array<int, 6> kTriangleOpposite{0, 1, 2, 5, 3, 4};
inline constexpr std::array<int, 6> kTriangle{0, 1, 2, 3, 4, 5};

/// Returns the first `nodes` entries of the table for cells of `nodes` nodes in this file.
inline std::span<const int> places(File file, int nodes, bool faces_name_opposite_edges) {
  if (nodes == 4 || nodes == 10) return {kTetrahedron.data(), static_cast<std::size_t>(nodes)};
  const bool opposite = file == kEle || (file == kFace && faces_name_opposite_edges);
  return {(opposite ? kTriangleOpposite : kTriangle).data(), static_cast<std::size_t>(nodes)};
}

/// The last line of each written file begins with this text. A mark of 16 digits follows, the same in all
/// files of a mesh; the reader refuses files with different marks.
inline constexpr std::string_view kMarkBefore = "# meshorder ";
inline constexpr std::size_t kMarkDigits = 16;

/// Notes files beside `path` that refer to the points or cells of the mesh but are not rewritten.
void note_other_companions(const FilePath& path, std::string_view what, Notes& notes);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

}  // namespace meshorder::tetgen
