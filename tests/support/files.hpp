// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::test {

/// A new empty folder for the running test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Writes a file of that name and returns its path.
  [[nodiscard]] std::filesystem::path file(const std::string& name, std::string_view content) const;
  /// Names of all files in the folder, sorted.
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

std::string content_of(const std::filesystem::path& path);

/// The text with the first `old` replaced by `fresh`; EXPECTs that the text contains `old`.
std::string with(std::string text, std::string_view old, std::string_view fresh);

/// The path of a mesh in tests/data, which Gmsh or TetGen made.
std::filesystem::path data_mesh(const std::string& name);

/// The message of the Error that reading `path` throws; "" (and a failed EXPECT) when it throws none.
std::string read_error(const std::filesystem::path& path);

/// The message of the Error that writing `mesh` to `path` throws; "" (and a failed EXPECT) when it throws
/// none.
std::string write_error(const Mesh& mesh, const std::filesystem::path& path);

/// A broken file and what its one error line must contain: "FILE:LINE:" is checked by giving ":7:".
struct BrokenFile {
  std::string what;
  std::string content;
  std::string expected;
};

/// EXPECTs that reading each content as a file called `name` gives an Error whose message contains `expected`
/// and the file's name.
void expect_broken(const std::string& name, const std::vector<BrokenFile>& files);

/// Reads the first bytes of `content`: 400 to 800 lengths, or all lengths for shorter contents. EXPECTs an
/// InputError, or the same points and cells as from the whole.
void expect_truncation_is_noticed(const std::string& name, std::string_view content);

/// Reads `path`, shuffles vertices and cells, writes the mesh with the same name in another folder, reads
/// that file, reorders by the inverse and EXPECTs the original mesh. Then writes and reads the mesh again,
/// and EXPECTs the same mesh.
void expect_order_and_back(const std::filesystem::path& path);

/// Reads `content`, shuffles vertices and cells, writes the mesh, reads it, and EXPECTs the same mesh, except
/// for the order of partial arrays' rows and of sets' members. Then restores the order and EXPECTs that
/// writing gives `content`.
void expect_order_and_back_to(const std::string& name, std::string_view content);

/// Writes `mesh` to a new file called `name`, reads it, and EXPECTs the same mesh.
void expect_write_and_read(const Mesh& mesh, const std::string& name);

}  // namespace meshorder::test
