// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/detail/ranges.hpp>
#include <meshorder/export.hpp>
#include <meshorder/number_view.hpp>
#include <meshorder/shape.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ranges>
#include <span>
#include <type_traits>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// A view of an undirected graph, or of the pattern of a square matrix, in compressed sparse rows.
///
/// Row v has the neighbours `neighbours[offsets[v] − base] … neighbours[offsets[v + 1] − base − 1]`. Every
/// edge is in the rows of both its ends. Loops (a matrix's diagonal), repeats and unsorted rows are
/// allowed and cost a cleaned copy; see `Symmetry` for asymmetric patterns.
///
/// Brace initialisation works from any mix of integer types: `GraphView{row_start, column}`.
struct GraphView {
  /// n + 1 ascending numbers; the first is `base`. Empty for the graph without vertices.
  IndexView offsets = {};
  /// The neighbours: (offsets[n] − base) numbers, each from base to base + n − 1.
  IndexView neighbours = {};
  /// The weight of each neighbour: positive, finite, equal in both rows of an edge. Empty if all weights are
  /// 1.
  RealView weights = {};
  /// Number of the first vertex: 0, or 1 for arrays of Fortran and Julia.
  int base = 0;
};

/// Coordinates x, y, z; z is 0 for meshes in the plane.
using Point = std::array<double, 3>;

/// A view of the caller's coordinates, float or double, in one to three dimensions and in any regular layout.
///
/// Axis a of point p is at `data + p · point_stride + a · axis_stride` bytes: structures of arrays, arrays of
/// structures and padded rows all fit. Lifetime: see `IndexView`.
class PointsView {
 public:
  /// No coordinates.
  PointsView() = default;

  /// Points one after another, the axes of a point side by side: x y z x y z …
  ///
  /// @param data       dimension · count numbers
  /// @param count      number of points; a negative one counts as 0
  /// @param dimension  1, 2 or 3
  /// @throws InvalidArgument if the dimension is none of these, or there are points and `data` is null
  template <RealType T, CountType N>
  PointsView(const T* data MESHORDER_LIFETIMEBOUND, N count, int dimension = 3)
      : PointsView(data, count, dimension, Offset{sizeof(T)} * dimension, Offset{sizeof(T)}) {}

  /// Points in any regular layout.
  ///
  /// @param data          axis 0 of point 0
  /// @param count         number of points; a negative one counts as 0
  /// @param dimension     1, 2 or 3
  /// @param point_stride  bytes from a point to the next; may be negative
  /// @param axis_stride   bytes from an axis to the next; may be negative
  /// @throws InvalidArgument if the dimension is none of these, or there are points and `data` is null
  template <RealType T, CountType N>
  PointsView(const T* data MESHORDER_LIFETIMEBOUND, N count, int dimension, Offset point_stride,
             Offset axis_stride)
      : data_(data),
        size_(detail::checked_count(count)),
        dimension_(dimension),
        bytes_(sizeof(T)),
        point_stride_(point_stride),
        axis_stride_(axis_stride) {
    check_dimension(dimension);
    detail::check_data(data_, size_);
  }

  /// A container of std::array<float or double, 1 to 3>; the size of the array is the dimension.
  template <class R>
  requires(detail::PointRange<const R&> && !detail::Borrowed<R>)
      PointsView(const R& points MESHORDER_LIFETIMEBOUND)  // NOLINT(google-explicit-constructor)
      : PointsView(detail::first_number(points), std::ranges::size(points), width<const R&>) {}

  /// The same for a span of such arrays.
  template <class R>
  requires(detail::PointRange<const R&>&& detail::Borrowed<R>)
      PointsView(const R& points)  // NOLINT(google-explicit-constructor)
      : PointsView(detail::first_number(points), std::ranges::size(points), width<const R&>) {}

  /// A container or span of plain numbers x y z x y z …; `dimension` of them make a point.
  ///
  /// @throws InvalidArgument if the dimension is not 1, 2 or 3 or does not divide the number of numbers
  template <class R>
  requires detail::RealRange<const R&> PointsView(const R& coordinates MESHORDER_LIFETIMEBOUND, int dimension)
      : PointsView(std::ranges::data(coordinates), point_count(std::ranges::size(coordinates), dimension),
                   dimension) {}

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] int dimension() const noexcept { return dimension_; }
  [[nodiscard]] const void* data() const noexcept { return data_; }
  /// Returns the size of one coordinate: 4 for float, 8 for double.
  [[nodiscard]] int bytes() const noexcept { return bytes_; }
  [[nodiscard]] Offset point_stride() const noexcept { return point_stride_; }
  [[nodiscard]] Offset axis_stride() const noexcept { return axis_stride_; }

  /// Returns a coordinate of point `point` < size(); 0 if `axis` ≥ dimension(). O(1). Misaligned arrays are
  /// read correctly.
  [[nodiscard]] double operator()(std::size_t point, int axis) const noexcept {
    if (axis >= dimension_) return 0;
    const char* const at =
        static_cast<const char*>(data_) + static_cast<Offset>(point) * point_stride_ + axis * axis_stride_;
    return bytes_ == 4 ? double{read<float>(at)} : read<double>(at);
  }

 private:
  template <class R>
  static constexpr int width = static_cast<int>(detail::RowOf<R>::width);

  template <class T>
  static T read(const char* at) noexcept {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }

  MESHORDER_API static void check_dimension(int dimension);
  MESHORDER_API static std::size_t point_count(std::size_t numbers, int dimension);

  const void* data_ = nullptr;
  std::size_t size_ = 0;
  int dimension_ = 3;
  int bytes_ = sizeof(double);
  Offset point_stride_ = 0;
  Offset axis_stride_ = 0;
};

