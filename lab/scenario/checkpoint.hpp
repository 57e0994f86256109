// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/motion_file.hpp"
#include "lab/scenario/simulation.hpp"

#include <filesystem>

namespace meshorder {

/// All that a simulation needs to go on: it then moves to the same bits as one that was not interrupted.
struct Checkpoint {
  Fingerprint fingerprint;  ///< of the simulation
  MotionState state;
  MotionRecord record;
};

/// Writes a checkpoint: the file appears whole or not at all. Throws Error when it cannot be written.
/// O(vertices + steps).
void write_checkpoint(const Checkpoint& checkpoint, const std::filesystem::path& path);

/// Reads one. Throws Error, with the byte, for a file that is none, was cut short or changed, or comes from a
/// machine with the other byte order; and when it is of another simulation than `expected`, naming what
/// differs.
Checkpoint read_checkpoint(const std::filesystem::path& path, const Fingerprint& expected);

}  // namespace meshorder
