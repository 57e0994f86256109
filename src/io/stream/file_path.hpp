// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/input_file.hpp"
#include "base/polymorphic.hpp"

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace meshorder {

/// Returns the path without the ".gz" (upper or lower case) at its end, if it has one.
std::filesystem::path without_gz(std::filesystem::path path);

/// Returns the rest of a stream; `name` is for messages. Throws InputError for a stream that does not end
/// within the memory limit.
std::string read_to_end(std::istream& stream, const std::string& name);

/// Files kept elsewhere than on disk.
class FileStore : public Polymorphic {
 public:
  [[nodiscard]] virtual bool has(const std::filesystem::path& path) const = 0;
  /// Returns the bytes of a file; empty if the store has no such file.
  [[nodiscard]] virtual std::string read(const std::filesystem::path& path) const = 0;
  /// Adds a file or replaces it.
  virtual void write(const std::filesystem::path& path, std::string bytes) = 0;
};

class OutputSet;

/// The path of a file on disk or in a store; the file need not exist. Records which part of the path the user
/// named. Symbolic links are followed in that part, but not in a part that this program derived, such as
/// mesh.ele from mesh.node.
class FilePath {
 public:
  // NOLINTBEGIN(google-explicit-constructor): a path names a file on disk
  /// A file on disk.
  FilePath(std::filesystem::path path) : path_(std::move(path)) {}
  FilePath(const std::string& path) : path_(path) {}
  FilePath(const char* path) : path_(path) {}
  // NOLINTEND(google-explicit-constructor)
  /// A file in a store, which must outlive this object.
  FilePath(std::filesystem::path path, FileStore& store) : path_(std::move(path)), store_(&store) {}
  /// A file on disk. If it is written, `set` puts it in place; `set` must outlive this object.
  FilePath(FilePath path, OutputSet& set)
      : path_(std::move(path.path_)), folder_(std::move(path.folder_)), set_(&set) {}

  /// Returns a file on disk below a folder that the user named; this program, or a file, gave the rest of the
  /// path. Reading fails unless the resolved path is below that folder or an allowed one (`may_include`).
  static FilePath in(std::filesystem::path folder, std::filesystem::path path);
  /// As `in`, with the folder of `path`: for a file whose name this program made.
  static FilePath derived(const std::filesystem::path& path) { return in(path.parent_path(), path); }

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Returns the path as text, for messages.
  [[nodiscard]] std::string string() const { return path_.string(); }
  /// Returns the store, null for a file on disk.
  [[nodiscard]] FileStore* store() const noexcept { return store_; }
  /// Returns the set of outputs that the file belongs to, null if there is none.
  [[nodiscard]] OutputSet* set() const noexcept { return set_; }
  /// Returns the folder that the user named if the rest of the path is derived; nullopt if the user gave the
  /// whole path.
  [[nodiscard]] const std::optional<std::filesystem::path>& folder() const noexcept { return folder_; }

  /// Returns whether the file exists; false also if the system denies access.
  [[nodiscard]] bool exists() const;
  /// Returns whether the file exists and is a regular file, not a folder or a device.
  [[nodiscard]] bool is_file() const;
  [[nodiscard]] bool is_empty() const;
  /// Returns whether both paths lead to the same file.
  [[nodiscard]] bool is_same(const FilePath& other) const;
  /// Opens a file on disk. Throws InputError as `InputFile` does.
  [[nodiscard]] InputFile open() const;
  /// Returns the bytes of the file; decompresses a gzip file. Throws InputError for a folder, a device, an
  /// unreadable or an empty file, a file that changes during the call or exceeds the memory limit, and a
  /// damaged gzip file; Unavailable for a gzip file in a build without zlib.
  [[nodiscard]] std::string read() const;
  /// Returns the first bytes of the file, at most `most`, without decompressing them. Reads a pipe to its
  /// end. Throws InputError as `read`, but not for a damaged gzip file.
  [[nodiscard]] std::string read_first(std::size_t most) const;

  /// Returns the file of that name in the same folder.
  [[nodiscard]] FilePath beside(const std::filesystem::path& name) const;
  /// Returns the companion file with that extension: "mesh.ele" for "mesh.node", "mesh.ele.gz" for
  /// "mesh.node.gz". Returns this file if it has the extension, in upper or lower case.
  [[nodiscard]] FilePath companion(std::string_view extension) const;

 private:
  [[nodiscard]] FilePath at(std::filesystem::path path) const;

  std::filesystem::path path_;
  std::optional<std::filesystem::path> folder_;  ///< see `folder`
  FileStore* store_ = nullptr;
  OutputSet* set_ = nullptr;
};

}  // namespace meshorder
