// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vtk/vtu_compressor.hpp"

#ifdef MESHORDER_HAS_LZ4
#include <lz4.h>
#endif
#ifdef MESHORDER_HAS_LZMA
#include <lzma.h>
#endif
#ifdef MESHORDER_HAS_ZLIB
#include <zlib.h>
#endif

#include <array>
#include <limits>
#include <stdexcept>

namespace meshorder::vtk {
namespace {

/// The functions of a library; all are null if the build lacks the library.
struct Codec {
  /// Returns an upper bound on the compressed size of that number of bytes.
  std::size_t (*bound)(std::size_t bytes) = nullptr;
  /// Compresses into `room`; returns the compressed size in bytes, 0 on failure.
  std::size_t (*compress)(std::span<const char> bytes, std::span<char> room) = nullptr;
  /// Fills `target`; returns false if `bytes` do not uncompress to exactly the size of `target`.
  bool (*uncompress)(std::span<const char> bytes, std::span<char> target) = nullptr;
};

[[maybe_unused]] constexpr int kLevel = 5;  // VTK's default, of 1 to 9

[[maybe_unused]] const std::uint8_t* unsigned_bytes(std::span<const char> bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}
[[maybe_unused]] std::uint8_t* unsigned_bytes(std::span<char> bytes) {
  return reinterpret_cast<std::uint8_t*>(bytes.data());
}

constexpr Codec zlib_codec() {
  Codec codec;
#ifdef MESHORDER_HAS_ZLIB
  codec.bound = [](std::size_t bytes) -> std::size_t { return compressBound(bytes); };
  codec.compress = [](std::span<const char> bytes, std::span<char> room) -> std::size_t {
    uLongf size = room.size();
    return compress2(unsigned_bytes(room), &size, unsigned_bytes(bytes), bytes.size(), kLevel) == Z_OK ? size
                                                                                                       : 0;
  };
  codec.uncompress = [](std::span<const char> bytes, std::span<char> target) {
    uLongf size = target.size();
    return ::uncompress(unsigned_bytes(target), &size, unsigned_bytes(bytes), bytes.size()) == Z_OK &&
           size == target.size();
  };
#endif
  return codec;
}

constexpr Codec lz4_codec() {
  Codec codec;
#ifdef MESHORDER_HAS_LZ4
  codec.bound = [](std::size_t bytes) {
    return static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes)));
  };
  codec.compress = [](std::span<const char> bytes, std::span<char> room) {
    return static_cast<std::size_t>(LZ4_compress_default(
        bytes.data(), room.data(), static_cast<int>(bytes.size()), static_cast<int>(room.size())));
  };
  codec.uncompress = [](std::span<const char> bytes, std::span<char> target) {
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    if (bytes.size() > kMost || target.size() > kMost) return false;
    return LZ4_decompress_safe(bytes.data(), target.data(), static_cast<int>(bytes.size()),
                               static_cast<int>(target.size())) == static_cast<int>(target.size());
  };
#endif
  return codec;
}

constexpr Codec lzma_codec() {
  Codec codec;
#ifdef MESHORDER_HAS_LZMA
  codec.bound = [](std::size_t bytes) { return lzma_stream_buffer_bound(bytes); };
  codec.compress = [](std::span<const char> bytes, std::span<char> room) {
    std::size_t size = 0;
    const lzma_ret status = lzma_easy_buffer_encode(kLevel, LZMA_CHECK_CRC32, nullptr, unsigned_bytes(bytes),
                                                    bytes.size(), unsigned_bytes(room), &size, room.size());
    return status == LZMA_OK ? size : 0;
  };
  codec.uncompress = [](std::span<const char> bytes, std::span<char> target) {
    std::uint64_t memory = std::uint64_t{1} << 30;
    std::size_t read = 0;
    std::size_t written = 0;
    return lzma_stream_buffer_decode(&memory, 0, nullptr, unsigned_bytes(bytes), &read, bytes.size(),
                                     unsigned_bytes(target), &written, target.size()) == LZMA_OK &&
           written == target.size();
  };
#endif
  return codec;
}

/// A compressor; `greatest_ratio` bounds the ratio of the uncompressed size to the compressed size.
struct Library {
  Codec codec;
  std::string_view name;
  std::string_view option;
  std::uint64_t greatest_ratio;
};

/// Libraries in the order of VtuEncoding::Compressor.
constexpr std::array kLibraries{Library{{}, "", "", 1}, Library{zlib_codec(), "zlib", "MESHORDER_ZLIB", 1100},
                                Library{lz4_codec(), "LZ4", "MESHORDER_LZ4", 300},
                                Library{lzma_codec(), "LZMA", "MESHORDER_LZMA", 20000}};

const Library& library_of(VtuEncoding::Compressor kind) { return kLibraries[static_cast<std::size_t>(kind)]; }

}  // namespace

bool VtuCompressor::available(VtuEncoding::Compressor kind) {
  return kind == VtuEncoding::Compressor::none || library_of(kind).codec.compress != nullptr;
}

std::string_view VtuCompressor::library(VtuEncoding::Compressor kind) { return library_of(kind).name; }
std::string_view VtuCompressor::option(VtuEncoding::Compressor kind) { return library_of(kind).option; }
std::uint64_t VtuCompressor::greatest_ratio(VtuEncoding::Compressor kind) {
  return library_of(kind).greatest_ratio;
}

std::string VtuCompressor::compress(std::span<const char> bytes) const {
  const Codec& codec = library_of(kind_).codec;
  std::string result(codec.bound(bytes.size()), '\0');
  result.resize(codec.compress(bytes, result));
  if (result.empty()) throw std::runtime_error("a block of an array could not be compressed");
  return result;
}

bool VtuCompressor::uncompress(std::span<const char> bytes, std::span<char> target) const {
  if (bytes.empty() || target.empty()) return target.empty();
  return library_of(kind_).codec.uncompress(bytes, target);
}

}  // namespace meshorder::vtk
