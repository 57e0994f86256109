// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/admm/projective_dynamics.hpp"
#include "lab/implicit/backward_euler.hpp"
#include "lab/scenario/scenario.hpp"
#include "mesh/reorder.hpp"

#include <cstdint>

namespace meshorder {

/// Tells whether two simulations are the same: checksums of the mesh, of its order and of all numbers that
/// the motion depends on. Not of how many steps are done.
struct Fingerprint {
  std::uint64_t mesh = 0;
  std::uint64_t order = 0;
  std::uint64_t parameters = 0;

  bool operator==(const Fingerprint&) const = default;
};

// The parts of it, O(size of what is given) each.
std::uint64_t checksum_of(const std::vector<Point>& points, const Simplices& simplices);
std::uint64_t checksum_of(const Reordering& order);
/// Of a body whose vertices start in that state.
std::uint64_t checksum_of(const ImplicitOptions& options, const Body& body, const MotionState& start);
/// Obstacles and precision are taken from `scenario`, since the options do not tell what they are.
std::uint64_t checksum_of(const ProjectiveOptions& options, const ProjectiveScenario& scenario,
                          const ProjectiveBody& body, const MotionState& start);

}  // namespace meshorder
