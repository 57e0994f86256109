// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

/// What a closest rotation takes in one instruction set, ns for each matrix on one thread.
struct RotationTime {
  std::string instructions;
  double double_ns = 0.0, float_ns = 0.0;
};

/// The closest rotations of random deformation gradients, stretched and sheared by up to a half, which stand
/// in a cache: in all instruction sets of this machine, the best one first. The best of several rounds.
std::vector<RotationTime> rotation_times();
