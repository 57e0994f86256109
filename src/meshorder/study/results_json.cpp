// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/study/results_json.hpp>

#include <nlohmann/json.hpp>

namespace meshorder {

nlohmann::ordered_json to_json(const StudyResults& /*results*/) { return {}; }
nlohmann::ordered_json to_json(const MachineRecord& /*machine*/) { return {}; }
nlohmann::ordered_json to_json(const MeshRecord& /*mesh*/) { return {}; }
nlohmann::ordered_json to_json(const ScenarioRecord& /*scenario*/) { return {}; }
void write_results(const StudyResults& /*results*/, const std::filesystem::path& /*path*/) {}
StudyResults read_results(const std::filesystem::path& /*path*/) { return {}; }
MachineRecord parse_machine(std::string_view /*text*/, const std::string& /*file*/) { return {}; }
MeshRecord parse_mesh_record(std::string_view /*text*/, const std::string& /*file*/) { return {}; }
ScenarioRecord parse_scenario_record(std::string_view /*text*/, const std::string& /*file*/) { return {}; }

}  // namespace meshorder
