// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "payoff/calibration.hpp"
#include "payoff/cost_model.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace meshorder {

/// A machine whose costs ship with the library.
struct ShippedMachine {
  std::string_view name;
  const CostModel& (*costs)();
};

/// Returns them. The first one's costs serve for a machine that is not calibrated.
std::span<const ShippedMachine> shipped_machines();

/// Returns " on 2 threads", nothing for one.
std::string on_threads(int threads);

/// The machine that times are predicted for.
struct MachineChoice {
  std::string name;        ///< a shipped machine's, or "this"
  CostModel model;         ///< of one thread, or of all
  std::string calibrated;  ///< "2026-11-22" if the costs were measured here; empty if they are shipped ones
  /// Shipped costs are used with the caches that this machine reports, because it is not calibrated.
  bool stands_in = false;
  /// By kernel, the share by which two times of one problem differ; 0 where not known.
  std::array<double, kKernels.size()> floor{};
  std::string fault;  ///< see StoredCalibration

  /// Returns what times are predicted for: "this machine, calibrated 2026-11-22" (perhaps "this machine on 2
  /// threads", and "while it was busy"), "zen3" or "this machine's caches at the costs of zen3".
  [[nodiscard]] std::string in_words() const;
};

/// Returns the shipped machine of a name; for "this", a calibration of this machine that was stored for this
/// build, else the first shipped machine, with this machine's caches. An empty name means
/// what the environment variable MESHORDER_MACHINE says, and "this" where it is not set. Throws
/// InvalidArgument, which names the nearest one, for unknown names.
///
/// With `all_threads` the costs are those of kernels that all threads share, which only a calibration of this
/// machine has: throws InvalidArgument for a shipped machine and where this one was calibrated on another
/// number of threads than there are now; a machine that is not calibrated gets the costs of one thread.
MachineChoice choose_machine(std::string_view name = {}, bool all_threads = false);

/// Returns what choose_machine returns for "this" where this machine is not calibrated.
MachineChoice not_calibrated();

/// Returns what choose_machine returns for a calibrated machine.
MachineChoice chosen(const Calibration& calibration, bool all_threads = false);

}  // namespace meshorder
