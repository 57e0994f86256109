// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// A view of simplices of one dimension D, each of D + 1 vertices: lines, triangles or tetrahedra. Does not
/// own the array.
struct SimplicesRef {
  int dimension = 0;                ///< 0 if there are none
  std::span<const Index> vertices;  ///< simplex s has `vertices[(D + 1) s] … vertices[(D + 1) s + D]`

  [[nodiscard]] Offset size() const noexcept {
    return static_cast<Offset>(vertices.size()) / (dimension + 1);
  }
  /// Returns the vertices of a simplex.
  [[nodiscard]] std::span<const Index> operator[](Offset simplex) const {
    const Offset corners = dimension + 1;
    return vertices.subspan(corners * simplex, corners);
  }
};

/// Simplices of one dimension in the form of SimplicesRef, and the cells that they come from.
struct Simplices {
  int dimension = 0;
  std::vector<Index> vertices;
  std::vector<Index> cells;  ///< the cell that each simplex was cut from

  operator SimplicesRef() const { return {dimension, vertices}; }  // NOLINT(google-explicit-constructor)
  [[nodiscard]] Offset size() const noexcept { return SimplicesRef(*this).size(); }
};

/// Cuts the elements of the mesh, in their order, into simplices on their corners: a hexahedron into six
/// tetrahedra, a wedge into three, a pyramid into two, a polygon into a fan of triangles. Ignores mid-side
/// nodes and cells of lower dimension. A polyhedron, whose faces are not known, becomes a chain of
/// tetrahedra, each on four successive corners: the tetrahedra touch the same vertices as a true cut, but do
/// not fill the polyhedron. The simplices of a cell depend only on the order of its corners: reordering the
/// mesh reorders the simplices, but does not change any. O(cells).
Simplices cut_into_simplices(const Mesh& mesh);

/// The simplices that `cut_into_simplices` makes of a mesh. If every cell is a simplex without mid-side
/// nodes, the simplices refer to the mesh's own array.
class CellSimplices {
 public:
  /// No simplices.
  CellSimplices() = default;
  /// Cuts a mesh, which must not change while this object is used. O(cells).
  explicit CellSimplices(const Mesh& mesh);
  CellSimplices(CellSimplices&&) = default;
  CellSimplices& operator=(CellSimplices&&) = default;
  CellSimplices(const CellSimplices&) = delete;
  CellSimplices& operator=(const CellSimplices&) = delete;
  ~CellSimplices() = default;

  operator SimplicesRef() const { return ref_; }  // NOLINT(google-explicit-constructor)
  [[nodiscard]] Offset size() const noexcept { return ref_.size(); }

  /// Returns the simplices of the mesh after move_mesh with these permutations. O(simplices), on all threads.
  [[nodiscard]] CellSimplices moved(const Permutation& vertices, const Permutation& cells) const;

 private:
  SimplicesRef ref_;
  std::vector<Index> own_;
  std::vector<Offset> starts_;  ///< the first simplex of each cell; empty if each cell is one simplex
};

/// Returns the visible surface of a mesh as triangles of cell corners. For a volume mesh: the faces that
/// exactly one cell has, including the faces of cavities, counterclockwise as seen from outside, whatever the
/// orientation of the cell (unless it has no volume). For a surface mesh: its cells. Quadrilaterals and
/// polygons are cut into fans. Faces of polyhedra are not known and are left out, as are the faces of other
/// cells whose corners all belong to one polyhedron. Triangles are in the order of cells. Throws InputError
/// for a mesh without cells of two or three dimensions. O(facets · log facets at a vertex) time; with
/// polyhedra, more for each facet at their corners.
std::vector<std::array<Index, 3>> boundary_triangles(const Mesh& mesh);

/// Returns the faces that exactly one tetrahedron has, ascending, as 4 · tetrahedron + k; face k is opposite
/// to corner k. `vertex_count` exceeds every vertex. O(faces · log faces at a vertex).
std::vector<Offset> boundary_faces(const Simplices& tetrahedra, Index vertex_count);

}  // namespace meshorder
