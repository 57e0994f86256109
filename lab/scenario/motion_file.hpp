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

/// What a step took, and where it left the body. Its warnings are in MotionRecord::warnings.
struct StepRecord {
  StepReport report;
  double shape_distance = 0;  ///< see distance_from_shape, m
};

/// A warning that steps gave, however its numbers differed.
struct WarningRecord {
  std::string first;     ///< its words at the first time
  Index first_step = 0;  ///< counted from 1
  Index count = 0;
};

/// What happened in a simulation so far.
struct MotionRecord {
  std::vector<StepRecord> steps;
  std::vector<Balance> balances;  ///< at the start and after each step
  std::vector<WarningRecord> warnings;
};

/// Adds a warning of a step, unless one was there that differs in numbers alone, which then counts once more.
/// Returns whether it is new.
bool add_warning(const std::string& warning, Index step, std::vector<WarningRecord>& warnings);

/// Adds a step and what is true after it.
void add(StepReport report, double shape_distance, const Balance& balance, MotionRecord& record);

}  // namespace meshorder
