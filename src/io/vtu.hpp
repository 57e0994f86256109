// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"

#include <bit>
#include <cstdint>
#include <span>
#include <string>

namespace meshorder {

/// How a .vtu file stores its arrays.
struct VtuEncoding {
  enum class Mode : std::uint8_t { ascii, base64, appended_base64, appended_raw };
  enum class Compressor : std::uint8_t { none, zlib, lz4, lzma };
  Mode mode = Mode::appended_raw;
  Compressor compressor = Compressor::none;
  std::endian order = std::endian::native;
  bool wide_headers = true;  ///< whether sizes of blocks are UInt64, else UInt32
};

/// One file of a .pvd collection.
struct PvdEntry {
  double time = 0;   ///< s
  std::string file;  ///< path, relative to the collection's folder
};

/// Writes a .pvd collection: a list of files for different times, which ParaView opens as an animation.
/// Throws Error if the list cannot be written, InvalidArgument for a time that is not finite; leaves no
/// partial file. O(entries). https://www.paraview.org/Wiki/ParaView/Data_formats
void write_pvd(std::span<const PvdEntry> entries, const FilePath& path);

}  // namespace meshorder
