// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>
#include <meshorder/number_view.hpp>
#include <meshorder/options.hpp>
#include <meshorder/order.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/shape.hpp>
#include <meshorder/view.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// Cells of any mixture of types, in file order: cell c has shape `shapes[c]` and the vertices
/// `vertices[offsets[c]] … vertices[offsets[c + 1] − 1]`.
///
/// Corners come first, in VTK's order, except in linear wedges. The first triangle of every wedge faces
/// inward, as in Gmsh. In second-order cells, the nodes of edges, faces and interior follow, in VTK's order
/// for the types that VTK has. Cells of higher order keep the node order of their file.
struct MESHORDER_API Cells {
  std::vector<Shape> shapes;
  std::vector<Offset> offsets{0};  ///< cells + 1, ascending
  std::vector<Index> vertices;     ///< offsets[cells]

  /// Returns the number of cells. O(1).
  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(shapes.size()); }
  /// Returns the number of vertices of a cell < size(). O(1).
  [[nodiscard]] int vertex_count(Index cell) const {
    return static_cast<int>(row_end(cell) - row_begin(cell));
  }
  /// Returns the vertices of a cell < size(). Valid until `vertices` changes its size. O(1).
  [[nodiscard]] std::span<const Index> operator[](Index cell) const {
    return {vertices.data() + row_begin(cell), vertices.data() + row_end(cell)};
  }
  [[nodiscard]] std::span<Index> operator[](Index cell) {
    return {vertices.data() + row_begin(cell), vertices.data() + row_end(cell)};
  }
  /// Appends a cell. The vertices are not checked; the span must not refer to this object. Amortised
  /// O(vertices).
  void push_back(Shape shape, std::span<const Index> cell_vertices);
  /// Reserves memory for this total number of cells and vertex entries.
  void reserve(Offset cells, Offset vertex_entries);
  /// Returns the highest dimension of any cell, −1 without cells. O(cells).
  [[nodiscard]] int highest_dimension() const;

  bool operator==(const Cells&) const = default;

 private:
  [[nodiscard]] Offset row_begin(Index cell) const { return offsets[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] Offset row_end(Index cell) const { return offsets[static_cast<std::size_t>(cell) + 1]; }
};

/// What an array or a set belongs to.
enum class Association : std::uint8_t { vertices, cells };

/// Returns "vertices" or "cells". Valid for the life of the program.
MESHORDER_API std::string_view to_string(Association association);

/// The values of an array, in the type that they have in the file.
using Values = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int8_t>,
                            std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>,
                            std::vector<std::int32_t>, std::vector<std::uint32_t>, std::vector<std::int64_t>,
                            std::vector<std::uint64_t>, std::vector<std::string>>;

/// Name of the array of integer labels, one for each vertex or cell. Formats convert this array to and from
/// their own labels: Medit's references, TetGen's boundary markers, the first physical group of Gmsh.
inline constexpr std::string_view kLabel = "label";

/// Values of vertices or cells: rows of `components` values, one row after another.
struct DataArray {
  std::string name = {};
  Association association = Association::vertices;
  Index components = 1;  ///< ≥ 1
  Values values = {};    ///< components · rows
  /// If the array covers only some vertices or cells: the vertex or cell of each row, in any order, each at
  /// most once. Empty if row i belongs to vertex or cell i.
  std::vector<Index> indices = {};
  std::vector<std::string> component_names = {};  ///< names in the file; empty if the file has none

  /// Returns true if there is a row for every vertex or cell.
  [[nodiscard]] bool is_dense() const noexcept { return indices.empty(); }
  bool operator==(const DataArray&) const = default;
};

/// A named list of vertices or cells, in the order of the file.
struct EntitySet {
  std::string name = {};
  Association association = Association::cells;
  std::vector<Index> members = {};  ///< each at most once

  bool operator==(const EntitySet&) const = default;
};

/// Data that only one format has: materials, encodings, whole sections of text. The format's reader keeps the
/// data for the format's writer. The data must not depend on the order of vertices or cells, unless `moved`
/// updates it. Only the formats of this library derive from this class.
class MESHORDER_API FormatMetadata {
 public:
  FormatMetadata() = default;
  FormatMetadata(const FormatMetadata&) = default;
  FormatMetadata(FormatMetadata&&) = default;
  FormatMetadata& operator=(const FormatMetadata&) = default;
  FormatMetadata& operator=(FormatMetadata&&) = default;
  virtual ~FormatMetadata() = default;
  /// Returns the parts that other formats lose, in a user's words: {"2 materials", "Gmsh's $Periodic"}.
  [[nodiscard]] virtual std::vector<std::string> contents() const = 0;
  /// Returns the data for a mesh whose vertices and cells have moved; null if the data does not change.
  ///
  /// @param vertices  the new position of each vertex; empty if none moves
  /// @param cells     the new position of each cell, −1 for a cell that was left out; empty if none moves
  [[nodiscard]] virtual std::shared_ptr<const FormatMetadata> moved(std::span<const Index> vertices,
                                                                    std::span<const Index> cells) const {
    (void)vertices;
    (void)cells;
    return nullptr;
  }
  /// Returns true if the data may refer to ids in ways that this library does not understand. All ids must
  /// then stay: `Ids::renumber` acts as `Ids::keep`.
  [[nodiscard]] virtual bool binds_ids() const { return false; }
};

