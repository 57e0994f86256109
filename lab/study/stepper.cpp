// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/stepper.hpp"

#include "base/memory.hpp"
#include "base/stopwatch.hpp"
#include "io/npy.hpp"
#include "io/stream/read_limits.hpp"
#include "lab/fluid/fluid.hpp"
#include "lab/scenario/embedded_vertices.hpp"
#include "lab/scenario/motion_file.hpp"
#include "lab/scenario/simulation.hpp"
#include "lab/scenario/vertex_choice.hpp"
#include "lab/support/machine.hpp"
#include "payoff/machine.hpp"
#include "payoff/steadiness.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace meshorder {
namespace {

/// Reads an order; returns the identity for an empty path.
Permutation order_of(const std::string& path, Index count, const std::string& what) {
  if (path.empty()) return Permutation::identity(count);
  return read_permutation(FilePath::derived(path), count, what);
}

Simulation set_up(const StepperTask& task) {
  Scenario scenario = find_scenario(task.scenario);
  if (scenario.is_fluid()) {
    scenario.vertex_order = task.vertex_method;
    scenario.element_order = task.element_method;
    scenario.fluid().order_every = task.vertex_method == "auto" ? 0 : 1;
    scenario.fluid().spacing = task.spacing;
    return set_up_fluid(std::move(scenario));
  }
  if (task.mesh != scenario.mesh) scenario.mesh_folder.reset();
  Mesh mesh = read_mesh_from(scenario.mesh_file(task.mesh));
  MeshOrder order;
  order.vertices.permutation = order_of(task.vertex_order, mesh.vertex_count(), "vertices");
  order.cells.permutation = order_of(task.cell_order, mesh.cells.size(), "cells");
  return set_up(std::move(scenario), std::move(mesh), task.mesh, std::move(order));
}

/// Returns the positions in the mesh's own order.
std::vector<Point> in_own_order(const MotionState& state, const Permutation& vertices) {
  std::vector<Point> points(state.positions.size());
  for (std::size_t v = 0; v < points.size(); ++v) points[v] = state.positions[vertices.old_to_new()[v]];
  return points;
}

/// A simulation that runs turn by turn.
class Stepping {
 public:
  explicit Stepping(const StepperTask& task)
      : simulation_(set_up(task)),
        embedded_(embed_vertices(simulation_.mesh, cut_into_simplices(simulation_.mesh))) {
    ready_.vertices = simulation_.mesh.vertex_count();
    ready_.tetrahedra = simulation_.tetrahedra;
    ready_.longest_side = bounding_box(simulation_.mesh.points, simulation_.vertices).longest_side();
    ready_.setup_seconds = simulation_.setup_seconds;
    ready_.bytes = static_cast<Offset>(simulation_.body->bytes());
    ready_.fingerprint =
        fmt::format("{:016x}{:016x}", simulation_.fingerprint.mesh, simulation_.fingerprint.parameters);
    ready_.fixed_addresses = has_fixed_addresses();
    const MotionState start = simulation_.body->state();
    const Stopwatch warming_up;
    simulation_.body->step();
    ready_.step_seconds = warming_up.seconds();
    simulation_.body->set_state(start);
  }

  [[nodiscard]] const StepperReady& ready() const noexcept { return ready_; }

  RunRecord take(const StepperTurn& turn) {
    if (!turn.frames.empty() && !frames_) {
      frames_.emplace(turn.frames, simulation_.mesh.vertex_count());
      if (!turn.surfaces.empty()) surfaces_.emplace(turn.surfaces);
      add_frame();
    }
    RunRecord run;
    run.pace_seconds.push_back(pace_seconds());
    const double others_before = seconds_of_others();
    for (Index i = 0; i < turn.steps; ++i) {
      const Stopwatch stopwatch;
      const StepReport report = simulation_.body->step();
      run.step_seconds.push_back(std::round(1e7 * stopwatch.seconds()) / 1e7);
      ++step_;
      run.seconds += report.seconds;
      run.cg_iterations += report.cg_iterations;
      run.admm_iterations += report.admm_iterations;
      run.contact_iterations += report.contact_iterations;
      for (const std::string& warning : report.warnings) {
        if (add_warning(warning, step_, warnings_))
          run.warnings.push_back(fmt::format("step {}: {}", step_, warning));
      }
      if (frames_ && step_ % turn.frame_every == 0) add_frame();
    }
    run.other_seconds = std::max(0.0, seconds_of_others() - others_before);
    if (frames_ && turn.last) frames_->commit();
    if (surfaces_ && turn.last) surfaces_->commit();
    return run;
  }

