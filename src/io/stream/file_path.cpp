// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/file_path.hpp"

#include "base/lfs_pointer.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "io/stream/gzip.hpp"
#include "io/stream/read_limits.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <istream>
#include <limits>
#include <span>
#include <system_error>
#include <vector>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

/// Fills `into` with the first bytes of a file, on all threads if `into` is large. Returns how many bytes it
/// read: fewer than the size of `into` if the file is shorter.
std::size_t read_on_threads(InputFile& file, std::span<char> into) {
  constexpr Offset kAtOnce = Offset{16} << 20;
  if (std::ssize(into) <= kAtOnce) return file.read(into);
  std::atomic<std::size_t> end_of_file = into.size();
  for_each_range(std::ssize(into), kAtOnce, [&](Offset begin, Offset end) {
    const auto at = static_cast<std::size_t>(begin);
    const std::span<char> part = into.subspan(at, static_cast<std::size_t>(end - begin));
    const std::size_t got = file.read_at(at, part);
    if (got == part.size()) return;
    std::size_t found = end_of_file;
    while (at + got < found && !end_of_file.compare_exchange_weak(found, at + got)) {
    }
  });
  return end_of_file;
}

/// Returns the first `wanted` bytes of a file.
std::string read_sized(InputFile& file, const std::string& name, std::uint64_t wanted) {
  // a file may have more bytes than the limit on claims
  const std::uint64_t most = std::max(limit_on_unknown_sizes(), usable_memory() / 4 * 3);
  if (wanted > most) {
    throw InputError(
        name, fmt::format("has {}, more than the limit of {}", size_text(file.size()), size_text(most)),
        "raise the memory limit (--limit-memory) if it fits");
  }
  std::string bytes;
  resize_large(bytes, wanted);
  const std::size_t got = read_on_threads(file, bytes);
  if (got < wanted) {
    throw InputError(name, fmt::format("had {} bytes and ended after {}", file.size(), got),
                     "the file changed while it was read, or the disk is failing");
  }
  if (char further = 0; wanted == file.size() && file.read_at(wanted, {&further, 1}) > 0) {
    throw InputError(name, fmt::format("grew beyond {} bytes while it was read", file.size()),
                     "wait until it is complete");
  }
  return bytes;
}

/// Calls `read`, which fills a buffer and returns the number of bytes, until it returns 0. Returns all bytes.
template <class Read>
std::string all_of(const Read& read, const std::string& name) {
  constexpr std::size_t kPart = std::size_t{1} << 20;
  const std::uint64_t most = limit_on_unknown_sizes();
  std::string bytes;
  std::vector<char> part(kPart);
  while (const std::size_t got = read(part)) {
    if (got > most - bytes.size()) {
      throw InputError(name, "has no end within " + size_text(most),
                       "if it has one, raise the memory limit (--limit-memory)");
    }
    bytes.append(part.data(), got);
  }
  return bytes;
}

/// Returns the first bytes of a file, at most `most`, or all bytes of a pipe.
std::string read_from_disk(const FilePath& path, std::uint64_t most) {
  InputFile file = path.open();
  // pipes and files of /proc report the size 0
  if (file.size() == 0)
    return all_of([&](std::vector<char>& part) { return file.read(part); }, path.string());
  return read_sized(file, path.string(), std::min(file.size(), most));
}

bool is_gz(const fs::path& path) { return same_but_for_case(path.extension().string(), ".gz"); }

}  // namespace

std::string read_to_end(std::istream& stream, const std::string& name) {
  const auto read = [&](std::vector<char>& part) {
    stream.read(part.data(), std::ssize(part));
    return static_cast<std::size_t>(stream.gcount());
  };
  return all_of(read, name);
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

InputFile FilePath::open() const {
  return folder_ ? InputFile(path_, folders_for_includes(*folder_)) : InputFile(path_);
}

std::string FilePath::read() const {
  std::string bytes = read_first(std::numeric_limits<std::size_t>::max());
  count_file(*this, bytes.size());
  bytes = uncompressed(std::move(bytes), string());
  if (bytes.empty()) throw InputError(string(), "is empty", "give a file");
  return bytes;
}

std::string FilePath::read_first(std::size_t most) const {
  std::string bytes = store_ != nullptr ? store_->read(path_) : read_from_disk(*this, most);
  if (store_ != nullptr) refuse_lfs_pointer(bytes, string());
  if (bytes.size() > most) bytes.resize(most);
  if (bytes.empty()) throw InputError(string(), "is empty", "give a file");
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
