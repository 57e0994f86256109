// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Sums for a line fitted through the times of steps. k: the number of updates since the last new order; t:
/// the time of a step.
struct Observed {
  double count = 0;
  double k = 0;
  double kk = 0;
  double t = 0;
  double kt = 0;

  void add(double number, double seconds) {
    ++count;
    k += number;
    kk += number * number;
    t += seconds;
    kt += number * seconds;
  }
  /// Returns by how much the time of a step grows with each update; 0 if that is not known.
  [[nodiscard]] double slope() const {
    constexpr double kFewest = 5;
    const double spread = count * kk - k * k;
    return count >= kFewest && spread > 0 ? (count * kt - k * t) / spread : 0;
  }
};

inline constexpr Index kMostInterval = 1 << 20;  ///< largest number of updates from one new order to the next

/// The data that a `Reorderer` keeps from update to update.
struct ReordererState {
  std::uint8_t begun = 0;
  Index count = 0;      ///< vertices of the last update
  Index since = 0;      ///< updates since the last new order
  Index interval = 10;  ///< number of updates after which another new order is computed
  double fresh_span = 0;
  double fresh_seconds = 0;  ///< cost of the last order without a start vector; 0: none
  double warm_seconds = 0;   ///< cost of the last order with a start vector; 0: none
  Observed observed;
  std::string method;          ///< method of later orders; "auto" if the first order was no better
  std::vector<double> vector;  ///< start for the next Fiedler vector, indexed by place after the last update
};

/// Returns the state as bytes, with a mark and a checksum, in the byte order of this machine.
std::vector<std::byte> to_bytes(const ReordererState& state);

/// Returns the state that such bytes hold. Throws InvalidArgument if they are cut off, damaged or no state.
ReordererState reorderer_state(std::span<const std::byte> bytes);

}  // namespace meshorder
