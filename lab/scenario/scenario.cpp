// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/scenario.hpp"

#include "base/text.hpp"
#include <meshorder/error.hpp>

namespace meshorder {

Scenario find_scenario(const std::string& name_or_file) {
  for (const BuiltInScenario& scenario : built_in_scenarios()) {
    if (scenario.name == name_or_file)
      return parse_scenario(scenario.text, "scenario " + std::string(scenario.name));
  }
  std::error_code code;
  if (!std::filesystem::exists(name_or_file, code))
    throw InputError(name_or_file, "neither a scenario nor a file has this name",
                     "give " + join(built_in_scenarios(), [](const auto& scenario) {
                       return scenario.name;
                     }) + ", or a file as docs/simulate.md describes");
  return read_scenario(name_or_file);
}

}  // namespace meshorder
