// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/admm/anderson.hpp"

#include <limits>
#include <span>
#include <vector>

namespace meshorder {

/// Anderson acceleration of ADMM, whose iterates are positions and duals, watched as Zhang, Peng, Ouyang and
/// Deng (2019) do: where a mixed iterate turns out to have a larger residual than the one before, the
/// iteration goes back to what that one was mapped to, and starts to collect anew.
template <class Real>
class AcceleratedIteration {
 public:
  /// `window`: earlier iterates that are mixed, 1 … 10.
  explicit AcceleratedIteration(int window) : mixer_(window) {}

  /// Forgets what it has seen.
  void reset();

  /// Keeps the iterate, which an iteration is about to change.
  void begin(std::span<const Real> positions, std::vector<Real> duals);

  /// Makes the next iterate of what the iteration made of the last one. What is not finite stays as it is.
  void finish(std::span<Real> positions, std::span<Real> duals);

  /// Memory held.
  [[nodiscard]] std::size_t bytes() const;

 private:
  AndersonMixer<Real> mixer_;
  double last_residual_ = std::numeric_limits<double>::infinity();
  std::vector<Real> positions_, duals_;                ///< the iterate
  std::vector<Real> mapped_positions_, mapped_duals_;  ///< what the last good one was mapped to
};

}  // namespace meshorder
