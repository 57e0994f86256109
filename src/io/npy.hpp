// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include <meshorder/permutation.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Writes a one-dimensional NumPy array (format 1.0, little endian) for `numpy.load`. Throws Error, and
/// leaves no file, if the target cannot be written.
void write_npy(std::span<const std::int32_t> values, const FilePath& path);
void write_npy(std::span<const std::int64_t> values, const FilePath& path);

/// Reads a one-dimensional NumPy array of 32- or 64-bit integers. Unsigned integers are read as signed: the
/// upper half of their range becomes negative. Throws Error, which names the byte, for other files.
std::vector<std::int64_t> read_npy(const FilePath& path);

/// Reads the new position of each of `count` vertices or cells; `what` names them in the plural. Throws Error
/// as `read_npy` does, and if the entries are not a permutation of `count` items.
Permutation read_permutation(const FilePath& path, Index count, const std::string& what);

class Scanner;

/// The header of a NumPy file.
struct NpyHeader {
  std::string type;  ///< as NumPy writes it: "<f4" is little-endian single precision
  bool columns_first = false;
  std::vector<std::int64_t> shape;
};

/// Returns the header of an array in C order: all bytes before the numbers, a multiple of 64.
std::string npy_header(std::string_view type, std::span<const std::int64_t> shape);

/// Reads the bytes before the first number. Throws Error, which names the byte, for other files.
NpyHeader read_npy_header(Scanner& file);

}  // namespace meshorder
