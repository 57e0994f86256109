// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_file.hpp"

#include "io/stream/descriptor.hpp"
#include "io/stream/output_place.hpp"
#include "io/stream/output_set.hpp"
#include "io/stream/scratch.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kFlushAt = std::size_t{1} << 20;
constexpr std::size_t kNoCopyAt = std::size_t{1} << 16;  // texts of this size or more are not copied
constexpr std::size_t kSyncAt = std::size_t{32} << 20;   // bytes between two calls of `begin_sync`
constexpr mode_t kMode = 0666;                           // the umask or the folder's default ACL removes bits
constexpr mode_t kPrivateMode = 0600;                    // until the new file gets the mode of the old file

}  // namespace

struct OutputFile::Stream {
  Text text;
  OutputPlace place;
  std::optional<Scratch> scratch;  ///< empty if `text` holds the whole file
  Descriptor file;
  std::size_t since_sync = 0;  ///< bytes written since the last `begin_sync`

  [[nodiscard]] int put(std::string_view bytes) {
    const int error = file.write(bytes);
    since_sync += bytes.size();
    if (since_sync < kSyncAt) return error;
    since_sync = 0;
    file.begin_sync();
    return error;
  }
};

OutputFile::OutputFile(FilePath target) : target_(std::move(target)), stream_(std::make_unique<Stream>()) {
  if (target_.store() != nullptr) return;
  const fs::path& path = target_.path();
  stream_->place = output_place(target_);
  const OutputPlace& place = stream_->place;
  if (place.is_through) {
    if (place.own_descriptor < 0 && ::access(place.path.c_str(), W_OK) != 0)
      throw_system_fault(path.string(), "cannot be written", errno);
    return;
  }
  if (const fs::path plain = without_gz(path); plain != path) {
    throw InputError(path.string(), "would not be compressed",
                     "write " + plain.filename().string() + ", then gzip it");
  }
  std::error_code code;
  const fs::path folder = folder_of(place.path);
  if (!fs::is_directory(folder, code)) {
    throw InputError(path.string(), "its folder does not exist", "make " + folder.string() + " first");
  }
  remove_dead_scratches(folder);
  stream_->scratch.emplace(place.path);
  stream_->file = Descriptor(stream_->scratch->file(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW,
                             place.exists ? kPrivateMode : kMode);
  if (!stream_->file.is_open()) throw_system_fault(path.string(), "cannot be written", errno);
}

OutputFile::OutputFile(OutputFile&& other) noexcept = default;
OutputFile::~OutputFile() = default;

Text& OutputFile::text() noexcept { return stream_->text; }

void OutputFile::flush_if_full() {
  if (stream_->text.size() > kFlushAt) flush();
}

void OutputFile::write(std::string_view bytes) {
  auto& [text, place, scratch, file, since_sync] = *stream_;
  if (scratch && bytes.size() >= kNoCopyAt) {
    flush();
    check_written(stream_->put(bytes));
    return;
  }
  text.write(bytes);
  flush_if_full();
}

void OutputFile::integer(std::string_view before, std::int64_t value) {
  text().integer(before, value);
  flush_if_full();
}

void OutputFile::real(std::string_view before, double value) {
  text().real(before, value);
  flush_if_full();
}

char* OutputFile::room(std::size_t bytes) { return text().room(bytes); }

void OutputFile::written(const char* end) {
  text().written(end);
  flush_if_full();
}

void OutputFile::write_over_start(std::string_view bytes) {
  auto& [text, place, scratch, file, since_sync] = *stream_;
  if (!scratch) {
    std::copy(bytes.begin(), bytes.end(), text.data());
    return;
  }
  flush();
  int error = ::lseek(file.get(), 0, SEEK_SET) < 0 ? errno : file.write(bytes);
  if (error == 0 && ::lseek(file.get(), 0, SEEK_END) < 0) error = errno;
  if (error != 0) throw_system_fault(target_.string(), "cannot be written to the end", error);
}

void OutputFile::flush() {
  if (!stream_->scratch) return;
  const int error = stream_->put(stream_->text.view());
  stream_->text.clear();
  check_written(error);
}

void OutputFile::check_written(int error) const {
  if (error != 0) throw_system_fault(target_.string(), "cannot be written to the end", error);
}

fs::path OutputFile::temporary() const {
  if (stream_->scratch) return stream_->scratch->file();
  throw InputError(target_.string(),
                   "is not an ordinary file, and its format cannot be written from start to end",
                   "write an ordinary file, then copy it");
}

void OutputFile::close() {
  if (!stream_->file.is_open()) return;
  flush();
  if (const int error = stream_->file.close(); error != 0)
    throw_system_fault(target_.string(), "cannot be written to the end", error);
}

void OutputFile::write_directly() {
  const auto& [text, place, scratch, file, since_sync] = *stream_;
  if (FileStore* const store = target_.store()) return store->write(target(), std::string(text.view()));
  if (!place.is_through) return;
  Descriptor out =
      place.own_descriptor >= 0 ? Descriptor(::dup(place.own_descriptor)) : Descriptor(place.path, O_WRONLY);
  int error = out.is_open() ? out.write(text.view()) : errno;
  if (const int closing = out.close(); error == 0) error = closing;
  if (error != 0) throw_system_fault(target_.string(), "cannot be written to the end", error);
}

const Scratch* OutputFile::scratch() const noexcept {
  return stream_->scratch ? &*stream_->scratch : nullptr;
}

void OutputFile::commit_all(std::span<OutputFile> files) {
  OutputSet own;
  for (OutputFile& file : files) {
    OutputSet* const set = file.target_.set();
    (set != nullptr ? *set : own).add(std::move(file));
  }
  own.commit();
}

}  // namespace meshorder
