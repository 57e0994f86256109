// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the formats of matrices and graphs. A square matrix is stored as a mesh: its rows
// are vertices, all at the origin; its entries are cells in the order of the file: vertex cells on the
// diagonal, else lines from row to column. Values are the array "value" on cells. A graph's edge is a line.

#include "io/format.hpp"

#include <string_view>
#include <vector>

namespace meshorder {

/// Coordinates from a file beside a matrix or graph, a point for each row.
struct RowPoints {
  std::vector<Point> points;  ///< the third coordinate is 0 where the file has two
  int dimension = 3;          ///< numbers in each row of the file, 2 or 3
};

/// Reads `rows` points. The file may be
/// - a NumPy array of numbers, rows × 2 or rows × 3;
/// - a dense `array` of Matrix Market;
/// - text with two or three numbers in a line, separated by blanks or commas; comments begin at `#` or `%`.
/// Throws InputError, with the line or byte, for other files, another number of rows, numbers that are not
/// finite, and points that are all the same.
RowPoints read_points(const FilePath& path, Index rows);

}  // namespace meshorder

namespace meshorder::matrix {

inline constexpr std::string_view kValue = "value";    ///< array on cells: the entries of a matrix
inline constexpr std::string_view kWeight = "weight";  ///< array on cells or vertices: weights of a graph
inline constexpr std::string_view kSize = "size";      ///< array on vertices: sizes in METIS's graphs

/// Returns whether a cell is an entry: a line or a vertex.
bool is_entry(const Mesh& mesh, Shape shape, int vertices);

/// Claims memory for the vertices, because a file may have a byte or less for each vertex. Throws InputError
/// if the memory exceeds the limit.
void claim_vertices(Index count);

/// Returns the array of that name if it holds numbers for every vertex or cell; null otherwise.
const DataArray* dense_array(const Mesh& mesh, std::string_view name, Association association);

/// Returns whether an array has a type of integers and all values fit std::int64_t.
bool is_whole(const DataArray& array);

/// Returns the value at position `at` of an array of numbers.
double real_value(const DataArray& array, Offset at);
std::int64_t whole_value(const DataArray& array, Offset at);

/// Notes the parts of a mesh that a file of a matrix or graph cannot hold: coordinates, sets, ids, and
/// arrays that are not in `written`.
void note_all_unsupported(const Mesh& mesh, std::string_view format,
                          std::span<const DataArray* const> written, Notes& notes);

}  // namespace meshorder::matrix
