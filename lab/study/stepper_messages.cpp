// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/stepper_messages.hpp"

#include <nlohmann/json.hpp>

namespace meshorder {

using nlohmann::json;

json to_json(const StepperTask& task) {
  return {{"scenario", task.scenario},
          {"mesh", task.mesh},
          {"vertex_order", task.vertex_order},
          {"cell_order", task.cell_order},
          {"processors", task.processors}};
}

StepperTask stepper_task(const json& message) {
  return {message.at("scenario"), message.at("mesh"), message.at("vertex_order"), message.at("cell_order"),
          message.at("processors").get<std::vector<int>>()};
}

json to_json(const StepperReady& ready) {
  return {{"vertices", ready.vertices},         {"tetrahedra", ready.tetrahedra},
          {"longest_side", ready.longest_side}, {"setup_seconds", ready.setup_seconds},
          {"step_seconds", ready.step_seconds}, {"bytes", ready.bytes},
          {"fingerprint", ready.fingerprint},   {"fixed_addresses", ready.fixed_addresses}};
}

StepperReady stepper_ready(const json& message) {
  return {message.at("vertices"),      message.at("tetrahedra"),     message.at("longest_side"),
          message.at("setup_seconds"), message.at("step_seconds"),   message.at("bytes"),
          message.at("fingerprint"),   message.at("fixed_addresses")};
}

json to_json(const StepperTurn& turn) {
  return {
      {"steps", turn.steps}, {"frames", turn.frames}, {"frame_every", turn.frame_every}, {"last", turn.last}};
}

StepperTurn stepper_turn(const json& message) {
  return {message.at("steps"), message.at("frames"), message.at("frame_every"), message.at("last")};
}

json to_json(const StepperTimes& times) {
  const StepReport::Seconds& s = times.seconds;
  return {{"step_seconds", times.step_seconds},
          {"seconds",
           {{"total", s.total},
            {"assembly", s.assembly},
            {"solve", s.solve},
            {"local", s.local},
            {"global", s.global},
            {"collision", s.collision}}},
          {"cg_iterations", times.cg_iterations},
          {"admm_iterations", times.admm_iterations},
          {"contact_iterations", times.contact_iterations},
          {"warnings", times.warnings}};
}

StepperTimes stepper_times(const json& message) {
  const json& s = message.at("seconds");
  return {message.at("step_seconds").get<std::vector<double>>(),
          {s.at("total"), s.at("assembly"), s.at("solve"), s.at("local"), s.at("global"), s.at("collision")},
          message.at("cg_iterations"),
          message.at("admm_iterations"),
          message.at("contact_iterations"),
          message.at("warnings").get<std::vector<std::string>>()};
}

}  // namespace meshorder
