// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/files.hpp"

#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

namespace meshorder::test {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  static int count = 0;
  path_ = fs::temp_directory_path() /
          ("meshorder-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
  fs::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path TemporaryFolder::file(const std::string& name, std::string_view content) const {
  const fs::path path = path_ / name;
  std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
  return path;
}

std::vector<std::string> TemporaryFolder::names() const {
  std::vector<std::string> result;
  for (const auto& entry : fs::directory_iterator(path_)) result.push_back(entry.path().filename().string());
  std::sort(result.begin(), result.end());
  return result;
}

std::string content_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string with(std::string text, std::string_view old, std::string_view fresh) {
  const auto at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), fresh);
}

fs::path data_mesh(const std::string& name) { return fs::path(MESHORDER_TEST_DATA) / name; }

std::string read_error(const fs::path& path) {
  try {
    (void)read_mesh(path);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was read without an error";
  return "";
}

std::string write_error(const Mesh& mesh, const fs::path& path) {
  try {
    write_mesh(mesh, path);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was written without an error";
  return "";
}

void expect_broken(const std::string& name, const std::vector<BrokenFile>& files) {
  for (const BrokenFile& broken : files) {
    SCOPED_TRACE(broken.what);
    const TemporaryFolder folder;
    const std::string message = read_error(folder.file(name, broken.content));
    EXPECT_NE(message.find(broken.expected), std::string::npos) << message;
    EXPECT_NE(message.find(name.substr(0, name.rfind('.'))), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

void expect_truncation_is_noticed(const std::string& name, std::string_view content) {
  const TemporaryFolder folder;
  const Mesh whole = read_mesh(folder.file(name, content));
  const std::size_t step = std::max<std::size_t>(1, content.size() / 400);
  for (std::size_t size = 0; size < content.size(); size += step) {
    const fs::path path = folder.file(name, content.substr(0, size));
    std::optional<Mesh> part;
    try {
      part = read_mesh(path);
    } catch (const InputError&) {
      continue;
    }
    // only the loss of a line end or of an optional section's last blanks may go unnoticed
    EXPECT_EQ(part->points, whole.points) << "cut after " << size << " bytes";
    EXPECT_EQ(part->cells, whole.cells) << "cut after " << size << " bytes";
  }
}

void expect_order_and_back(const fs::path& path) {
  const TemporaryFolder folder;
  const Mesh original = read_mesh(path);
  Mesh mesh = original;
  const Permutation vertices = shuffled(mesh.vertex_count(), 1);
  const Permutation cells = shuffled_cells(mesh, 2);
  apply_reordering(mesh, vertices, cells);
  const fs::path ordered_path = folder.path() / path.filename();
  write_mesh(mesh, ordered_path);

  Mesh ordered = read_mesh(ordered_path);
  {
    SCOPED_TRACE("ordered, written and read");
    expect_same(ordered, mesh);
  }
  apply_reordering(ordered, vertices.inverse(), cells.inverse());
  const fs::path back_path = folder.path() / ("back-" + path.filename().string());
  write_mesh(ordered, back_path);
  SCOPED_TRACE("put back, written and read");
  expect_same(read_mesh(back_path), original);
}

void expect_order_and_back_to(const std::string& name, std::string_view content) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file(name, content));
  const Permutation vertices = shuffled(mesh.vertex_count(), 1);
  const Permutation cells = shuffled_cells(mesh, 2);
  apply_reordering(mesh, vertices, cells);
  write_mesh(mesh, folder.path() / ("ordered-" + name));
  Mesh ordered = read_mesh(folder.path() / ("ordered-" + name));
  expect_same(sorted_members(ordered), sorted_members(mesh));

  apply_reordering(ordered, vertices.inverse(), cells.inverse());
  write_mesh(ordered, folder.path() / ("back-" + name));
  EXPECT_EQ(content_of(folder.path() / ("back-" + name)), content);
}

void expect_write_and_read(const Mesh& mesh, const std::string& name) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / name;
  write_mesh(mesh, path);
  expect_same(read_mesh(path), mesh);
}

}  // namespace meshorder::test
