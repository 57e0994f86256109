// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/motion/integrator.hpp"

#include "kernels/positions.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <utility>

namespace meshorder {

void check_state(const MotionState& state, Index n) {
  if (!std::cmp_equal(state.positions.size(), n) || !std::cmp_equal(state.velocities.size(), n) ||
      state.step < 0) {
    throw InvalidArgument("a state of " + std::to_string(state.positions.size()) +
                          " vertices for a body of " + std::to_string(n));
  }
  for (Index v = 0; v < n; ++v) {
    if (!is_finite(state.positions[v]) || !is_finite(state.velocities[v])) {
      throw InvalidArgument("the state of vertex " + std::to_string(v) + " is not finite");
    }
  }
}

MotionState state_of(Index steps, double time_step, std::span<const double> positions,
                     std::span<const double> velocities) {
  const std::size_t n = velocities.size() / 3;
  MotionState state{steps, time_step * steps, std::vector<Point>(n), std::vector<Point>(n)};
  for (std::size_t v = 0; v < n; ++v) {
    state.positions[v] = point_of(positions, static_cast<Index>(v));
    std::copy_n(velocities.begin() + static_cast<Offset>(3 * v), 3, state.velocities[v].begin());
  }
  return state;
}

void take_state(const MotionState& state, std::span<double> positions, std::span<double> velocities) {
  const AlignedVector<double> padded = padded_positions(state.positions);
  std::copy(padded.begin(), padded.end(), positions.begin());
  for (std::size_t v = 0; v < state.velocities.size(); ++v)
    std::copy_n(state.velocities[v].begin(), 3, velocities.begin() + static_cast<Offset>(3 * v));
}

Balance balance_of(std::span<const double> masses, std::span<const double> positions,
                   std::span<const double> velocities, std::span<const double> momenta,
                   const Point& gravity) {
  Balance balance;
  for (Offset v = 0; std::cmp_less(v, masses.size()); ++v) {
    const double* const x = positions.data() + kPaddedStride * v;
    const double* const p = momenta.data() + 3 * v;
    for (int c = 0; c < 3; ++c) {
      const int d = (c + 1) % 3;
      const int e = (c + 2) % 3;
      balance.kinetic += 0.5 * velocities[3 * v + c] * p[c];
      balance.potential -= masses[v] * gravity[c] * x[c];
      balance.momentum[c] += p[c];
      balance.angular_momentum[c] += x[d] * p[e] - x[e] * p[d];
    }
  }
  return balance;
}

}  // namespace meshorder
