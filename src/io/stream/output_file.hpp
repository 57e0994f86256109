// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace meshorder {

/// A file that appears complete or not at all: written to a temporary file beside its target, which `commit`
/// renames into place, or to memory, from where `commit` gives it to the target's store. Without a commit the
/// temporary is removed and the target stays unchanged.
class OutputFile {
 public:
  /// Throws Error if the folder does not exist or cannot be written, or the target is a folder.
  explicit OutputFile(FilePath target);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Writes formatted text; a double written as `{}` reads back to the same bits.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    print_all(format, fmt::make_format_args(args...));
  }

  void write(std::string_view bytes);

  /// Writes `before` and the digits of `value`; faster than `print`.
  void integer(std::string_view before, std::int64_t value);

  /// Writes the number's bytes in the given order.
  template <class T>
  void binary(T value, std::endian order = std::endian::native) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    write({raw.data(), raw.size()});
  }

  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_.path(); }
  /// Returns the path of the temporary file on disk, for what writes by path (call `close` before).
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Writes what is buffered and closes the file. Throws Error if the disk is full.
  void close();

  /// Closes the file and renames it into place.
  void commit() { commit_all(std::span(this, 1)); }

  /// Closes all files, then renames all: for several files that belong together.
  static void commit_all(std::span<OutputFile> files);

 private:
  struct Stream;
  void print_all(fmt::string_view format, fmt::format_args args);
  void flush();

  FilePath target_;
  std::filesystem::path temporary_;
  std::unique_ptr<Stream> stream_;
};

}  // namespace meshorder
