// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of Medit's ASCII meshes: the sections of the format.
//
// Formats: P. Frey, "MEDIT: An interactive mesh visualization software", INRIA RT-0253 (2001), and the Gamma
// Mesh Format of L. Maréchal's libMeshb, https://github.com/LoicMarechal/libMeshb (Documentation).

#include "io/format.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::medit {

/// A section of cells, each with its vertices and a reference.
struct CellKind {
  std::string_view keyword;
  Shape shape;
  int nodes;
  std::string_view alias;  ///< another name in older files
};

inline constexpr std::array kCellKinds{
    CellKind{"Edges", Shape::line, 2, ""},
    CellKind{"Triangles", Shape::triangle, 3, ""},
    CellKind{"Quadrilaterals", Shape::quad, 4, ""},
    CellKind{"Tetrahedra", Shape::tetrahedron, 4, ""},
    CellKind{"Pyramids", Shape::pyramid, 5, ""},
    CellKind{"Prisms", Shape::wedge, 6, "Pentahedra"},
    CellKind{"Hexahedra", Shape::hexahedron, 8, "Hexaedra"},
    CellKind{"EdgesP2", Shape::line, 3, ""},
    CellKind{"TrianglesP2", Shape::triangle, 6, ""},
    CellKind{"QuadrilateralsQ2", Shape::quad, 9, ""},
    CellKind{"TetrahedraP2", Shape::tetrahedron, 10, ""},
    CellKind{"PyramidsP2", Shape::pyramid, 14, ""},
    CellKind{"PrismsP2", Shape::wedge, 18, ""},
    CellKind{"HexahedraQ2", Shape::hexahedron, 27, ""},
};
inline constexpr std::size_t kLinearKinds = 7;

/// What the positions in a section refer to: vertices, or cells of this shape.
using Target = std::optional<Shape>;  // nullopt: vertices

/// How a section refers to vertices or cells. Sections are read in the order of these forms.
enum class Form : std::uint8_t {
  list,   ///< lines of one position; read as a set of the same name
  table,  ///< lines of a position and numbers; read as an array of the same name, with values at the
          ///< positions
  rows    ///< lines of several positions
};

/// A section that refers to vertices or cells by their positions. Each column (of a table, only the first)
/// has a letter: v for a vertex; e, t, q or k for a cell in Edges, Triangles, Quadrilaterals or Tetrahedra;
/// '.' for a number that is kept, for example that of a normal.
struct ReferenceKind {
  std::string_view keyword;
  Form form;
  std::string_view columns;
};

inline constexpr std::array kReferenceKinds{
    ReferenceKind{"Corners", Form::list, "v"},
    ReferenceKind{"RequiredVertices", Form::list, "v"},
    ReferenceKind{"Ridges", Form::list, "e"},
    ReferenceKind{"RequiredEdges", Form::list, "e"},
    ReferenceKind{"RequiredTriangles", Form::list, "t"},
    ReferenceKind{"RequiredQuadrilaterals", Form::list, "q"},
    ReferenceKind{"RequiredTetrahedra", Form::list, "k"},
    ReferenceKind{"ParallelTriangles", Form::list, "t"},  // this and the next are ParMmg's
    ReferenceKind{"ParallelQuadrilaterals", Form::list, "q"},
    ReferenceKind{"NormalAtVertices", Form::table, "v"},
    ReferenceKind{"TangentAtVertices", Form::table, "v"},
    ReferenceKind{"VerticesOnGeometricVertices", Form::table, "v"},
    ReferenceKind{"VerticesOnGeometricEdges", Form::table, "v"},
    ReferenceKind{"VerticesOnGeometricTriangles", Form::table, "v"},
    ReferenceKind{"VerticesOnGeometricQuadrilaterals", Form::table, "v"},
    ReferenceKind{"EdgesOnGeometricEdges", Form::table, "e"},
    ReferenceKind{"TrianglesOnGeometricTriangles", Form::table, "t"},
    ReferenceKind{"TrianglesOnGeometricQuadrilaterals", Form::table, "t"},
    ReferenceKind{"QuadrilateralsOnGeometricTriangles", Form::table, "q"},
    ReferenceKind{"QuadrilateralsOnGeometricQuadrilaterals", Form::table, "q"},
    // the tables from here on are those of BAMG and libMesh 3
    ReferenceKind{"VertexOnGeometricVertex", Form::table, "v"},
    ReferenceKind{"VertexOnGeometricEdge", Form::table, "v"},
    ReferenceKind{"VertexOnGeometricTriangle", Form::table, "v"},
    ReferenceKind{"VertexOnGeometricQuadrilateral", Form::table, "v"},
    ReferenceKind{"EdgeOnGeometricEdge", Form::table, "e"},
    ReferenceKind{"TriangleOnGeometricTriangle", Form::table, "t"},
    ReferenceKind{"TriangleOnGeometricQuadrilateral", Form::table, "t"},
    ReferenceKind{"QuadrilateralOnGeometricTriangle", Form::table, "q"},
    ReferenceKind{"QuadrilateralOnGeometricQuadrilateral", Form::table, "q"},
    ReferenceKind{"VertexOnSupportVertex", Form::table, "v"},
    ReferenceKind{"VertexOnSupportEdge", Form::table, "v"},
    ReferenceKind{"VertexOnSupportTriangle", Form::table, "v"},
    ReferenceKind{"VertexOnSupportQuadrilateral", Form::table, "v"},
    ReferenceKind{"VertexOnSupportTetrahedron", Form::table, "v"},
    ReferenceKind{"VertexOnSupportPentahedron", Form::table, "v"},
    ReferenceKind{"VertexOnSupportHexahedron", Form::table, "v"},
    // BAMG's; columns: 3, a triangle of the domain, orientation, reference
    ReferenceKind{"SubDomainFromMesh", Form::rows, ".t.."},
    // in a geometry, with the columns of the next line
    ReferenceKind{"SubDomain", Form::rows, ".t.."},
    ReferenceKind{"SubDomainFromGeom", Form::rows, ".e.."},
    ReferenceKind{"TangentAtEdges", Form::rows, "e..."},
    ReferenceKind{"CrackedEdges", Form::rows, "ee"},
    ReferenceKind{"CrackedTriangles", Form::rows, "tt"},
    ReferenceKind{"CrackedQuadrilaterals", Form::rows, "qq"},
    ReferenceKind{"EquivalentEdges", Form::rows, "ee"},
    ReferenceKind{"EquivalentTriangles", Form::rows, "tt"},
    ReferenceKind{"EquivalentQuadrilaterals", Form::rows, "qq"},
    ReferenceKind{"PeriodicVertices", Form::rows, "vv"},
    ReferenceKind{"PeriodicEdges", Form::rows, "ee"},
    ReferenceKind{"PeriodicTriangles", Form::rows, "tt"},
    ReferenceKind{"PeriodicQuadrilaterals", Form::rows, "qq"},
    // columns: a cell, the position of a vertex in this cell, a tangent or normal
    ReferenceKind{"TangentAtEdgeVertices", Form::rows, "e.."},
    ReferenceKind{"NormalAtTriangleVertices", Form::rows, "t.."},
    ReferenceKind{"NormalAtQuadrilateralVertices", Form::rows, "q.."},
};