 private:
  void add_frame() {
    MotionState state = simulation_.body->state();
    move_embedded(embedded_, simulation_.mesh.points, state);
    frames_->add(in_own_order(state, simulation_.order.vertices.permutation));
    if (surfaces_) add_surface(dynamic_cast<const Fluid&>(*simulation_.body));
  }

  void add_surface(const Fluid& fluid) {
    std::vector<std::array<Index, 3>> triangles = outer_faces(fluid.mesh());
    for (std::array<Index, 3>& triangle : triangles) {
      for (Index& v : triangle) v = fluid.numbers()[v];
    }
    surfaces_->add(triangles);
  }

  Simulation simulation_;
  std::vector<EmbeddedVertex> embedded_;
  StepperReady ready_;
  Index step_ = 0;
  std::vector<WarningRecord> warnings_;
  std::optional<MotionFile> frames_;
  std::optional<SurfaceFile> surfaces_;  ///< only for a fluid
};

/// Returns a message as one line; bytes that are not UTF-8 become U+FFFD.
std::string line_of(const nlohmann::json& message) {
  return message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

void serve_steps(std::istream& questions, std::ostream& answers) {
  const auto answer = [&](const nlohmann::json& message) { answers << line_of(message) << std::endl; };
  try {
    std::optional<Stepping> stepping;
    for (std::string line; std::getline(questions, line);) {
      const nlohmann::json question = nlohmann::json::parse(line);
      if (stepping) {
        answer(message_of(stepping->take(read_message<StepperTurn>(question))));
        continue;
      }
      const auto task = read_message<StepperTask>(question);
      if (!task.processors.empty() && !bind_to(task.processors))
        throw InputError("processors", "the threads cannot be bound to them", "give --no-pin");
      stepping.emplace(task);
      answer(message_of(stepping->ready()));
    }
  } catch (const std::bad_alloc&) {
    answer({{"error", "out of memory"}});
  } catch (const std::exception& error) {
    answer({{"error", error.what()}});
  }
}

namespace {

/// Returns the child's arguments, with this process's limits for reading a mesh.
std::vector<std::string> arguments_for(int threads) {
  std::vector<std::string> arguments{"serve-steps", "--threads", std::to_string(threads)};
  if (const MemoryLimit limit = memory_limit(); limit.is_given) {
    const bool none = limit.bytes == UINT64_MAX;
    arguments.insert(arguments.end(), {"--limit-memory", none ? "none" : std::to_string(limit.bytes)});
  }
  for (const std::filesystem::path& folder : allowed_include_folders()) {
    arguments.insert(arguments.end(), {"--allow-includes-from", folder.string()});
  }
  return arguments;
}

}  // namespace

Stepper::Stepper(const std::filesystem::path& program, int threads, const StepperTask& task)
    : name_(task.scenario), process_(program, arguments_for(threads), true) {
  ready_ = read_message<StepperReady>(ask(message_of(task)));
}

RunRecord Stepper::take(const StepperTurn& turn) { return read_message<RunRecord>(ask(message_of(turn))); }

nlohmann::json Stepper::ask(const nlohmann::json& question) {
  process_.send(line_of(question));
  nlohmann::json answer = nlohmann::json::parse(process_.receive());
  if (answer.contains("error"))
    throw InputError(name_ + ", in its own process", answer["error"], "this run is lost");
  return answer;
}

}  // namespace meshorder
