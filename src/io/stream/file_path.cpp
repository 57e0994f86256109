// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/file_path.hpp"

#include "base/text.hpp"
#include "io/stream/gzip.hpp"
#include "io/stream/output_set.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <system_error>
#include <utility>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

/// Returns the bytes of a file, at most `most` of them.
std::string read_from_disk(const fs::path& path, std::uintmax_t most) {
  finish_interrupted(path);
  const std::string name = path.string();
  std::error_code code;
  const auto status = fs::status(path, code);
  if (!fs::exists(status)) throw InputError(name, "no such file", "check the path");
  if (fs::is_directory(status)) throw InputError(name, "is a folder", "give a mesh file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(name, "cannot be read", "check its permissions");
  std::string bytes;
  const auto size = fs::file_size(path, code);
  if (!code) {
    bytes.resize(std::min(size, most));
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
  } else {  // a pipe
    bytes.assign(std::istreambuf_iterator<char>(stream), {});
  }
  return bytes;
}

bool is_gz(const fs::path& path) { return same_but_for_case(path.extension().string(), ".gz"); }

}  // namespace

fs::path without_gz(fs::path path) {
  if (is_gz(path)) path.replace_extension();
  return path;
}

bool FilePath::exists() const {
  if (store_ != nullptr) return store_->has(path_);
  std::error_code ignored;
  return fs::exists(path_, ignored);
}

bool FilePath::is_file() const {
  if (store_ != nullptr) return store_->has(path_);
  std::error_code ignored;
  return fs::is_regular_file(path_, ignored);
}

bool FilePath::is_empty() const {
  if (store_ != nullptr) return store_->read(path_).empty();
  std::error_code failed;
  return fs::file_size(path_, failed) == 0 || failed;
}

bool FilePath::is_same(const FilePath& other) const {
  if (store_ != nullptr) return path_.lexically_normal() == other.path_.lexically_normal();
  std::error_code ignored;
  return fs::equivalent(path_, other.path_, ignored);
}

std::string FilePath::read() const {
  std::string bytes = uncompressed(read_first(std::numeric_limits<std::size_t>::max()), string());
  if (bytes.empty()) throw InputError(string(), "is empty", "give a mesh file");
  return bytes;
}

std::string FilePath::read_first(std::size_t most) const {
  std::string bytes = store_ != nullptr ? store_->read(path_) : read_from_disk(path_, most);
  if (bytes.size() > most) bytes.resize(most);
  if (bytes.empty()) throw InputError(string(), "is empty", "give a mesh file");
  return bytes;
}

FilePath FilePath::at(fs::path path) const {
  FilePath result = *this;
  result.path_ = std::move(path);
  return result;
}

FilePath FilePath::beside(const fs::path& name) const { return at(path_.parent_path() / name); }

FilePath FilePath::companion(std::string_view extension) const {
  fs::path path = without_gz(path_);
  if (same_but_for_case(path.extension().string(), extension)) return *this;
  path.replace_extension(extension);
  if (is_gz(path_)) path += path_.extension();
  return at(std::move(path));
}

}  // namespace meshorder