/// A section, without a count, of BAMG's mesh sizes at all vertices; read as an array of the same name.
struct SizeKind {
  std::string_view keyword;
  Index components;
};

inline constexpr std::array kSizeKinds{SizeKind{"hVertices", 1}, SizeKind{"MetricVertices", 3},
                                       SizeKind{"h1h2VpVertices", 4}};

/// Data of Medit files beyond the mesh.
struct MeditMetadata final : FormatMetadata {
  struct VerbatimSection {
    std::string keyword;
    std::string text;  ///< verbatim, from the keyword on
    bool before_vertices;
  };
  /// A section of rows, or a table in which two rows name the same item.
  struct Rows {
    std::string keyword;
    std::string columns;
    std::vector<Index> items;  ///< vertices and cells of the mesh, line by line; −1: left out
    std::vector<double> kept;  ///< the numbers in other columns
  };
  std::int64_t version = 2;
  std::string comments_before;
  std::string after_end;
  std::vector<VerbatimSection> sections;  ///< sections that do not depend on the mesh's order
  std::vector<Rows> rows;
  std::vector<std::size_t> empty_sections;  ///< kinds of cells whose section is empty
  /// Node orders that the file gives, by kind: at index k, the position in the file of VTK's node k.
  std::map<std::size_t, std::vector<int>> places;

  [[nodiscard]] std::vector<std::string> contents() const override;
  [[nodiscard]] std::shared_ptr<const FormatMetadata> moved(std::span<const Index> vertices,
                                                            std::span<const Index> cells) const override;
};

/// Returns the target of a column whose letter is v, e, t, q or k.
Target target_of(char column);

/// Returns the kind of a cell type, or the number of kinds if there is none.
std::size_t kind_of(Shape shape, int nodes);

/// Returns the kind that a section "…Ordering" describes, or the number of kinds if there is none.
std::size_t kind_of_ordering(std::string_view keyword);

/// Returns the reference coordinates of a second-order cell's nodes, in VTK's order. The unit is half an
/// edge. In triangles, tetrahedra and prisms, the coordinates are barycentric, as in sections "…Ordering".
std::vector<std::vector<int>> reference_nodes(Shape shape);

/// Returns the kind of cells of the shape `target` that sections count: linear cells if there are any, else
/// cells of second order, else the number of kinds. `counts`: number of cells of each kind.
std::size_t counted_kind(Shape target, std::span<const Index> counts);

/// Adds the note "FILE `what`" for each file of solutions (.sol, .solb) beside the mesh.
void note_solutions(const FilePath& path, std::string_view what, Notes& notes);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

}  // namespace meshorder::medit
