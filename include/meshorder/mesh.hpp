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

/// Cells of any types, mixed, in file order: cell c has shape `shapes[c]` and the vertices
/// `vertices[offsets[c]] … vertices[offsets[c + 1] − 1]`.
///
/// Corners come first, in VTK's order except for linear wedges: the first triangle of every wedge faces
/// inward, as in Gmsh. In second-order cells follow the nodes of edges, faces and interior, in VTK's order
/// for the types that VTK has. Higher orders keep the order of the file they came from.
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
  /// Appends a cell. The vertices are not checked, and must not be part of this object. Amortised
  /// O(vertices).
  void push_back(Shape shape, std::span<const Index> cell_vertices);
  /// Reserves memory for so many cells and vertex entries in all.
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

/// The values of an array in the number type that the file gave them.
using Values = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int8_t>,
                            std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>,
                            std::vector<std::int32_t>, std::vector<std::uint32_t>, std::vector<std::int64_t>,
                            std::vector<std::uint64_t>, std::vector<std::string>>;

/// Name of the array of integer labels, one for each vertex or cell. Formats translate their own label to and
/// from it: a Medit reference, a TetGen boundary marker, the first physical group of Gmsh.
inline constexpr std::string_view kLabel = "label";

/// Values that belong to vertices or cells, `components` for each, row after row.
struct DataArray {
  std::string name = {};
  Association association = Association::vertices;
  Index components = 1;  ///< ≥ 1
  Values values = {};    ///< components · rows
  /// The vertices or cells of the rows, for arrays that cover only some (any order, each at most once); empty
  /// where row i belongs to vertex or cell i.
  std::vector<Index> indices = {};
  std::vector<std::string> component_names = {};  ///< where the file gave them; else empty

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

/// Data that only one format has, kept by its reader for its writer: materials, encodings, whole sections of
/// text. Must not depend on the order of vertices or cells, unless `moved` follows it. Only the formats of
/// this library derive from it.
class MESHORDER_API FormatMetadata {
 public:
  FormatMetadata() = default;
  FormatMetadata(const FormatMetadata&) = default;
  FormatMetadata(FormatMetadata&&) = default;
  FormatMetadata& operator=(const FormatMetadata&) = default;
  FormatMetadata& operator=(FormatMetadata&&) = default;
  virtual ~FormatMetadata() = default;
  /// Lists, in a user's words, the parts that another format loses: {"2 materials", "Gmsh's $Periodic"}.
  [[nodiscard]] virtual std::vector<std::string> contents() const = 0;
  /// Returns the same data for a mesh whose vertices and cells moved, null if they do not matter to it.
  ///
  /// @param vertices  the new position of each vertex; empty where all stay
  /// @param cells     the new position of each cell, −1 for one that was left out; empty where all stay
  [[nodiscard]] virtual std::shared_ptr<const FormatMetadata> moved(std::span<const Index> vertices,
                                                                    std::span<const Index> cells) const {
    (void)vertices;
    (void)cells;
    return nullptr;
  }
  /// Returns whether vertices and cells must keep their ids, because the data may name them in a way that is
  /// not understood; `Ids::renumber` then does as `Ids::keep`.
  [[nodiscard]] virtual bool binds_ids() const { return false; }
};

/// A simulation mesh with the arrays, sets and ids of its file. Plain data: who changes one member keeps the
/// others in step; `check_mesh` verifies it.
struct Mesh {
  std::vector<Point> points = {};  ///< one for each vertex; the third coordinate is 0 where the file has two
  int dimension = 3;               ///< coordinates that the file gives to a point: 2 or 3
  Cells cells = {};
  std::vector<DataArray> data = {};
  std::vector<EntitySet> sets = {};
  /// The number that the file gives to each vertex and cell, where it is not simply its position (from 0 or
  /// 1); else empty. Ids of cells are unique at least among cells of one type.
  std::vector<std::int64_t> vertex_ids = {};
  std::vector<std::int64_t> cell_ids = {};
  /// The first cell of each block of cells that the format keeps together (Gmsh 4.1's entities), ascending
  /// from 0; empty for one block. Reordering keeps every cell in its block.
  std::vector<Index> cell_blocks = {};
  std::string format = {};  ///< that it was read from, "gmsh"; empty for a mesh made in memory
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

/// Checks that the members of a mesh are consistent: coordinates are finite, every cell has as many vertices
/// as its shape has corners, and all exist, every array has one row for each vertex or cell (or for each of
/// its existing indices), members of sets exist, ids and blocks fit.
///
/// @throws InvalidArgument for the first fault, which the message names
/// @note O(size of the mesh).
MESHORDER_API void check_mesh(const Mesh& mesh);

/// Views the points and cells of a mesh, without its blocks of cells; nothing is copied. Valid until either
/// changes its size. O(1).
[[nodiscard]] MESHORDER_API MeshView view(const Mesh& mesh MESHORDER_LIFETIMEBOUND);
MeshView view(const Mesh&& mesh) = delete;

/// Copies a view into a mesh without data, sets and ids. Blocks become `cell_blocks`.
///
/// @throws InvalidArgument for sizes that do not match, a vertex out of range, an unknown VTK type, and cells
///         without types
/// @note O(size of the mesh).
[[nodiscard]] MESHORDER_API Mesh make_mesh(const MeshView& view);

/// Name of the arrays that `Ids::attach` adds.
inline constexpr std::string_view kOriginal = "original";

/// What becomes of the ids of vertices and cells. An order that moves no vertex leaves the ids of vertices as
/// they are; likewise for cells.
enum class Ids : std::uint8_t {
  /// The same numbers, ascending along the new order (cells: within each dimension of each block). A deck of
  /// Abaqus with cards that may name others by number, and are not understood, keeps its ids.
  renumber,
  keep,    ///< every vertex and cell keeps its id, so that other files that name it stay valid
  attach,  ///< as `renumber`; the arrays `kOriginal` hold the old ids, or old positions from 0
};

/// Options of `reorder`.
struct ReorderOptions {
  MeshMethods methods = {};
  Ids ids = Ids::renumber;
  /// Name of an array of whole numbers whose groups stay together, ascending; what has no value comes last.
  /// An array on cells groups cells and, by the smallest value among its elements, each vertex; "cells:NAME"
  /// and "vertices:NAME" tell arrays of one name apart; "sets" groups by the sets of cells. Empty: no groups.
  std::string group_by = {};
  /// Name of the format that the mesh will be written in: one that keeps cells of a type together gets them
  /// so before they are ordered. Cells that it has no place for stay: see `keep_cells`. Empty:
  /// `Mesh::format`.
  std::string format = {};
  OrderOptions order = {};  ///< `groups` and `cell_groups` must be empty where `group_by` is not
};

/// Orders a mesh and moves its vertices and cells, together with all that belongs to them.
///
/// @param mesh     changed in place; unchanged after an exception other than std::bad_alloc
/// @param options  see `ReorderOptions`
/// @return the new places. `cells.permutation` holds all moves of cells, those for the format among them, so
///         that it describes the file that `write_mesh` makes
/// @throws as `order_mesh`, and InvalidArgument for a mesh that `check_mesh` refuses and for an unknown array
///         or format
/// @note Cost of `order_mesh`, then O(size of the mesh) and a copy of its largest part at a time; where cells
///       move for the format, a copy of the mesh.
MESHORDER_API MeshOrder reorder(Mesh& mesh, const ReorderOptions& options = {});

/// Moves the vertices and cells of a mesh to given places, together with all that belongs to them: cells name
/// the renumbered vertices, arrays and sets follow their vertices and cells.
///
/// @param mesh      changed in place; unchanged after an exception other than std::bad_alloc
/// @param vertices  vertex_count() places
/// @param cells     cell_count() places; keeps each cell in its block and at the place of a cell of its
///                  dimension
/// @param ids       what becomes of ids
/// @throws InvalidArgument for a mesh that `check_mesh` refuses, if a size does not match, if `cells` breaks
///         that rule, and for `Ids::attach` if the mesh has an array "original" already
/// @note O(size of the mesh); a copy of its largest part at a time.
MESHORDER_API void apply_reordering(Mesh& mesh, const Permutation& vertices, const Permutation& cells,
                                    Ids ids = Ids::renumber);

}  // namespace v0_3
}  // namespace meshorder
