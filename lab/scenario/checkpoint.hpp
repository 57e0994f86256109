// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/motion_file.hpp"
#include "lab/scenario/simulation.hpp"

#include <filesystem>

namespace meshorder {

/// All that a simulation needs to continue: its motion is then the same, bit for bit, as without
/// interruption.
struct Checkpoint {
  Fingerprint fingerprint;  ///< of the simulation
  MotionState state;
  MotionRecord record;
};

/// Writes a checkpoint, completely or not at all. Throws Error if it cannot be written. O(vertices + steps).
void write_checkpoint(const Checkpoint& checkpoint, const std::filesystem::path& path);

/// Reads a checkpoint. Throws Error:
/// - which names the byte, for a file that is not a checkpoint, is truncated or changed, or has the other
///   byte order;
/// - which says what differs, for a checkpoint of another simulation than `expected`.
Checkpoint read_checkpoint(const FilePath& path, const Fingerprint& expected);

}  // namespace meshorder
