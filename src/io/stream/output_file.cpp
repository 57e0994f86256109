// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_file.hpp"

#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kFlushAt = std::size_t{1} << 20;

}  // namespace

struct OutputFile::Stream {
  std::ofstream file;
  fmt::memory_buffer buffer;
};

OutputFile::OutputFile(FilePath target) : target_(std::move(target)), stream_(std::make_unique<Stream>()) {
  if (target_.store() != nullptr) return;
  const fs::path& path = target_.path();
  std::error_code code;
  if (fs::is_directory(path, code)) {
    throw InputError(path.string(), "is a folder", "give a file name for the output");
  }
  if (const fs::path plain = without_gz(path); plain != path) {
    throw InputError(path.string(), "would not be compressed",
                     "write " + plain.filename().string() + ", then gzip it");
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) {
    throw InputError(path.string(), "its folder does not exist", "make " + folder.string() + " first");
  }
  // the process id keeps two runs with one target apart
  temporary_ =
      folder / ("." + path.stem().string() + ".tmp" + std::to_string(::getpid()) + path.extension().string());
  stream_->file.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_->file) throw InputError(path.string(), "cannot be written", "check the folder's permissions");
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      stream_(std::move(other.stream_)) {}

OutputFile::~OutputFile() {
  if (temporary_.empty()) return;
  stream_->file.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void OutputFile::print_all(fmt::string_view format, fmt::format_args args) {
  fmt::vformat_to(std::back_inserter(stream_->buffer), format, args);
  if (stream_->buffer.size() > kFlushAt) flush();
}

void OutputFile::write(std::string_view bytes) {
  stream_->buffer.append(bytes.data(), bytes.data() + bytes.size());
  if (stream_->buffer.size() > kFlushAt) flush();
}

void OutputFile::integer(std::string_view before, std::int64_t value) {
  const fmt::format_int digits(value);
  stream_->buffer.append(before.data(), before.data() + before.size());
  write({digits.data(), digits.size()});
}

void OutputFile::flush() {
  if (target_.store() != nullptr) return;  // the buffer holds the whole file
  auto& [file, buffer] = *stream_;
  file.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
  buffer.clear();
  if (!file) throw InputError(target_.string(), "cannot be written to the end", "is the disk full?");
}

void OutputFile::close() {
  if (!stream_->file.is_open()) return;
  flush();
  stream_->file.close();
  if (!stream_->file) throw InputError(target_.string(), "cannot be written to the end", "is the disk full?");
}

void OutputFile::commit_all(std::span<OutputFile> files) {
  for (OutputFile& file : files) file.close();
  for (OutputFile& file : files) {
    if (FileStore* const store = file.target_.store()) {
      store->write(file.target(), fmt::to_string(file.stream_->buffer));
      continue;
    }
    std::error_code code;
    fs::rename(file.temporary_, file.target(), code);
    if (code)
      throw InputError(file.target_.string(), "cannot be replaced: " + code.message(), "check the target");
    file.temporary_.clear();
  }
}

}  // namespace meshorder
