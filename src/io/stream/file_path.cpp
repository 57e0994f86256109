// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/file_path.hpp"

#include "base/large_pages.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/stream/gzip.hpp"
#include "io/stream/read_limits.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <istream>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

/// Throws InputError unless the path leads to a file or a pipe.
void require_readable(const fs::path& path, const fs::file_status& status) {
  const auto refuse = [&](const char* what) { throw InputError(path.string(), what, "give a mesh file"); };
  if (!fs::exists(status)) throw InputError(path.string(), "no such file", "check the path");
  if (fs::is_directory(status)) refuse("is a folder");
  if (fs::is_socket(status)) refuse("is a socket");
  if (fs::is_block_file(status) || fs::is_character_file(status)) refuse("is a device");
}

/// Returns the first `wanted` bytes of a file that has `size`.
std::string read_sized(std::istream& stream, const std::string& name, std::uintmax_t size,
                       std::uintmax_t wanted) {
  // a limit on claims is none on what is there
  const std::uint64_t most = std::max(limit_on_unknown_sizes(), usable_memory() / 4 * 3);
  if (wanted > most) {
    throw InputError(name, fmt::format("has {}, more than the limit of {}", size_text(size), size_text(most)),
                     "raise the limit on memory (--limit-memory) if it fits");
  }
  std::string bytes;
  resize_large(bytes, wanted);
  stream.read(bytes.data(), static_cast<std::streamsize>(wanted));
  const auto got = static_cast<std::uintmax_t>(stream.gcount());
  if (got < wanted) {
    throw InputError(name, fmt::format("had {} bytes and ended after {}", size, got),
                     "it may have been written to meanwhile, or the disk fails");
  }
  if (wanted == size && stream.peek() != std::istream::traits_type::eof()) {
    throw InputError(name, fmt::format("had {} bytes and goes on after them", size),
                     "wait until it is written to the end");
  }
  return bytes;
}

/// Returns the bytes of a file, at most `most` of them; of a pipe all.
std::string read_from_disk(const fs::path& path, std::uintmax_t most) {
  const std::string name = path.string();
  std::error_code code;
  const auto status = fs::status(path, code);
  require_readable(path, status);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(name, "cannot be read", "check its permissions");
  const auto size = fs::is_regular_file(status) ? fs::file_size(path, code) : 0;
  // files of /proc have no size either
  if (code || size == 0) return read_to_end(stream, name);
  return read_sized(stream, name, size, std::min(size, most));
}

bool is_gz(const fs::path& path) { return same_but_for_case(path.extension().string(), ".gz"); }

}  // namespace

std::string read_to_end(std::istream& stream, const std::string& name) {
  constexpr std::size_t kPart = std::size_t{1} << 20;
  const std::uint64_t most = limit_on_unknown_sizes();
  std::string bytes;
  std::vector<char> part(kPart);
  while (stream.read(part.data(), kPart), stream.gcount() > 0) {
    const auto got = static_cast<std::size_t>(stream.gcount());
    if (got > most - bytes.size()) {
      throw InputError(name, "has no end within " + size_text(most),
                       "if it has one, raise the limit on memory (--limit-memory)");
    }
    bytes.append(part.data(), got);
  }
  return bytes;
}

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
  std::string bytes = read_first(std::numeric_limits<std::size_t>::max());
  count_file(*this, bytes.size());
  bytes = uncompressed(std::move(bytes), string());
  if (bytes.empty()) throw InputError(string(), "is empty", "give a mesh file");
  return bytes;
}

std::string FilePath::read_first(std::size_t most) const {
  std::string bytes = store_ != nullptr ? store_->read(path_) : read_from_disk(path_, most);
  if (bytes.size() > most) bytes.resize(most);
  if (bytes.empty()) throw InputError(string(), "is empty", "give a mesh file");
  return bytes;
}

FilePath FilePath::in(fs::path folder, fs::path path) {
  FilePath result(std::move(path));
  result.folder_ = std::move(folder);
  return result;
}

FilePath FilePath::at(fs::path path) const {
  FilePath result = *this;
  if (!folder_) result.folder_ = path_.parent_path();
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
