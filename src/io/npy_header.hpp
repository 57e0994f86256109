// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

class Scanner;

/// The header of a NumPy file.
struct NpyHeader {
  std::string type;  ///< as NumPy writes it: "<f4" is little-endian single precision
  bool columns_first = false;
  std::vector<std::int64_t> shape;
};

/// Returns the bytes before the numbers of an array in C order; their count is a multiple of 64.
std::string npy_header(std::string_view type, std::span<const std::int64_t> shape);

/// Reads the bytes before the first number. Throws Error, with the byte, if the file is not a NumPy file.
NpyHeader read_npy_header(Scanner& file);

}  // namespace meshorder
