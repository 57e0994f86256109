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

/// Returns the shipped machines. The costs of the first one are used for a machine that is not calibrated.
std::span<const ShippedMachine> shipped_machines();

/// Returns a text such as " on 2 threads"; an empty text for one thread.
std::string on_threads(int threads);

/// The machine that times are predicted for.
struct MachineChoice {
  std::string name;        ///< name of a shipped machine, or "this"
  CostModel model;         ///< costs on one thread, or on all
  std::string calibrated;  ///< date ("2026-11-22") if the costs were measured here, else empty
  /// True if this machine is not calibrated: `model` has shipped costs with this machine's reported caches.
  bool stands_in = false;
  /// By kernel, the relative difference of two timings of one problem; 0 if not known.
  std::array<double, kKernels.size()> floor{};
  std::string fault;  ///< see StoredCalibration

  /// Returns what predictions are for: "this machine, calibrated 2026-11-22" (or "this machine on 2 threads,
  /// …", "… while it was busy"), "zen3" or "this machine's caches at the costs of zen3".
  [[nodiscard]] std::string in_words() const;
};

/// Returns the shipped machine of that name. For "this", returns the stored calibration of this machine and
/// build, or not_calibrated() if there is none. An empty name means the value of the environment variable
/// MESHORDER_MACHINE, or "this" if it is not set. Throws InvalidArgument for an unknown name; the message
/// suggests the nearest one.
///
/// With `all_threads` the costs are those of kernels that all threads share. Only a calibration has such
/// costs: throws InvalidArgument for a shipped machine on more than one thread, and if this machine was
/// calibrated on another number of threads than there are now. Without a calibration, the costs are those of
/// one thread.
MachineChoice choose_machine(std::string_view name = {}, bool all_threads = false);

/// Returns the result of choose_machine("this") on a machine that is not calibrated.
MachineChoice not_calibrated();

/// Returns the result of choose_machine("this") on a machine with this calibration.
MachineChoice chosen(const Calibration& calibration, bool all_threads = false);

}  // namespace meshorder
