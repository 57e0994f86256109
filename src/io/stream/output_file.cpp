// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_file.hpp"

#include "base/error.hpp"

#include <unistd.h>

#include <system_error>

namespace meshorder {
namespace fs = std::filesystem;

OutputFile::OutputFile(fs::path target) : target_(std::move(target)) {
  std::error_code code;
  if (fs::is_directory(target_, code)) {
    throw Error(target_.string(), "is a folder", "give a file name for the output");
  }
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) {
    throw Error(target_.string(), "its folder does not exist", "make " + folder.string() + " first");
  }
  // the process id keeps two runs with one target apart
  temporary_ = folder / ("." + target_.stem().string() + ".tmp" + std::to_string(::getpid()) +
                         target_.extension().string());
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) throw Error(target_.string(), "cannot be written", "check the folder's permissions");
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      stream_(std::move(other.stream_)),
      buffer_(std::move(other.buffer_)) {}

OutputFile::~OutputFile() {
  if (temporary_.empty()) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void OutputFile::write(std::string_view bytes) {
  buffer_.append(bytes.data(), bytes.data() + bytes.size());
  if (buffer_.size() > kFlushAt) flush();
}

void OutputFile::flush() {
  stream_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
  if (!stream_) throw Error(target_.string(), "cannot be written to the end", "is the disk full?");
}

void OutputFile::close() {
  if (!stream_.is_open()) return;
  flush();
  stream_.close();
  if (!stream_) throw Error(target_.string(), "cannot be written to the end", "is the disk full?");
}

void OutputFile::commit_all(std::span<OutputFile> files) {
  for (OutputFile& file : files) file.close();
  for (OutputFile& file : files) {
    std::error_code code;
    fs::rename(file.temporary_, file.target_, code);
    if (code) throw Error(file.target_.string(), "cannot be replaced: " + code.message(), "check the target");
    file.temporary_.clear();
  }
}

}  // namespace meshorder
