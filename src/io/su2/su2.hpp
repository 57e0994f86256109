// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of SU2's meshes.
//
// Format: the SU2 project's documentation, "Mesh File", https://su2code.github.io/docs_v7/Mesh-File/. Types
// and nodes of elements are VTK's. The first triangle of a wedge faces outward, as in SU2's own list of the
// faces of a prism (Common/src/geometry/primal_grid/CPrism.cpp, SU2 7.0.8) and in old versions of VTK. Gmsh
// writes its own order, in which that triangle faces inward. When SU2 reads a mesh, it reorients elements
// with a negative volume.

#include "io/format.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::su2 {

/// A type of elements.
struct ElementKind {
  int type;
  Shape shape;
  int nodes;
};

inline constexpr std::array kElementKinds{
    ElementKind{3, Shape::line, 2},        ElementKind{5, Shape::triangle, 3},
    ElementKind{9, Shape::quad, 4},        ElementKind{10, Shape::tetrahedron, 4},
    ElementKind{12, Shape::hexahedron, 8}, ElementKind{13, Shape::wedge, 6},
    ElementKind{14, Shape::pyramid, 5},
};

/// For each node of a wedge, its position in the file's line.
inline constexpr std::array<int, 6> kWedge{0, 2, 1, 3, 5, 4};

/// Data of SU2's files beyond the mesh.
struct Su2Metadata final : FormatMetadata {
  enum class SectionKind : std::uint8_t {
    dimension,
    elements,
    points,
    marker_count,
    marker,
    surface_points,  ///< surface points of a box of free-form deformation
    verbatim
  };
  /// A line of FFD_SURFACE_POINTS=, which names a point.
  struct SurfacePoint {
    std::string before;  ///< the name of the marker, with blanks
    Index vertex;
    std::string after;  ///< the point's place in the box
  };
  struct FileSection {
    SectionKind part;
    std::string text = {};      ///< the name of a marker, or the lines that are kept as they are
    std::string comments = {};  ///< the lines between MARKER_TAG= and MARKER_ELEMS=
    std::vector<SurfacePoint> surface_points = {};
  };
  std::vector<FileSection> sections;    ///< sections in the order of the file
  std::vector<std::string> keywords;    ///< keywords of the lines that are kept as they are
  bool counts_physical_points = false;  ///< NPOIN= gives a second number
  bool numbers_elements = false;  ///< lines of elements end with the element's number, from 0; the next two
                                  ///< say the same of points and of markers' elements
  bool numbers_points = false;
  bool numbers_marker_elements = false;
  bool wedges_face_inward = false;  ///< whether the first triangle of wedges faces inward, as in Gmsh's files

  [[nodiscard]] std::vector<std::string> contents() const override { return keywords; }
  [[nodiscard]] std::shared_ptr<const FormatMetadata> moved(std::span<const Index> vertices,
                                                            std::span<const Index> cells) const override;
};

/// Returns a marker's name as a label; 0 if the name is not a label: "12" and "-3" are labels, "012" is not.
std::int64_t label_of_name(std::string_view name);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

/// Returns the cells' places in a file: first those of the highest dimension, then each marker's, then those
/// that are not written. `blocks` receives the first place of each of these groups.
Permutation places(const Mesh& mesh, std::vector<Index>& blocks);

}  // namespace meshorder::su2
