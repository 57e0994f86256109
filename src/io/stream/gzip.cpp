// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/gzip.hpp"

#include "base/memory.hpp"
#include "io/stream/read_limits.hpp"
#include <meshorder/error.hpp>

#ifdef MESHORDER_HAS_ZLIB
#define ZLIB_CONST  // zlib takes its input as const
#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>
#endif
#include <utility>

namespace meshorder {
namespace {

bool is_gzip(const std::string& bytes) { return bytes.starts_with("\x1f\x8b"); }

#ifdef MESHORDER_HAS_ZLIB

constexpr std::size_t kInflateStep = std::size_t{1} << 20;
/// Size of a block in bytes: large enough that the C library returns freed blocks to the system.
constexpr std::size_t kInflateBlock = 33 * kInflateStep;

/// Bytes in blocks, which do not move when more bytes are added.
class InflatedBlocks {
 public:
  /// Returns space for 1 … `kInflateStep` more bytes.
  std::span<char> next() {
    if (used_ == kInflateBlock * blocks_.size())
      blocks_.push_back(std::make_unique_for_overwrite<char[]>(kInflateBlock));
    return {blocks_.back().get() + used_ % kInflateBlock, kInflateStep - used_ % kInflateStep};
  }
  void use(std::size_t bytes) { used_ += bytes; }

  /// Returns all bytes as one text. Needs memory for only one more block: it frees each block after copying.
  std::string joined() && {
    std::string result;
    reserve_large(result, used_);
    for (std::unique_ptr<char[]>& block : blocks_) {
      result.append(block.get(), std::min(kInflateBlock, used_ - result.size()));
      block.reset();
    }
    return result;
  }

 private:
  std::vector<std::unique_ptr<char[]>> blocks_;
  std::size_t used_ = 0;
};

/// A running decompression. The bytes may hold several gzip members, as `cat a.gz b.gz` writes them.
class Inflation {
 public:
  Inflation(const std::string& bytes, const std::string& file) : bytes_(bytes), file_(file) {
    constexpr int kWindowOfGzip = 15 + 16;
    if (inflateInit2(&stream_, kWindowOfGzip) != Z_OK) throw InternalError("zlib cannot start");
  }
  ~Inflation() { inflateEnd(&stream_); }
  Inflation(const Inflation&) = delete;
  Inflation(Inflation&&) = delete;
  Inflation& operator=(const Inflation&) = delete;
  Inflation& operator=(Inflation&&) = delete;

  /// Returns the first decompressed bytes: at most `kInflateStep`, and none after a fault.
  std::string start() {
    feed();
    std::string result(kInflateStep, '\0');
    stream_.next_out = reinterpret_cast<Bytef*>(result.data());
    stream_.avail_out = static_cast<uInt>(result.size());
    (void)inflate(&stream_, Z_SYNC_FLUSH);
    result.resize(result.size() - stream_.avail_out);
    return result;
  }

  std::string run() {
    InflatedBlocks blocks;
    for (;;) {
      feed();
      const std::span<char> place = blocks.next();
      stream_.next_out = reinterpret_cast<Bytef*>(place.data());
      stream_.avail_out = static_cast<uInt>(place.size());
      const int status = inflate(&stream_, Z_NO_FLUSH);
      // counted twice: most numbers take more memory in a mesh than in text
      const std::size_t made = place.size() - stream_.avail_out;
      claim_memory(2 * made, "the decompressed file", {.file = file_});
      blocks.use(made);
      if (status == Z_STREAM_END) {
        if (bytes_left() == 0) return std::move(blocks).joined();
        if (inflateReset(&stream_) != Z_OK) fail("is damaged");
      } else if (status == Z_BUF_ERROR || (status == Z_OK && bytes_left() == 0 && stream_.avail_out > 0)) {
        fail("ends within its compressed data");
      } else if (status != Z_OK) {
        fail("is damaged");
      }
    }
  }

 private:
  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size() - fed_ + stream_.avail_in; }

  /// If zlib has used all bytes that it got, gives it the next ones, at most 2³¹ − 1.
  void feed() {
    if (stream_.avail_in > 0) return;
    const std::size_t size =
        std::min<std::size_t>(bytes_.size() - fed_, std::numeric_limits<std::int32_t>::max());
    stream_.next_in = reinterpret_cast<const Bytef*>(bytes_.data() + fed_);
    stream_.avail_in = static_cast<uInt>(size);
    fed_ += size;
  }

  [[noreturn]] void fail(const std::string& what) const {
    const auto byte = static_cast<std::int64_t>(fed_ - stream_.avail_in);
    throw InputError(Location{file_, 0, byte}, "the gzip file " + what, "compress it again");
  }

  const std::string& bytes_;
  const std::string& file_;
  std::size_t fed_ = 0;
  z_stream stream_ = {};
};

#endif

#ifndef MESHORDER_HAS_ZLIB
[[noreturn]] void throw_without_zlib(const std::string& file) {
  throw Unavailable(file + ": is compressed, which needs a build with zlib (MESHORDER_ZLIB=ON); run gunzip");
}
#endif

}  // namespace

std::string uncompressed(std::string bytes, const std::string& file) {
  if (!is_gzip(bytes)) return bytes;
#ifdef MESHORDER_HAS_ZLIB
  return Inflation(bytes, file).run();
#else
  throw_without_zlib(file);
#endif
}

std::string uncompressed_start(std::string bytes, const std::string& file) {
  if (!is_gzip(bytes)) return bytes;
#ifdef MESHORDER_HAS_ZLIB
  return Inflation(bytes, file).start();
#else
  throw_without_zlib(file);
#endif
}

}  // namespace meshorder
