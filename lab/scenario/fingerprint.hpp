// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/admm/projective_dynamics.hpp"
#include "lab/implicit/backward_euler.hpp"
#include "lab/scenario/scenario.hpp"
#include "mesh/reorder.hpp"

#include <cstdint>

namespace meshorder {

/// Checksums that identify a simulation: of the mesh, of its order, and of all numbers that the motion
/// depends on, without the number of steps.
struct Fingerprint {
  std::uint64_t mesh = 0;
  std::uint64_t order = 0;
  std::uint64_t parameters = 0;

  bool operator==(const Fingerprint&) const = default;
};

// Return checksums. O(size of the arguments) each.
std::uint64_t checksum_of(const std::vector<Point>& points, const Simplices& simplices);
std::uint64_t checksum_of(const MeshOrder& order);
std::uint64_t checksum_of(const FluidOptions& options);
/// Returns the checksum of a body that starts in that state.
std::uint64_t checksum_of(const ImplicitOptions& options, const Body& body, const MotionState& start);
/// Takes obstacles and precision from `scenario`, since `options` holds the obstacles as opaque objects.
std::uint64_t checksum_of(const ProjectiveOptions& options, const ProjectiveScenario& scenario,
                          const ProjectiveBody& body, const MotionState& start);

}  // namespace meshorder
