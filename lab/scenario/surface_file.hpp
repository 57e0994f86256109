// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/output_file.hpp"

#include <array>
#include <filesystem>
#include <span>
#include <vector>

namespace meshorder {

/// Writes the surface of a fluid frame by frame, for a MotionFile of the same frames. The file is a NumPy
/// array of little-endian 32-bit integers with a row for each triangle: the number of its frame, and its
/// three vertices, anticlockwise as seen from outside. It appears when it is committed, completely or not at
/// all.
class SurfaceFile {
 public:
  /// Throws Error if the file cannot be written.
  explicit SurfaceFile(std::filesystem::path path);

  /// Appends a frame.
  void add(std::span<const std::array<Index, 3>> triangles);

  /// Completes the file. Throws Error if the disk is full.
  void commit();

 private:
  OutputFile file_;
  Index frames_ = 0;
  Offset rows_ = 0;
};

/// Reads the triangles of each of `frames` frames. Throws Error, with the byte, for a file that is not such
/// an array, or names another frame or a vertex that is not 0 … vertices − 1.
std::vector<std::vector<std::array<Index, 3>>> read_surfaces(const FilePath& path, std::size_t frames,
                                                             Index vertices);

}  // namespace meshorder
