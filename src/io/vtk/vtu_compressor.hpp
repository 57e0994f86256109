// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/vtk/vtk.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace meshorder::vtk {

/// One of the compressors of .vtu files: zlib, LZ4 blocks, or xz streams, as VTK's vtkZLibDataCompressor,
/// vtkLZ4DataCompressor and vtkLZMADataCompressor write them.
class VtuCompressor {
 public:
  /// `kind` is not `none`.
  explicit VtuCompressor(VtuEncoding::Compressor kind) : kind_(kind) {}

  /// Returns an upper bound on the number of bytes that one compressed byte can hold.
  static std::uint64_t greatest_ratio(VtuEncoding::Compressor kind);

  [[nodiscard]] std::string compress(std::span<const char> bytes) const;

  /// Fills `target`; returns false if `bytes` do not hold exactly that many.
  [[nodiscard]] bool uncompress(std::span<const char> bytes, std::span<char> target) const;

 private:
  VtuEncoding::Compressor kind_;
};

}  // namespace meshorder::vtk
