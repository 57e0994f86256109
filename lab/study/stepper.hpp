// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/text.hpp"
#include "lab/study/results_fields.hpp"
#include "lab/support/process.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <istream>
#include <ostream>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace meshorder {

// The messages between a study and the processes that simulate for it, one JSON object on each line. The
// process answers each question, or answers {"error": …} and ends.

/// What to simulate.
struct StepperTask {
  std::string scenario = {};         ///< a name or a file
  std::string mesh = {};             ///< a mesh file; need not be the scenario's own
  std::string vertex_order = {};     ///< file of the NumPy array old_to_new; empty: the mesh's own order
  std::string cell_order = {};       ///< the same for cells
  std::vector<int> processors = {};  ///< to bind the process to; empty: not bound
  // only for a fluid, which has no mesh file and no order files
  std::string vertex_method = {};   ///< "auto": a Reorderer decides when to order; others: see FluidOrdering
  std::string element_method = {};  ///< method that orders the tetrahedra in each step
  double spacing = 0;               ///< of the particles, m
};

/// The answer to a StepperTask: describes the body that is ready to be simulated.
struct StepperReady {
  Index vertices = 0;
  Offset tetrahedra = 0;
  double longest_side = 0;  ///< of the box around the body at rest, m
  double setup_seconds = 0;
  double step_seconds = 0;       ///< of the warm-up step, which is undone
  Offset bytes = 0;              ///< memory of the body
  std::string fingerprint;       ///< checksums: of the mesh, of the parameters as reordered
  bool fixed_addresses = false;  ///< address space randomisation is off
};

/// A request for steps.
struct StepperTurn {
  Index steps = 0;
  std::string frames;         ///< file for the motion, in the mesh's own order; empty: no frames
  Index frame_every = 1;      ///< steps from one frame to the next; the first frame is at the start
  bool last = false;          ///< the last turn: completes the files
  std::string surfaces = {};  ///< file for a fluid's surface in each frame; empty: none
};

template <>
inline constexpr auto kFields<StepperTask> = std::tuple{Field{"scenario", &StepperTask::scenario},
                                                        Field{"mesh", &StepperTask::mesh},
                                                        Field{"vertex_order", &StepperTask::vertex_order},
                                                        Field{"cell_order", &StepperTask::cell_order},
                                                        Field{"processors", &StepperTask::processors},
                                                        Field{"vertex_method", &StepperTask::vertex_method},
                                                        Field{"element_method", &StepperTask::element_method},
                                                        Field{"spacing", &StepperTask::spacing}};

template <>
inline constexpr auto kFields<StepperReady> =
    std::tuple{Field{"vertices", &StepperReady::vertices},
               Field{"tetrahedra", &StepperReady::tetrahedra},
               Field{"longest_side", &StepperReady::longest_side},
               Field{"setup_seconds", &StepperReady::setup_seconds},
               Field{"step_seconds", &StepperReady::step_seconds},
               Field{"bytes", &StepperReady::bytes},
               Field{"fingerprint", &StepperReady::fingerprint},
               Field{"fixed_addresses", &StepperReady::fixed_addresses}};

template <>
inline constexpr auto kFields<StepperTurn> =
    std::tuple{Field{"steps", &StepperTurn::steps}, Field{"frames", &StepperTurn::frames},
               Field{"frame_every", &StepperTurn::frame_every}, Field{"last", &StepperTurn::last},
               Field{"surfaces", &StepperTurn::surfaces}};

/// Returns a record as an object with its kFields. UTF-8 text stays text; the bytes of other text become
/// numbers, since a path may hold any bytes.
template <class Value>
nlohmann::json message_of(const Value& value) {
  if constexpr (Described<Value>) {
    auto message = nlohmann::json::object();
    const auto put = [&](const auto&... field) {
      ((message[std::string(field.key)] = message_of(value.*field.member)), ...);
    };
    std::apply(put, kFields<Value>);
    return message;
  } else {
    if constexpr (std::is_same_v<Value, std::string>) {
      if (!is_utf8(value)) return std::vector<unsigned char>(value.begin(), value.end());
    }
    return value;
  }
}

/// Returns the value that `message_of` wrote. Throws nlohmann::json::exception for another message.
template <class Value>
Value read_message(const nlohmann::json& message) {
  if constexpr (Described<Value>) {
    Value value;
    const auto take = [&](const auto&... field) {
      ((value.*field.member =
            read_message<std::decay_t<decltype(value.*field.member)>>(message.at(std::string(field.key)))),
       ...);
    };
    std::apply(take, kFields<Value>);
    return value;
  } else {
    if constexpr (std::is_same_v<Value, std::string>) {
      if (message.is_array()) {
        const auto bytes = message.get<std::vector<unsigned char>>();
        return {bytes.begin(), bytes.end()};
      }
    }
    return message.get<Value>();
  }
}

/// Serves a study over a pair of streams: reads a StepperTask, sets up the body, runs a warm-up step and
/// undoes it; then simulates and times turn after turn until the input ends. The last answer may be an error.
void serve_steps(std::istream& questions, std::ostream& answers);

/// A simulation in a new process. Where the system allows it, the process has no address space randomisation.
class Stepper {
 public:
  /// Starts `program`, which is meshorder-lab, and waits until the body is ready. Throws Error with the
  /// process's message.
  Stepper(const std::filesystem::path& program, int threads, const StepperTask& task);

  [[nodiscard]] const StepperReady& ready() const noexcept { return ready_; }

  /// Runs the steps of a turn and waits for them. The record has no values for `began`, `setup_seconds` and
  /// `bytes`. Throws Error with the process's message.
  RunRecord take(const StepperTurn& turn);

 private:
  nlohmann::json ask(const nlohmann::json& question);

  std::string name_;
  ChildProcess process_;
  StepperReady ready_;
};

}  // namespace meshorder
