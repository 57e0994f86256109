// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/vtu.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace meshorder::vtk {

/// One of the compressors of .vtu files: zlib, LZ4 blocks, or xz streams, as VTK's vtkZLibDataCompressor,
/// vtkLZ4DataCompressor and vtkLZMADataCompressor write them. The build may lack some of their libraries.
class VtuCompressor {
 public:
  /// Uncompressed size of a block of the arrays that meshorder writes, in bytes.
  static constexpr std::size_t kBlock = std::size_t{1} << 20;

  /// `kind` must be available and not `none`.
  explicit VtuCompressor(VtuEncoding::Compressor kind) : kind_(kind) {}

  /// Returns whether this build has the library of the compressor; true for `none`.
  static bool available(VtuEncoding::Compressor kind);

  /// Returns the names of the library and of the CMake option that brings it; empty for `none`.
  static std::string_view library(VtuEncoding::Compressor kind);
  static std::string_view option(VtuEncoding::Compressor kind);

  /// Returns an upper bound on the ratio of the uncompressed size to the compressed size.
  static std::uint64_t greatest_ratio(VtuEncoding::Compressor kind);

  [[nodiscard]] std::string compress(std::span<const char> bytes) const;

  /// Fills `target`; returns false if `bytes` do not uncompress to exactly the size of `target`.
  [[nodiscard]] bool uncompress(std::span<const char> bytes, std::span<char> target) const;

 private:
  VtuEncoding::Compressor kind_;
};

}  // namespace meshorder::vtk
