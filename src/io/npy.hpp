// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/permutation.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

class Scanner;

/// Writes a one-dimensional NumPy array (format 1.0, little endian): `numpy.load` reads it. Throws Error when
/// the target cannot be written; nothing is left behind then.
void write_npy(std::span<const std::int32_t> values, const std::filesystem::path& path);
void write_npy(std::span<const std::int64_t> values, const std::filesystem::path& path);

/// Reads a one-dimensional NumPy array of 32- or 64-bit integers, signed or not. Throws Error, with the byte,
/// for anything else.
std::vector<std::int64_t> read_npy(const std::filesystem::path& path);

/// Reads the new place of each of `count` things, which `what` names in the plural. Throws Error for another
/// number of them and for what is no permutation, too.
Permutation read_permutation(const std::filesystem::path& path, Index count, const std::string& what);

/// What a NumPy file says in front of its numbers.
struct NpyHeader {
  std::string type;  ///< as NumPy writes it: "<f4" is little-endian single precision
  bool columns_first = false;
  std::vector<std::int64_t> shape;
};

/// The bytes in front of the numbers of an array in C order, a multiple of 64.
std::string npy_header(std::string_view type, std::span<const std::int64_t> shape);

/// Reads as far as the first number. Throws Error, with the byte, for what is no NumPy file.
NpyHeader read_npy_header(Scanner& file);

}  // namespace meshorder
