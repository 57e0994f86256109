// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Returns the path with links, "." and ".." resolved if it lies below one of the folders, else nothing. The
/// folders are resolved in the same way ("" is the current folder). The file itself need not exist.
std::optional<std::filesystem::path> real_path_below(const std::filesystem::path& path,
                                                     std::span<const std::filesystem::path> folders);

/// A file that is open for reading. The library reads all files through this class, except the system's
/// descriptions of the machine (/proc, /sys).
///
/// Opening does not wait for long: a pipe that the user named needs a writer within three seconds; other
/// pipes are refused like devices, sockets, folders and pointers of Git LFS. Throws InputError for what is
/// refused, for a file that is missing or may not be read, and for failures of the disk.
class InputFile {
 public:
  /// Opens the path that the user gave. Links are followed; a pipe is read to its end.
  explicit InputFile(const std::filesystem::path& path);
  /// Opens a file whose name comes from a file, a folder or another name. The file must lie below one of the
  /// folders (see `real_path_below`). The path's links are resolved first; its components are then opened one
  /// by one, without following a link that another process puts there meanwhile.
  InputFile(const std::filesystem::path& path, std::span<const std::filesystem::path> folders);
  ~InputFile();
  InputFile(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  InputFile& operator=(InputFile&&) = delete;

  /// Returns the size of the file when it was opened, in bytes; 0 for a pipe and for files of /proc.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

  /// Reads the next bytes. Returns their number, less than requested only at the end.
  std::size_t read(std::span<char> into);
  /// Reads bytes from offset `at`; not for pipes. Returns their number, less than requested only at the end
  /// of the file.
  [[nodiscard]] std::size_t read_at(std::uint64_t at, std::span<char> into) const;
  /// Returns the rest of a small file. Throws InputError if it has more than `most` bytes.
  std::string text(std::size_t most);

  /// Returns a path by which libraries can open this file while this object lives, even if another file has
  /// replaced it (/proc/self/fd/…); on systems without /proc, the file's own path.
  [[nodiscard]] std::string path_for_libraries() const;

 private:
  [[noreturn]] void fail(int error) const;
  void require_readable();
  void wait_for_writer();
  void close() noexcept;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::optional<char> ahead_;  ///< the byte of a pipe that `wait_for_writer` read
  bool may_be_pipe_ = false;
};

}  // namespace meshorder
