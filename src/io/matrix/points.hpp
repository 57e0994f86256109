// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder {

/// Coordinates from a file beside a matrix or graph, a point for each row.
struct RowPoints {
  std::vector<Point> points;  ///< the third coordinate is 0 if the file has two
  int dimension = 3;          ///< numbers in each row of the file, 2 or 3
};

/// Reads the points of `rows` rows: a NumPy array of numbers, rows × 2 or rows × 3; a dense `array` of Matrix
/// Market; or text with two or three numbers in a line, separated by blanks or commas, and comments from `#`
/// or `%` on. Throws InputError, with the line or byte, for other files, another number of rows, numbers that
/// are not finite, and points that are all the same.
RowPoints read_points(const FilePath& path, Index rows);

}  // namespace meshorder