/// Cells of one type, one after another.
struct CellBlock {
  Shape shape = Shape::vertex;
  int vertices_per_cell = 0;  ///< a usual number for this shape: 4, 10, … for tetrahedra
  IndexView vertices = {};    ///< vertices_per_cell for each cell
};

/// A view of the cells of a mesh, in one of three layouts. The view copies the block descriptors, not the
/// arrays (lifetime: see `IndexView`).
///
/// The arrays are not checked here: each function that takes the view throws InvalidArgument for sizes that
/// do not match, vertices outside base … base + vertex_count − 1, and blocks whose `vertices_per_cell` is
/// unusual for their shape, such as 5 for tetrahedra.
class CellsView {
 public:
  /// No cells.
  CellsView() = default;

  /// Cells of one type.
  ///
  /// @param shape              shape of every cell
  /// @param vertices_per_cell  vertices of every cell, a usual number for this shape: 4 for linear, 10 for
  ///                           quadratic tetrahedra
  /// @param vertices           vertices_per_cell numbers for each cell; may be a range of std::array<integer,
  ///                           …>
  /// @param base               number of the first vertex, 0 or 1
  static CellsView uniform(Shape shape, int vertices_per_cell, IndexView vertices MESHORDER_LIFETIMEBOUND,
                           int base = 0) {
    CellsView view;
    view.blocks_.push_back({shape, vertices_per_cell, vertices});
    view.base_ = base;
    return view;
  }

  /// Blocks of cells, each block of one type, as in meshio, Gmsh and MFEM. Cells are numbered block after
  /// block. Copies the descriptors, not the arrays. O(blocks).
  static CellsView blocks(std::span<const CellBlock> blocks, int base = 0) {
    CellsView view;
    view.blocks_.assign(blocks.begin(), blocks.end());
    view.base_ = base;
    return view;
  }

  /// Cells of unknown types in compressed form: cell c has `vertices[offsets[c] − base] …`. Every vertex
  /// counts as a corner, all cells count as of one dimension, and facets are unknown.
  ///
  /// @param offsets   cells + 1 ascending numbers; the first is `base`
  /// @param vertices  offsets[cells] − base vertex numbers
  /// @param base      number of the first vertex and first offset, 0 or 1
  static CellsView mixed(IndexView offsets MESHORDER_LIFETIMEBOUND,
                         IndexView vertices MESHORDER_LIFETIMEBOUND, int base = 0) {
    CellsView view;
    view.offsets_ = offsets;
    view.vertices_ = vertices;
    view.base_ = base;
    return view;
  }

  /// The same with VTK's type number of each cell; an empty span if the types are not known.
  static CellsView mixed(IndexView offsets MESHORDER_LIFETIMEBOUND,
                         IndexView vertices MESHORDER_LIFETIMEBOUND, std::span<const std::uint8_t> vtk_types,
                         int base = 0) {
    CellsView view = mixed(offsets, vertices, base);
    view.vtk_types_ = vtk_types;
    return view;
  }

  /// The same with the shape of each cell; an empty span if the shapes are not known.
  static CellsView mixed(IndexView offsets MESHORDER_LIFETIMEBOUND,
                         IndexView vertices MESHORDER_LIFETIMEBOUND, std::span<const Shape> shapes,
                         int base = 0) {
    CellsView view = mixed(offsets, vertices, base);
    view.shapes_ = shapes;
    return view;
  }

  /// Returns the number of cells. O(blocks).
  [[nodiscard]] std::size_t size() const noexcept {
    if (!offsets_.empty()) return offsets_.size() - 1;
    std::size_t cells = 0;
    for (const CellBlock& block : blocks_) {
      if (block.vertices_per_cell > 0) {
        cells += block.vertices.size() / static_cast<std::size_t>(block.vertices_per_cell);
      }
    }
    return cells;
  }

  /// Returns true if `offsets`, `vertices`, `vtk_types` and `shapes` describe the cells, in compressed form;
  /// otherwise `block_list` does.
  [[nodiscard]] bool is_mixed() const noexcept { return !offsets_.empty(); }
  [[nodiscard]] std::span<const CellBlock> block_list() const& noexcept MESHORDER_LIFETIMEBOUND {
    return blocks_;
  }
  [[nodiscard]] std::span<const CellBlock> block_list() const&& = delete;
  [[nodiscard]] IndexView offsets() const noexcept { return offsets_; }
  [[nodiscard]] IndexView vertices() const noexcept { return vertices_; }
  [[nodiscard]] std::span<const std::uint8_t> vtk_types() const noexcept { return vtk_types_; }
  [[nodiscard]] std::span<const Shape> shapes() const noexcept { return shapes_; }
  [[nodiscard]] int base() const noexcept { return base_; }

 private:
  std::vector<CellBlock> blocks_;
  IndexView offsets_;
  IndexView vertices_;
  std::span<const std::uint8_t> vtk_types_;
  std::span<const Shape> shapes_;
  int base_ = 0;
};

/// A view of a mesh: coordinates and cells.
struct MeshView {
  PointsView points = {};  ///< one for each vertex, or none
  CellsView cells = {};
  std::size_t vertex_count = 0;  ///< 0: as many as points; else must equal the number of points, if any
};

}  // namespace v0_3
}  // namespace meshorder
