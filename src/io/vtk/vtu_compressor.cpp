// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vtk/vtu_compressor.hpp"

#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <limits>
#include <stdexcept>

namespace meshorder::vtk {
namespace {

constexpr int kLevel = 5;  // VTK's default, of 1 to 9

const Bytef* bytes_of(std::span<const char> bytes) { return reinterpret_cast<const Bytef*>(bytes.data()); }

/// Compresses `bytes` into `room`; the bytes that took, 0 on failure.
std::size_t compress_with(VtuEncoding::Compressor kind, std::span<const char> bytes, std::span<char> room) {
  auto* const target = reinterpret_cast<Bytef*>(room.data());
  if (kind == VtuEncoding::Compressor::zlib) {
    uLongf size = room.size();
    return compress2(target, &size, bytes_of(bytes), bytes.size(), kLevel) == Z_OK ? size : 0;
  }
  if (kind == VtuEncoding::Compressor::lz4) {
    return static_cast<std::size_t>(LZ4_compress_default(
        bytes.data(), room.data(), static_cast<int>(bytes.size()), static_cast<int>(room.size())));
  }
  std::size_t size = 0;
  const lzma_ret status = lzma_easy_buffer_encode(kLevel, LZMA_CHECK_CRC32, nullptr, bytes_of(bytes),
                                                  bytes.size(), target, &size, room.size());
  return status == LZMA_OK ? size : 0;
}

std::size_t greatest_size(VtuEncoding::Compressor kind, std::size_t bytes) {
  if (kind == VtuEncoding::Compressor::zlib) return compressBound(bytes);
  if (kind == VtuEncoding::Compressor::lz4) {
    return static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes)));
  }
  return lzma_stream_buffer_bound(bytes);
}

}  // namespace

std::uint64_t VtuCompressor::greatest_ratio(VtuEncoding::Compressor kind) {
  switch (kind) {
    case VtuEncoding::Compressor::zlib:
      return 1100;
    case VtuEncoding::Compressor::lz4:
      return 300;
    case VtuEncoding::Compressor::lzma:
      return 20000;
    case VtuEncoding::Compressor::none:
      break;
  }
  return 1;
}

std::string VtuCompressor::compress(std::span<const char> bytes) const {
  std::string result(greatest_size(kind_, bytes.size()), '\0');
  result.resize(compress_with(kind_, bytes, result));
  if (result.empty()) throw std::runtime_error("a block of an array could not be compressed");
  return result;
}

bool VtuCompressor::uncompress(std::span<const char> bytes, std::span<char> target) const {
  if (bytes.empty() || target.empty()) return target.empty();
  if (kind_ == VtuEncoding::Compressor::zlib) {
    uLongf size = target.size();
    return ::uncompress(reinterpret_cast<Bytef*>(target.data()), &size, bytes_of(bytes), bytes.size()) ==
               Z_OK &&
           size == target.size();
  }
  if (kind_ == VtuEncoding::Compressor::lz4) {
    constexpr std::size_t kMost = std::numeric_limits<int>::max();
    if (bytes.size() > kMost || target.size() > kMost) return false;
    return LZ4_decompress_safe(bytes.data(), target.data(), static_cast<int>(bytes.size()),
                               static_cast<int>(target.size())) == static_cast<int>(target.size());
  }
  std::uint64_t memory = std::uint64_t{1} << 30;
  std::size_t read = 0;
  std::size_t written = 0;
  return lzma_stream_buffer_decode(&memory, 0, nullptr, bytes_of(bytes), &read, bytes.size(),
                                   reinterpret_cast<Bytef*>(target.data()), &written,
                                   target.size()) == LZMA_OK &&
         written == target.size();
}

}  // namespace meshorder::vtk
