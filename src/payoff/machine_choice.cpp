// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/machine_choice.hpp"

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "payoff/calibration_store.hpp"
#include "payoff/machine.hpp"
#include <meshorder/error.hpp>

#include <cstdlib>
#include <vector>

namespace meshorder {
namespace {

constexpr std::array kShipped{ShippedMachine{"zen3", zen3_costs}};
constexpr std::string_view kThis = "this";

/// Returns `name`; if it is empty, the value of MESHORDER_MACHINE; if that is empty or not set, "this".
std::string asked_name(std::string_view name) {
  if (!name.empty()) return std::string(name);
  const char* const variable = std::getenv("MESHORDER_MACHINE");
  return variable == nullptr || *variable == '\0' ? std::string(kThis) : variable;
}

}  // namespace

std::string on_threads(int threads) {
  return threads == 1 ? std::string() : " on " + std::to_string(threads) + " threads";
}

std::span<const ShippedMachine> shipped_machines() { return kShipped; }

std::string MachineChoice::in_words() const {
  if (!calibrated.empty()) return "this machine" + on_threads(model.threads) + ", calibrated " + calibrated;
  return stands_in ? "this machine's caches at the costs of " + name : name;
}

MachineChoice not_calibrated() {
  const ShippedMachine& machine = kShipped.front();
  MachineChoice choice{std::string(machine.name), machine.costs(), {}, true, {}, {}};
  choice.model.caches = caches_of_this_machine();
  return choice;
}

MachineChoice choose_machine(std::string_view name, bool all_threads) {
  const std::string asked = asked_name(name);
  MachineChoice choice;
  if (asked == kThis) {
    StoredCalibration stored = load_calibration(key_of_this_machine());
    if (stored.calibration) return chosen(*stored.calibration, all_threads);
    choice = not_calibrated();
    choice.fault = stored.fault;
    return choice;
  }
  for (const ShippedMachine& machine : kShipped) {
    if (machine.name != asked) continue;
    if (all_threads && thread_count() > 1) {
      throw InvalidArgument(
          "the costs of '" + asked +
          "' are those of one thread; calibrate this machine to predict for all its threads");
    }
    choice.name = asked;
    choice.model = machine.costs();
    return choice;
  }
  std::vector<std::string> names{std::string(kThis)};
  for (const ShippedMachine& machine : kShipped) names.emplace_back(machine.name);
  throw InvalidArgument(unknown_in_words("machine", asked, names));
}

MachineChoice chosen(const Calibration& calibration, bool all_threads) {
  if (all_threads && calibration.threads != thread_count()) {
    throw InvalidArgument("this machine was calibrated on " + std::to_string(calibration.threads) +
                          " threads, and now there are " + std::to_string(thread_count()) +
                          "; `meshorder calibrate` measures it again");
  }
  const bool steady = reason_to_doubt(calibration.steadiness).empty();
  const std::string calibrated = calibration.date + (steady ? "" : " while it was busy");
  return {std::string(kThis),
          all_threads ? calibration.all_threads : calibration.model,
          calibrated,
          false,
          (all_threads ? calibration.all_threads_quality : calibration.quality).floor,
          {}};
}

}  // namespace meshorder
