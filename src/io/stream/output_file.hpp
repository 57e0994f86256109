// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>

namespace meshorder {

/// A file that appears whole or not at all: it is written beside its target and renamed into place by
/// `commit`. Without a commit the temporary is removed and the target stays as it was.
class OutputFile {
 public:
  /// Throws Error when the folder does not exist or cannot be written, or the target is a folder.
  explicit OutputFile(std::filesystem::path target);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Formatted text; a double written as `{}` reads back to the same bits.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Args>(args)...);
    if (buffer_.size() > kFlushAt) flush();
  }

  void write(std::string_view bytes);

  /// The number's bytes in the given order.
  template <class T>
  void binary(T value, std::endian order = std::endian::native) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    write({raw.data(), raw.size()});
  }

  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }
  /// Where the bytes go until the commit; for libraries that write by path (call `close` before they do).
  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Writes what is buffered and closes the file. Throws Error when the disk is full.
  void close();

  /// Closes and renames into place.
  void commit() { commit_all(std::span(this, 1)); }

  /// Closes all, then renames all: several files that belong together.
  static void commit_all(std::span<OutputFile> files);

 private:
  static constexpr std::size_t kFlushAt = std::size_t{1} << 20;
  void flush();

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::ofstream stream_;
  fmt::memory_buffer buffer_;
};

}  // namespace meshorder
