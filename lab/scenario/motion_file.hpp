// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "io/stream/output_file.hpp"

#include <array>
#include <filesystem>
#include <span>
#include <vector>

namespace meshorder {

/// Writes the frames of a motion, one after another, as a NumPy array of single precision, little endian, in
/// C order: frames × vertices × 3. The file appears whole or not at all, when it is committed.
class MotionFile {
 public:
  /// Throws Error when the file cannot be written.
  MotionFile(std::filesystem::path path, Index vertices);

  /// Appends a frame: the places of all vertices. Throws InvalidArgument for another number of them.
  void add(std::span<const Point> positions);

  /// Nothing can be added afterwards. Throws Error when the disk is full.
  void commit();

 private:
  OutputFile file_;
  Index vertices_;
  Index frames_ = 0;
};

/// What a MotionFile holds.
struct Motion {
  Index vertices = 0;
  std::vector<std::vector<std::array<float, 3>>> frames;  ///< of each, the places of all vertices
};

/// Throws Error, with the byte, for a file that is no such array, is cut short, or holds a number that is not
/// finite. O(size of the file).
Motion read_motion(const std::filesystem::path& path);

}  // namespace meshorder
