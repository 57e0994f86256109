// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"

#include <memory>
#include <string>
#include <vector>

namespace meshorder {

/// A tetrahedral mesh after a step, numbered by the trace.
struct TraceStep {
  std::vector<Point> points = {};
  std::vector<Index> corners = {};  ///< 4 of each tetrahedron
  /// The number of each point in the previous step; −1 for a new point. Empty: the same numbers.
  std::vector<Index> previous = {};
  /// For each point of the previous step, the number of the point that a program now stores in that place;
  /// −1: the point is removed, and those after it move up. Empty: the same numbers. New points are last.
  std::vector<Index> successors = {};
};

/// A mesh that changes in the same way on every run.
class Trace {
 public:
  Trace() = default;
  virtual ~Trace() = default;
  Trace(const Trace&) = delete;
  Trace(Trace&&) = delete;
  Trace& operator=(const Trace&) = delete;
  Trace& operator=(Trace&&) = delete;

  /// Returns the next step; the first one has no `previous`.
  virtual TraceStep next() = 0;
};

/// Returns a trace of about `count` points:
/// stir    points of a jittered lattice turn in rolls, at most 0.3 spacings a step
/// churn   the same, and in each step 2 % of the points vanish and are replaced by points elsewhere
/// refine  a ball travels, which adds eight points for each point of the lattice
/// cut     the tetrahedra along a plane are removed, a few in each step
/// dam     a dam break, the scenario `splash`
/// Throws std::invalid_argument for other names.
std::unique_ptr<Trace> make_trace(const std::string& name, Index count, Index steps);

}  // namespace meshorder
