// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "io/stream/output_file.hpp"
#include "lab/motion/integrator.hpp"

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Writes the frames of a motion one by one, as a NumPy array of little-endian single precision in C order,
/// frames × vertices × 3. The file appears when it is committed, completely or not at all.
class MotionFile {
 public:
  /// Throws Error if the file cannot be written.
  MotionFile(std::filesystem::path path, Index vertices);

  /// Appends a frame, the positions of all vertices. Throws InvalidArgument for another number of vertices.
  void add(std::span<const Point> positions);

  /// Completes the file. Throws Error if the disk is full.
  void commit();

 private:
  OutputFile file_;
  Index vertices_;
  Index frames_ = 0;
};

/// The content of a MotionFile.
struct Motion {
  Index vertices = 0;
  std::vector<std::vector<std::array<float, 3>>> frames;  ///< positions of all vertices in each frame
};

/// Reads a motion. Throws Error, which names the byte, for a file that is not an array of this form, is
/// truncated or holds a number that is not finite. O(size of the file).
Motion read_motion(const FilePath& path);

/// Writes the surface of a fluid in each frame of a MotionFile. The file is a NumPy array of little-endian
/// 32-bit integers with a row for each triangle: the index of the frame, and the three vertices,
/// anticlockwise as seen from outside. The file appears when it is committed, completely or not at all.
class SurfaceFile {
 public:
  /// Throws Error if the file cannot be written.
  explicit SurfaceFile(std::filesystem::path path);

  void add(std::span<const std::array<Index, 3>> triangles);

  /// Completes the file. Throws Error if the disk is full.
  void commit();

 private:
  OutputFile file_;
  Index frames_ = 0;
  Offset rows_ = 0;
};

/// Reads the triangles of `frames` frames. Throws Error, which names the byte, for a file that is not such an
/// array, is truncated, or has a frame or vertex that does not exist.
std::vector<std::vector<std::array<Index, 3>>> read_surfaces(const FilePath& path, std::size_t frames,
                                                             Index vertices);

/// Timings and iteration counts of a step, and the body's shape after it. The step's warnings are in
/// MotionRecord::warnings.
struct StepRecord {
  StepReport report;
  double shape_distance = 0;  ///< see distance_from_shape, m
};

/// A warning that one or more steps gave, in texts that differ at most in their numbers.
struct WarningRecord {
  std::string first;     ///< text of its first occurrence
  Index first_step = 0;  ///< counted from 1
  Index count = 0;
};

/// All steps of a simulation so far.
struct MotionRecord {
  std::vector<StepRecord> steps;
  std::vector<Balance> balances;  ///< at the start and after each step
  std::vector<WarningRecord> warnings;
};

/// Adds a warning of a step and returns true. If the list has a warning that differs at most in its numbers,
/// increments that warning's count instead and returns false.
bool add_warning(const std::string& warning, Index step, std::vector<WarningRecord>& warnings);

/// Adds a step and its warnings, with the shape distance and balance after the step.
void add(StepReport report, double shape_distance, const Balance& balance, MotionRecord& record);

}  // namespace meshorder
