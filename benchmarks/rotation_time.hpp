// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

/// The time to find the rotation closest to a matrix, in one instruction set on one thread, in ns.
struct RotationTime {
  std::string instructions;
  double double_ns = 0.0, float_ns = 0.0;
};

/// Times the closest rotations of random deformation gradients, which are stretched and sheared by up to a
/// half and fit in a cache. Returns the best of several rounds for each instruction set of this machine, the
/// best instruction set first.
std::vector<RotationTime> rotation_times();
