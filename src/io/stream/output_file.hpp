// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/byte_order.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/text.hpp"

#include <fmt/core.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>

namespace meshorder {

class Scratch;

/// A file that appears complete or not at all. It is written in a scratch folder beside its target, and
/// `commit` renames it into place. A file of a store is written in memory, and `commit` gives it to the
/// store. Without a commit the target stays unchanged. The protocol is in output_set.hpp.
///
/// Symbolic links are followed as `FilePath` says. The new file gets the owner, the group, the mode and the
/// extended attributes of the old file as far as the system allows; further hard links of the old file keep
/// the old content. For a target that cannot be replaced (a device, a pipe, /dev/stdout), the bytes are kept
/// in memory and written at `commit`.
class OutputFile {
 public:
  /// Throws InputError if the target cannot be written, for example if its folder does not exist.
  explicit OutputFile(FilePath target);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // each appends as the `Text` function of the same name
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    text().print_all(format, fmt::make_format_args(args...));
    flush_if_full();
  }
  void integer(std::string_view before, std::int64_t value);
  void real(std::string_view before, double value);
  template <class Number>
  void number(std::string_view before, Number value) {
    text().number(before, value);
    flush_if_full();
  }
  [[nodiscard]] char* room(std::size_t bytes);
  void written(const char* end);

  void write(std::string_view bytes);

  /// Writes the number's bytes in the given order.
  template <class T>
  void binary(T value, std::endian order = std::endian::native) {
    written(put_number(room(sizeof(T)), value, order));
  }

  /// Overwrites the first bytes; the file must already have that many.
  void write_over_start(std::string_view bytes);

  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_.path(); }
  /// Returns the path of the unfinished file on disk, for libraries that write by path (call `close` before).
  /// Throws InputError for a target that cannot be replaced.
  [[nodiscard]] std::filesystem::path temporary() const;

  /// Writes all buffers and closes the file. Throws InputError if that fails, as on a full disk.
  void close();

  /// Completes the file and renames it into place, or adds it to the set of its target.
  void commit() { commit_all(std::span(this, 1)); }

  /// Completes the files; puts them in place together, except those whose target has an OutputSet.
  static void commit_all(std::span<OutputFile> files);

 private:
  struct Stream;
  friend class OutputSet;
  [[nodiscard]] Text& text() noexcept;
  void flush_if_full();
  void flush();
  void check_written(int error) const;

  // for OutputSet
  /// Writes a target that cannot be replaced or that is in a store.
  void write_directly();
  /// Returns the scratch folder, null for a target that is written directly.
  [[nodiscard]] const Scratch* scratch() const noexcept;

  FilePath target_;
  std::unique_ptr<Stream> stream_;
};

}  // namespace meshorder
