// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/stepper.hpp"

#include "base/memory.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "io/npy.hpp"
#include "io/stream/read_limits.hpp"
#include "lab/fluid/fluid.hpp"
#include "lab/scenario/embedded_vertices.hpp"
#include "lab/scenario/motion_file.hpp"
#include "lab/scenario/simulation.hpp"
#include "lab/scenario/vertex_choice.hpp"
#include "payoff/machine.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace meshorder {
namespace {

/// Reads an order; without a file it is the identity.
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

  StepperTimes take(const StepperTurn& turn) {
    if (!turn.frames.empty() && !frames_) {
      frames_.emplace(turn.frames, simulation_.mesh.vertex_count());
      if (!turn.surfaces.empty()) surfaces_.emplace(turn.surfaces);
      add_frame();
    }
    StepperTimes times;
    for (Index i = 0; i < turn.steps; ++i) {
      const Stopwatch stopwatch;
      const StepReport report = simulation_.body->step();
      times.step_seconds.push_back(std::round(1e7 * stopwatch.seconds()) / 1e7);
      ++step_;
      add(report, times);
      for (const std::string& warning : report.warnings) {
        if (add_warning(warning, step_, warnings_))
          times.warnings.push_back(fmt::format("step {}: {}", step_, warning));
      }
      if (frames_ && step_ % turn.frame_every == 0) add_frame();
    }
    if (frames_ && turn.last) frames_->commit();
    if (surfaces_ && turn.last) surfaces_->commit();
    return times;
  }

 private:
  static void add(const StepReport& report, StepperTimes& times) {
    times.seconds += report.seconds;
    times.cg_iterations += report.cg_iterations;
    times.admm_iterations += report.admm_iterations;
    times.contact_iterations += report.contact_iterations;
  }

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
  std::optional<SurfaceFile> surfaces_;  ///< of a fluid
};

/// Returns UTF-8 text unchanged, and the bytes of other text as numbers: a path may hold any bytes.
nlohmann::json bytes_in_json(const std::string& text) {
  if (is_utf8(text)) return text;
  auto numbers = nlohmann::json::array();
  for (const char c : text) numbers.push_back(static_cast<int>(static_cast<unsigned char>(c)));
  return numbers;
}

std::string bytes_of(const nlohmann::json& message) {
  if (message.is_string()) return message;
  std::string text;
  for (const int byte : message.get<std::vector<int>>()) text += static_cast<char>(byte);
  return text;
}

/// Returns a message in one line; bytes that are no UTF-8 become U+FFFD.
std::string line_of(const nlohmann::json& message) {
  return message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

nlohmann::json to_json(const StepperTask& task) {
  return {{"scenario", bytes_in_json(task.scenario)},
          {"mesh", bytes_in_json(task.mesh)},
          {"vertex_order", bytes_in_json(task.vertex_order)},
          {"cell_order", bytes_in_json(task.cell_order)},
          {"processors", task.processors},
          {"vertex_method", task.vertex_method},
          {"element_method", task.element_method},
          {"spacing", task.spacing}};
}

StepperTask stepper_task(const nlohmann::json& message) {
  return {bytes_of(message.at("scenario")),
          bytes_of(message.at("mesh")),
          bytes_of(message.at("vertex_order")),
          bytes_of(message.at("cell_order")),
          message.at("processors").get<std::vector<int>>(),
          message.at("vertex_method"),
          message.at("element_method"),
          message.at("spacing")};
}

nlohmann::json to_json(const StepperReady& ready) {
  return {{"vertices", ready.vertices},         {"tetrahedra", ready.tetrahedra},
          {"longest_side", ready.longest_side}, {"setup_seconds", ready.setup_seconds},
          {"step_seconds", ready.step_seconds}, {"bytes", ready.bytes},
          {"fingerprint", ready.fingerprint},   {"fixed_addresses", ready.fixed_addresses}};
}

StepperReady stepper_ready(const nlohmann::json& message) {
  return {message.at("vertices"),      message.at("tetrahedra"),     message.at("longest_side"),
          message.at("setup_seconds"), message.at("step_seconds"),   message.at("bytes"),
          message.at("fingerprint"),   message.at("fixed_addresses")};
}

nlohmann::json to_json(const StepperTurn& turn) {
  return {{"steps", turn.steps},
          {"frames", bytes_in_json(turn.frames)},
          {"frame_every", turn.frame_every},
          {"last", turn.last},
          {"surfaces", bytes_in_json(turn.surfaces)}};
}

StepperTurn stepper_turn(const nlohmann::json& message) {
  return {message.at("steps"), bytes_of(message.at("frames")), message.at("frame_every"), message.at("last"),
          bytes_of(message.at("surfaces"))};
}

nlohmann::json to_json(const StepperTimes& times) {
  const StepReport::Seconds& s = times.seconds;
  return {{"step_seconds", times.step_seconds},
          {"seconds",
           {{"total", s.total},
            {"assembly", s.assembly},
            {"solve", s.solve},
            {"local", s.local},
            {"global", s.global},
            {"collision", s.collision},
            {"triangulation", s.triangulation},
            {"order", s.order},
            {"motion", s.motion}}},
          {"cg_iterations", times.cg_iterations},
          {"admm_iterations", times.admm_iterations},
          {"contact_iterations", times.contact_iterations},
          {"warnings", times.warnings}};
}

StepperTimes stepper_times(const nlohmann::json& message) {
  const nlohmann::json& s = message.at("seconds");
  return {message.at("step_seconds").get<std::vector<double>>(),
          {s.at("total"), s.at("assembly"), s.at("solve"), s.at("local"), s.at("global"), s.at("collision"),
           s.at("triangulation"), s.at("order"), s.at("motion")},
          message.at("cg_iterations"),
          message.at("admm_iterations"),
          message.at("contact_iterations"),
          message.at("warnings").get<std::vector<std::string>>()};
}

void serve_steps(std::istream& questions, std::ostream& answers) {
  const auto answer = [&](const nlohmann::json& message) { answers << line_of(message) << std::endl; };
  try {
    std::optional<Stepping> stepping;
    for (std::string line; std::getline(questions, line);) {
      const nlohmann::json question = nlohmann::json::parse(line);
      if (stepping) {
        answer(to_json(stepping->take(stepper_turn(question))));
        continue;
      }
      const StepperTask task = stepper_task(question);
      if (!task.processors.empty() && !bind_to(task.processors))
        throw InputError("processors", "the threads cannot be bound to them", "give --no-pin");
      stepping.emplace(task);
      answer(to_json(stepping->ready()));
    }
  } catch (const std::bad_alloc&) {
    answer({{"error", "out of memory"}});
  } catch (const std::exception& error) {
    answer({{"error", error.what()}});
  }
}

namespace {

/// Returns the arguments of a child, which reads its mesh under the limits of this process.
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
  ready_ = stepper_ready(ask(to_json(task)));
}

StepperTimes Stepper::take(const StepperTurn& turn) { return stepper_times(ask(to_json(turn))); }

nlohmann::json Stepper::ask(const nlohmann::json& question) {
  process_.send(line_of(question));
  nlohmann::json answer = nlohmann::json::parse(process_.receive());
  if (answer.contains("error"))
    throw InputError(name_ + ", in its own process", answer["error"], "this run is lost");
  return answer;
}

}  // namespace meshorder
