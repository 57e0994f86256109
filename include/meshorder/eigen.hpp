// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Meshes and matrices of Eigen in libigl's layout: V with a row for each vertex, F with a row for each cell,
/// in either storage order. Header only; the program that includes this header provides Eigen 3.4.

#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/view.hpp>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <concepts>
#include <cstddef>
#include <string>

namespace meshorder {
inline namespace v0_3 {

/// Returns a view of the rows of a matrix as points.
///
/// @param points  n × 1, 2 or 3 of float or double: a matrix, map or block, not an unevaluated expression.
///                Must live as long as the view is used
/// @throws InvalidArgument for another number of columns: transpose a matrix that has a column per point
template <class Derived>
[[nodiscard]] PointsView points_view(const Eigen::DenseBase<Derived>& points MESHORDER_LIFETIMEBOUND) {
  static_assert((Derived::Flags & Eigen::DirectAccessBit) != 0, "evaluate the expression first: .eval()");
  if (points.cols() == 0) throw InvalidArgument("points: V is empty");
  if (points.cols() > 3) {
    throw InvalidArgument("points: " + std::to_string(points.rows()) + " × " + std::to_string(points.cols()) +
                          " numbers; a row for each point and 1 to 3 columns are wanted");
  }
  constexpr auto kBytes = static_cast<Offset>(sizeof(typename Derived::Scalar));
  const Derived& matrix = points.derived();
  return {matrix.data(), matrix.rows(), static_cast<int>(matrix.cols()), matrix.rowStride() * kBytes,
          matrix.colStride() * kBytes};
}

/// Returns a view of the pattern of a matrix.
///
/// @param matrix  n × n, compressed, of either storage order; must live as long as the view is used
/// @throws InvalidArgument for a matrix that is not square, or not compressed: call its makeCompressed()
template <class Scalar, int Options, class StorageIndex>
[[nodiscard]] GraphView graph_view(
    const Eigen::SparseMatrix<Scalar, Options, StorageIndex>& matrix MESHORDER_LIFETIMEBOUND) {
  if (matrix.rows() != matrix.cols()) {
    throw InvalidArgument("matrix: " + std::to_string(matrix.rows()) + " × " + std::to_string(matrix.cols()) +
                          ", must be square");
  }
  if (!matrix.isCompressed()) throw InvalidArgument("matrix: not compressed; call makeCompressed()");
  return {.offsets = {matrix.outerIndexPtr(), matrix.outerSize() + 1},
          .neighbours = {matrix.innerIndexPtr(), matrix.nonZeros()}};
}

/// Returns the permutation as an Eigen matrix P: P * x moves the rows of x, A.twistedBy(P) moves rows and
/// columns of a matrix. O(n).
[[nodiscard]] inline Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> permutation_matrix(
    const Permutation& permutation) {
  const auto map = permutation.old_to_new();
  return Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index>(
      Eigen::Map<const Eigen::Matrix<Index, Eigen::Dynamic, 1>>(map.data(), permutation.size()));
}

namespace detail {

/// Returns a copy of vertex numbers, row by row.
template <class F>
auto row_by_row(const Eigen::DenseBase<F>& cells) {
  using Number = typename F::Scalar;
  static_assert(std::constructible_from<IndexView, const Number*, Eigen::Index>,
                "F holds numbers of vertices, integers of 32 or 64 bits; V comes before F");
  return Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>(cells);
}

/// Returns the shape that the number of columns implies; see `order_mesh`.
template <class V, class F>
Shape shape_by_columns(const Eigen::DenseBase<V>& points, const Eigen::DenseBase<F>& cells) {
  switch (cells.cols()) {
    case 2:
      return Shape::line;
    case 3:
      return Shape::triangle;
    case 4:
      return points.cols() == 3 ? Shape::tetrahedron : Shape::quad;
    default:
      if (cells.size() == 0) throw InvalidArgument("cells: F is empty");
      throw InvalidArgument(
          "cells: " + std::to_string(cells.rows()) + " × " + std::to_string(cells.cols()) +
          " numbers; F has a row for each cell. Name the shape of cells with 1 or more than 4 vertices");
  }
}

}  // namespace detail

/// Orders the vertices and cells of a mesh. Nothing is changed.
///
/// @param points   V: n × 1, 2 or 3, a row for each vertex
/// @param cells    F: m × k integers from 0, a row for each cell
/// @param shape    of every cell; a `Shape`
/// @param methods  names of the two methods
/// @param options  as for `order_mesh` of a `MeshView`
/// @throws as `order_mesh` and `points_view`
/// @note Cost of `order_mesh`, and a copy of the cells.
template <class V, class F, std::same_as<Shape> S>
[[nodiscard]] MeshOrder order_mesh(const Eigen::DenseBase<V>& points, const Eigen::DenseBase<F>& cells,
                                   S shape, const MeshMethods& methods = {},
                                   const OrderOptions& options = {}) {
  const auto rows = detail::row_by_row(cells);
  return order_mesh({points_view(points),
                     CellsView::uniform(shape, static_cast<int>(rows.cols()), {rows.data(), rows.size()}),
                     static_cast<std::size_t>(points.rows())},
                    methods, options);
}

/// The same; the number of F's columns implies the shape: 2 columns are lines, 3 triangles, 4 tetrahedra, or
/// quads if V has fewer than three columns. For quads in space, name the shape.
///
/// @throws InvalidArgument also for other numbers of columns: name the shape, or transpose an F that has a
///         column per cell
template <class V, class F>
[[nodiscard]] MeshOrder order_mesh(const Eigen::DenseBase<V>& points, const Eigen::DenseBase<F>& cells,
                                   const MeshMethods& methods = {}, const OrderOptions& options = {}) {
  return order_mesh(points, cells, detail::shape_by_columns(points, cells), methods, options);
}

/// Orders edges by the larger of their ends' new numbers, as `order_edges` does for a list of ends.
///
/// @param edges     E: m × 2 old numbers in 0 … n − 1, a row for each edge
/// @param vertices  order of the n vertices
/// @param run       threads, progress
/// @return permutation of the m edges: move the edges by this permutation (`move_rows`), then `renumber`
///         their ends by `vertices`
/// @throws InvalidArgument for another number of columns, and as `order_edges`
template <class E>
[[nodiscard]] Permutation order_edges(const Eigen::DenseBase<E>& edges, const Permutation& vertices,
                                      const Run& run = {}) {
  if (edges.cols() != 2) {
    throw InvalidArgument("edges: " + std::to_string(edges.rows()) + " × " + std::to_string(edges.cols()) +
                          " numbers; E has a row for each edge, with its two ends");
  }
  const auto rows = detail::row_by_row(edges);
  return order_edges(IndexView(rows.data(), rows.size()), vertices, run);
}

/// Moves the rows of a matrix or vector, such as values of vertices or cells, to their new places.
///
/// @param permutation  of n places
/// @param values       n × k, in either storage order; of a trivially copyable type
/// @throws InvalidArgument if the matrix does not have n rows; nothing is changed then
/// @note O(n · k), with a copy of the matrix.
template <class Derived>
void move_rows(const Permutation& permutation, Eigen::PlainObjectBase<Derived>& values) {
  if (values.rows() != permutation.size()) {
    throw InvalidArgument("move_rows: " + std::to_string(values.rows()) + " rows, must be " +
                          std::to_string(permutation.size()));
  }
  constexpr auto kBytes = static_cast<Offset>(sizeof(typename Derived::Scalar));
  const typename Derived::PlainObject old = values;
  const bool by_rows = values.colStride() == 1;
  const Eigen::Index strips = by_rows ? 1 : values.cols();
  for (Eigen::Index c = 0; c < strips; ++c) {
    permutation.move_rows(
        old.data() + c * old.colStride(), old.rowStride() * kBytes, values.data() + c * values.colStride(),
        values.rowStride() * kBytes,
        sizeof(typename Derived::Scalar) * (by_rows ? static_cast<std::size_t>(values.cols()) : 1));
  }
}

/// Replaces the vertex numbers in cells by the new ones, after the vertices have moved. Throws as
/// `Permutation::renumber`. O(m · k).
template <class Derived>
void renumber(const Permutation& vertices, Eigen::PlainObjectBase<Derived>& cells) {
  vertices.renumber({cells.data(), cells.size()});
}

/// Orders a mesh and moves V and F. Returns the order, by which `move_rows` moves all other values of
/// vertices and cells. Parameters, exceptions and cost are those of `order_mesh`.
template <class V, class F, std::same_as<Shape> S>
MeshOrder reorder(Eigen::PlainObjectBase<V>& points, Eigen::PlainObjectBase<F>& cells, S shape,
                  const MeshMethods& methods = {}, const OrderOptions& options = {}) {
  MeshOrder order = order_mesh(points, cells, shape, methods, options);
  move_rows(order.vertices.permutation, points);
  renumber(order.vertices.permutation, cells);
  move_rows(order.cells.permutation, cells);
  return order;
}

/// The same; the number of F's columns implies the shape, as for `order_mesh`.
template <class V, class F>
MeshOrder reorder(Eigen::PlainObjectBase<V>& points, Eigen::PlainObjectBase<F>& cells,
                  const MeshMethods& methods = {}, const OrderOptions& options = {}) {
  return reorder(points, cells, detail::shape_by_columns(points, cells), methods, options);
}

}  // namespace v0_3
}  // namespace meshorder
