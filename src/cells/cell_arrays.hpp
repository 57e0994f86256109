// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/incidence.hpp"
#include <meshorder/options.hpp>
#include <meshorder/view.hpp>

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// The cells of a view in the library's own types, numbered from 0. Refers to the caller's arrays that have
/// these types already, and holds converted copies of the caller's other arrays.
///
/// Movable, not copyable: the spans refer to the caller's arrays or to the `own_` arrays.
struct CellArrays {
  CellArrays() = default;
  CellArrays(CellArrays&&) = default;
  CellArrays& operator=(CellArrays&&) = default;
  CellArrays(const CellArrays&) = delete;
  CellArrays& operator=(const CellArrays&) = delete;
  ~CellArrays() = default;

  Index vertex_count = 0;
  std::span<const Offset> offsets;  ///< cells + 1, ascending from 0
  std::span<const Index> vertices;  ///< 0 … vertex_count − 1
  std::span<const Shape> shapes;    ///< one for each cell, or none if shapes are not known
  std::vector<Index> block_starts;  ///< the first cell of each block, from 0; empty for one block
  std::vector<Offset> own_offsets;
  std::vector<Index> own_vertices;
  std::vector<Shape> own_shapes;
  std::vector<std::string> notes;

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] IncidenceRef incidence() const { return {vertex_count, offsets, vertices}; }
  /// Returns the dimension of a cell; 3 for every cell if shapes are not known.
  [[nodiscard]] int dimension_of(Index cell) const { return shapes.empty() ? 3 : dimension(shapes[cell]); }
};

/// Returns the shape of a VTK type (vtkCellType.h), nothing for types that are not supported. O(1).
std::optional<Shape> shape_of_vtk_type(int type);

/// Returns the number of a mesh's vertices: `vertex_count`, or the number of points.
///
/// @throws InvalidArgument if both are given and differ, or if there are cells and neither is given
std::size_t vertex_count_of(const MeshView& mesh);

/// Returns the usual numbers of vertices of a shape: complete cells up to order 10, cells whose vertices are
/// all on edges, and a few others that programs use. Empty for shapes that take any number of vertices, such
/// as lines. O(1).
std::set<int> cell_widths(Shape shape);

/// Converts a view of cells. Always checks the base, VTK types, the number of types and the sizes of blocks.
/// Unless `check` is none, also checks that offsets ascend and fit the entries, shapes are known, cells have
/// at least as many vertices as their shape has corners, cells of blocks have a number of vertices that
/// `cell_widths` lists, and vertices are in range.
///
/// @throws InvalidArgument, which describes the first fault
/// @throws TooLarge for more than 2,147,483,647 vertices or cells
/// @note O(entries), on all threads of the arena.
CellArrays cell_arrays(const CellsView& view, std::size_t vertex_count, Check check);

/// Returns the number of vertices that each cell has; 0 if there are no cells. O(cells).
///
/// @throws InvalidArgument if numbers or shapes differ between cells; the message begins with `caller`
int uniform_width(const CellArrays& cells, const char* caller);

/// A selection of cells, and their vertices.
class CellSelection {
 public:
  /// The cells of the highest dimension: the elements that are simulated. If these are all cells, refers to
  /// the arrays without a copy. O(entries).
  static CellSelection elements(const CellArrays& cells);
  /// The cells of lower dimension: boundary faces, edges, points. O(entries).
  static CellSelection lower_dimensional(const CellArrays& cells);

  [[nodiscard]] Index size() const { return incidence().size(); }
  /// Returns the number of the k-th selected cell among all cells.
  [[nodiscard]] Index cell(Index k) const { return is_all_ ? k : numbers_[k]; }
  [[nodiscard]] IncidenceRef incidence() const { return is_all_ ? all_ : IncidenceRef(own_); }

 private:
  template <class Wanted>
  CellSelection(const CellArrays& cells, Wanted wanted);

  IncidenceRef all_;
  bool is_all_ = false;
  std::vector<Index> numbers_;
  Incidence own_;
};

}  // namespace meshorder
