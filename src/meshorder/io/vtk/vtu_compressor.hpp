// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/io/vtk/vtk_residue.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace meshorder {

/// One of the compressors of .vtu files, VTK's own; it prints nothing.
class VtuCompressor {
 public:
  /// `kind` is not `none`.
  explicit VtuCompressor(VtuEncoding::Compressor kind);
  ~VtuCompressor();
  VtuCompressor(VtuCompressor&&) = delete;
  VtuCompressor& operator=(VtuCompressor&&) = delete;
  VtuCompressor(const VtuCompressor&) = delete;
  VtuCompressor& operator=(const VtuCompressor&) = delete;

  /// More bytes than that cannot come out of one compressed byte.
  static std::uint64_t greatest_ratio(VtuEncoding::Compressor kind);

  [[nodiscard]] std::string compress(std::span<const char> bytes) const;

  /// Fills `target` to its end; false when that is not what `bytes` hold.
  [[nodiscard]] bool uncompress(std::span<const char> bytes, std::span<char> target) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace meshorder
