// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

/// The time of a closest rotation in one instruction set, ns for each matrix on one thread.
struct RotationTime {
  std::string instructions;
  double double_ns = 0.0, float_ns = 0.0;
};

/// Times the closest rotations of random deformation gradients in a cache, stretched and sheared by up to a
/// half, in all instruction sets of this machine, the best one first. The best of several rounds.
std::vector<RotationTime> rotation_times();
