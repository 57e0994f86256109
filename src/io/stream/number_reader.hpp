// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "io/stream/scanner.hpp"

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace meshorder {

/// Reads numbers that are text or binary, as the file's header says. Errors name the line in a text file and
/// the byte in a binary file. `what` names the number in an error.
struct NumberReader {
  explicit NumberReader(const FilePath& path) : scanner(path) {}

  /// Throws an Error at the current line or byte.
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;

  std::int32_t int32(std::string_view what) {
    return binary ? scanner.binary<std::int32_t>(what, order) : scanner.integer<std::int32_t>(what);
  }
  std::int64_t int64(std::string_view what) {
    return binary ? scanner.binary<std::int64_t>(what, order) : scanner.integer<std::int64_t>(what);
  }
  double real(std::string_view what) {
    return binary ? scanner.binary<double>(what, order) : scanner.real(what);
  }
  double finite(std::string_view what);

  /// Reads a count of items that take at least `text_bytes` or `binary_bytes` each (see Scanner::count).
  Index count(std::string_view what, std::int64_t text_bytes, std::int64_t binary_bytes);
  /// Checks a count that was read already. `bytes`: least number of bytes that an item takes in the file.
  [[nodiscard]] Index checked_count(std::int64_t number, std::string_view what, std::int64_t bytes) const;

  // ---- text, also in binary files
  std::string_view word(std::string_view what);
  std::int64_t text_integer(std::string_view what);
  double text_real(std::string_view what);
  /// Returns `text` as an integer; throws InputError if it is not one.
  [[nodiscard]] std::int64_t parsed(std::string_view text, std::string_view what) const;
  /// In a binary file, moves to the next line, where the binary numbers begin.
  void begin_binary();

  Scanner scanner;
  bool binary = false;
  std::endian order = std::endian::native;  ///< byte order of binary numbers
};

}  // namespace meshorder