/// A simulation mesh with the arrays, sets and ids of its file. Plain data: code that changes one member has
/// to keep the others consistent, which `check_mesh` tests.
struct Mesh {
  std::vector<Point> points = {};  ///< one for each vertex; the third coordinate is 0 if the file has two
  int dimension = 3;               ///< number of coordinates of a point in the file: 2 or 3
  Cells cells = {};
  std::vector<DataArray> data = {};
  std::vector<EntitySet> sets = {};
  /// Ids of vertices and cells in the file; empty if the ids are the positions, counted from 0 or 1. Ids of
  /// cells are unique at least among cells of one type.
  std::vector<std::int64_t> vertex_ids = {};
  std::vector<std::int64_t> cell_ids = {};
  /// The first cell of each block of cells that the format keeps together (Gmsh 4.1's entities), ascending
  /// from 0; empty for one block. Reordering keeps every cell in its block.
  std::vector<Index> cell_blocks = {};
  std::string format = {};  ///< format of the mesh's file, such as "gmsh"; empty for a mesh made in memory
  std::shared_ptr<const FormatMetadata> format_metadata = {};

  [[nodiscard]] Index vertex_count() const noexcept { return static_cast<Index>(points.size()); }
  [[nodiscard]] Index cell_count() const noexcept { return cells.size(); }
};

/// Returns the number of rows of an array: its values divided by its components. O(1).
MESHORDER_API Index row_count(const DataArray& array);

/// Returns the array of that name, or null. Valid until `mesh.data` changes. O(arrays).
MESHORDER_API const DataArray* find_array(const Mesh& mesh MESHORDER_LIFETIMEBOUND, std::string_view name,
                                          Association association);
const DataArray* find_array(const Mesh&& mesh, std::string_view name, Association association) = delete;

/// Checks that the members of a mesh are consistent: coordinates are finite; offsets ascend; every cell has a
/// known shape, at least the corners of that shape, and vertices that exist; every array has a row for each
/// vertex or cell, or for each of its indices, which exist and differ; members of sets exist and differ; all
/// vertices have ids, or none has, and likewise all cells; blocks ascend.
///
/// @throws InvalidArgument for the first fault, which the message names
/// @note O(size of the mesh).
MESHORDER_API void check_mesh(const Mesh& mesh);

/// Returns a view of the points and cells of a mesh, without its blocks; copies nothing. Valid until the
/// points or the cells change their size. O(1).
[[nodiscard]] MESHORDER_API MeshView view(const Mesh& mesh MESHORDER_LIFETIMEBOUND);
MeshView view(const Mesh&& mesh) = delete;

/// Copies a view into a mesh without arrays, sets and ids. Blocks become `cell_blocks`.
///
/// @throws InvalidArgument for faulty points or cells (see `CellsView`), an unknown VTK type, and cells
///         without types; TooLarge for more than 2,147,483,647 vertices or cells
/// @note O(size of the mesh).
[[nodiscard]] MESHORDER_API Mesh make_mesh(const MeshView& view);

/// Name of the arrays that `Ids::attach` adds.
inline constexpr std::string_view kOriginal = "original";

/// How ids of vertices and cells change. An order that moves no vertex leaves the ids of vertices as they
/// are; likewise for cells.
enum class Ids : std::uint8_t {
  /// The old ids, assigned again in ascending order; for cells, within each dimension of each block. Decks of
  /// Abaqus with unknown cards keep their ids, because these cards may refer to the ids.
  renumber,
  keep,    ///< every vertex and cell keeps its id, so that references from other files stay valid
  attach,  ///< as `renumber`; the arrays `kOriginal` hold the old ids or, without ids, positions from 0
};

/// Options of `reorder`.
struct ReorderOptions {
  MeshMethods methods = {};
  Ids ids = Ids::renumber;
  /// Name of an array of whole numbers. Vertices or cells with the same number form a group; groups ascend,
  /// and those without a number come last. An array on cells also groups the vertices: each vertex gets the
  /// smallest number among the elements that use it. Write "cells:NAME" or "vertices:NAME" if both exist;
  /// "sets" groups by the sets of cells. Empty: no groups.
  std::string group_by = {};
  /// Name of the format that the mesh will be written in; empty: `Mesh::format`. If that format keeps cells
  /// of a type together, `reorder` first groups the cells by type. Cells that the format cannot hold stay in
  /// the mesh: see `keep_cells`.
  std::string format = {};
  OrderOptions order = {};  ///< `groups` and `cell_groups` must be empty if `group_by` is not
};

/// Orders a mesh and moves its vertices and cells with all their data.
///
/// @param mesh     changed in place; unchanged after an exception other than std::bad_alloc
/// @param options  see `ReorderOptions`
/// @return the new places. `cells.permutation` includes the moves of cells for the format, so that it
///         describes the file that `write_mesh` makes
/// @throws as `order_mesh`; InvalidArgument also for a mesh that `check_mesh` refuses, an unknown array or
///         format, and options that conflict with each other, the format or the mesh
/// @note Cost of `order_mesh`, then O(size of the mesh) time and memory for a copy of the mesh's largest part
///       at a time.
MESHORDER_API MeshOrder reorder(Mesh& mesh, const ReorderOptions& options = {});

/// Moves the vertices and cells of a mesh, with all their data, to given places: cells name the renumbered
/// vertices; arrays and sets follow their vertices and cells.
///
/// @param mesh      changed in place; unchanged after an exception other than std::bad_alloc
/// @param vertices  vertex_count() places
/// @param cells     cell_count() places; each cell must stay in its block and take the place of a cell of the
///                  same dimension
/// @param ids       how ids change
/// @throws InvalidArgument for a mesh that `check_mesh` refuses, if a size does not match, if `cells` moves a
///         cell to another block or dimension, and for `Ids::attach` if the mesh already has an array
///         "original"
/// @note O(size of the mesh) time; memory for a copy of the mesh's largest part at a time.
MESHORDER_API void apply_reordering(Mesh& mesh, const Permutation& vertices, const Permutation& cells,
                                    Ids ids = Ids::renumber);

}  // namespace v0_3
}  // namespace meshorder
