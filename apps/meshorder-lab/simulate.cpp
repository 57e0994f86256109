// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/stopwatch.hpp"
#include "command.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "interruption.hpp"
#include "io/stream/output_file.hpp"
#include "lab.hpp"
#include "lab/models/catalogue.hpp"
#include "lab/scenario/checkpoint.hpp"
#include "lab/scenario/frames.hpp"
#include "lab/scenario/motion_metrics.hpp"
#include "lab/scenario/simulation.hpp"
#include "progress.hpp"
#include "simulate_report.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace meshorder::command {
namespace {

struct SimulateArguments : Common {
  bool list = false;
  std::string scenario;
  // the following options replace values of the scenario
  std::string mesh;
  std::string order;
  std::string vertices;
  std::string elements;
  std::string preconditioner;
  std::string precision;
  Index steps = 0;
  std::optional<Index> order_every;
  OrderOptions ordering;

  std::string frames;
  Index every = 1;
  std::string checkpoint;
  Index checkpoint_every = 10;
  std::string resume;
};

void list_scenarios(const Console& console) {
  auto scenarios = nlohmann::ordered_json::array();
  for (const BuiltInScenario& built_in : built_in_scenarios()) {
    const Scenario scenario = find_scenario(std::string(built_in.name));
    console.print_list("  {:<14} {}", scenario.name, scenario.title);
    scenarios.push_back(
        {{"name", scenario.name}, {"title", scenario.title}, {"mesh", or_null(scenario.mesh)}});
  }
  console.print_json({{"scenarios", scenarios}});
}

/// Throws InvalidArgument for options that do not apply to a fluid.
void refuse_for_fluids(const SimulateArguments& arguments) {
  for (const auto& [name, value] :
       {std::pair("--mesh", &arguments.mesh), std::pair("--preconditioner", &arguments.preconditioner),
        std::pair("--precision", &arguments.precision)}) {
    if (!value->empty())
      throw InvalidArgument(std::string(name) + " is for elastic bodies; a fluid makes its own mesh and " +
                            "solves in double precision");
  }
}

/// Returns the scenario with its values replaced by those of the command line.
Scenario scenario_of(const SimulateArguments& arguments) {
  Scenario scenario = find_scenario(arguments.scenario);
  if (scenario.is_fluid()) refuse_for_fluids(arguments);
  if (!arguments.mesh.empty()) {
    scenario.mesh = arguments.mesh;
    scenario.mesh_folder.reset();
  }
  if (!arguments.order.empty()) {
    MeshMethods order = order_named(arguments.order);
    scenario.vertex_order = std::move(order.vertices);
    scenario.element_order = std::move(order.elements);
    // a fluid's tetrahedra are sorted in each step, so `auto` has to choose a method that pays at once
    if (scenario.is_fluid() && arguments.order.find('/') == std::string::npos)
      scenario.element_order = "auto";
  }
  if (!arguments.vertices.empty()) scenario.vertex_order = arguments.vertices;
  if (!arguments.elements.empty()) scenario.element_order = arguments.elements;
  if (arguments.steps > 0) scenario.steps = arguments.steps;
  if (arguments.order_every) {
    if (!scenario.is_fluid())
      throw InvalidArgument("--order-every is for fluids; the mesh of " + scenario.name + " never changes");
    scenario.fluid().order_every = *arguments.order_every;
  }
  if (!arguments.preconditioner.empty()) {
    if (!scenario.is_implicit())
      throw InvalidArgument("--preconditioner is for backward Euler; " + scenario.name +
                            " is solved by ADMM, which factors its matrix once");
    scenario.implicit().preconditioner = parse<PreconditionerKind>(arguments.preconditioner);
  }
  if (!arguments.precision.empty()) {
    const auto precision = parse<MatrixPrecision>(arguments.precision);
    if (scenario.is_implicit()) {
      scenario.implicit().precision = precision;
    } else {
      scenario.projective().precision = precision;
    }
  }
  return scenario;
}

/// Returns the path of the scenario's mesh. Makes the mesh first if it is a model that does not exist yet.
std::string mesh_path(const Scenario& scenario, Progress& progress) {
  if (!names_a_model(scenario.mesh)) return scenario.mesh;
  MakeOptions options;
  options.progress = [&](std::string_view step, double) {
    progress.stage("model " + scenario.mesh + ": " + std::string(step), 0, 0.5);
  };
  return make_model(scenario.mesh, options).path.string();
}

/// Simulates to the end of the scenario, and writes frames and checkpoints when they are due.
class Run {
 public:
  Run(const SimulateArguments& arguments, Simulation& simulation)
      : arguments_(arguments), simulation_(simulation) {
    if (!arguments.resume.empty()) {
      Checkpoint checkpoint = read_checkpoint(arguments.resume, simulation.fingerprint);
      try {
        simulation.body->set_state(checkpoint.state);
      } catch (const InvalidArgument& error) {
        throw InputError(arguments.resume, error.what(), "it was changed");
      }
      record_ = std::move(checkpoint.record);
      resumed_from_ = checkpoint.state.step;
      if (resumed_from_ > simulation.scenario.steps) {
        throw InputError(arguments.resume, fmt::format("is already at step {}", resumed_from_),
                         fmt::format("give more --steps than {}", simulation.scenario.steps));
      }
    }
    if (record_.balances.empty()) record_.balances.push_back(simulation.body->balance());
    if (!arguments.checkpoint.empty()) (void)OutputFile(arguments.checkpoint);
    if (arguments.frames.empty()) return;
    frames_.emplace(simulation, arguments.frames, arguments.every);
    if (arguments.resume.empty()) {
      frames_->write(simulation.body->state());
    } else {
      frames_->resume_after(record_);
    }
  }

  void to_the_end(const Console& console) {
    std::optional<Interruption> interruption;
    if (!arguments_.checkpoint.empty()) interruption.emplace();
    Progress progress(!console.quiet());
    const Index last = simulation_.scenario.steps;
    if (interruption && resumed_from_ == last) keep(simulation_.body->state());
    const double share = 1.0 / std::max(1, last - resumed_from_);
    for (Index step = resumed_from_ + 1; step <= last; ++step) {
      const double from = share * (step - resumed_from_ - 1);
      progress.stage(fmt::format("step {} of {}", step, last), from, from + share);
      StepReport report = simulation_.body->step();
      const MotionState state = simulation_.body->state();
      const double distance =
          simulation_.scenario.is_fluid()
              ? 0
              : distance_from_shape(simulation_.mesh.points, state.positions, simulation_.vertices);
      add(std::move(report), distance, simulation_.body->balance(), record_);
      if (frames_ && frames_->is_due(step)) frames_->write(state);
      const bool interrupted = interruption && Interruption::signal() != 0;
      if (interruption && (step == last || interrupted || step % arguments_.checkpoint_every == 0))
        keep(state);
      if (interrupted && step < last) {
        progress.finish();
        throw CommandError(fmt::format("stopped after step {} of {}; --resume {} continues from there", step,
                                       last, arguments_.checkpoint),
                           128 + Interruption::signal());
      }
    }
  }

  [[nodiscard]] const MotionRecord& record() const noexcept { return record_; }
  [[nodiscard]] Index resumed_from() const noexcept { return resumed_from_; }
  [[nodiscard]] const FrameWriter* frames() const noexcept { return frames_ ? &*frames_ : nullptr; }

 private:
  void keep(const MotionState& state) const {
    write_checkpoint({simulation_.fingerprint, state, record_}, arguments_.checkpoint);
  }

  const SimulateArguments& arguments_;
  Simulation& simulation_;
  MotionRecord record_;
  Index resumed_from_ = 0;
  std::optional<FrameWriter> frames_;
};

void run(const SimulateArguments& arguments) {
  Console console(arguments);
  if (arguments.list) return list_scenarios(console);
  if (arguments.scenario.empty())
    throw InvalidArgument("give the name or the file of a scenario; --list shows the names");
  Scenario scenario = scenario_of(arguments);

  // a fluid reads no file that a library parses
  if (!scenario.is_fluid() && !names_a_model(scenario.mesh)) {
    Files files{.meshes = {scenario.mesh}, .others = {arguments.resume}, .outputs = {arguments.checkpoint}};
    if (!arguments.frames.empty()) files.folders.push_back(arguments.frames);
    confine(files);
  }
  Progress progress(!console.quiet());
  std::string path;  // stays empty for a fluid
  double read_seconds = 0;
  Notes notes;
  Simulation simulation;
  if (scenario.is_fluid()) {
    progress.stage("setting up", 0, 1);
    simulation = set_up_fluid(std::move(scenario), arguments.ordering);
  } else {
    path = mesh_path(scenario, progress);
    progress.stage("reading " + path, 0.5, 0.7);
    const Stopwatch reading;
    Mesh mesh = read_input(scenario.mesh_file(path), notes);
    read_seconds = reading.seconds();
    progress.stage("setting up", 0.7, 1);
    simulation = set_up(std::move(scenario), std::move(mesh), path, arguments.ordering);
  }
  Run steps(arguments, simulation);
  progress.finish();

  notes.insert(notes.end(), simulation.notes.begin(), simulation.notes.end());
  if (steps.frames() != nullptr)
    notes.insert(notes.end(), steps.frames()->notes().begin(), steps.frames()->notes().end());
  console.warn_of(notes);
  print_header(console, simulation, path);
  if (steps.resumed_from() > 0)
    console.print("{:<10} after step {}, from {}", "resumed", steps.resumed_from(), arguments.resume);
  steps.to_the_end(console);

  print_summary(console, simulation, steps.record());
  if (steps.frames() != nullptr) console.print("{:<10} {}", "frames", steps.frames()->collection().string());
  if (!arguments.checkpoint.empty()) console.print("{:<10} {}", "checkpoint", arguments.checkpoint);
  nlohmann::ordered_json result = to_json(simulation, steps.record());
  result["mesh"] = or_null(path);
  result["setup_seconds"]["read"] = read_seconds;
  result["resumed_from"] = arguments.resume.empty() ? nlohmann::ordered_json(nullptr)
                                                    : nlohmann::ordered_json(steps.resumed_from());
  result["frames"] = or_null(steps.frames() ? steps.frames()->collection().string() : "");
  result["checkpoint"] = or_null(arguments.checkpoint);
  console.print_json(result);
}

void add_scenario_options(CLI::App& subcommand, SimulateArguments& arguments) {
  subcommand.add_option("SCENARIO", arguments.scenario,
                        "Name of a built-in scenario (see --list), or a file (docs/simulate.md)");
  subcommand.add_flag("--list", arguments.list, "List the built-in scenarios");
  subcommand.add_option("--mesh", arguments.mesh,
                        "Mesh instead of the scenario's own: a file, or a name from `meshorder models`");
  CLI::Option* const order = subcommand.add_option(
      "--order", arguments.order,
      "VERTICES or VERTICES/ELEMENTS. Without ELEMENTS, the method is also that of the elements if it\n"
      "is auto, original or scrambled; else elements are ordered by lexmax, those of water by max");
  subcommand.add_option("--vertices", arguments.vertices, "Method for vertices, see `meshorder methods`")
      ->excludes(order);
  subcommand.add_option("--elements", arguments.elements, "Method for elements, see `meshorder methods`")
      ->excludes(order);
  subcommand
      .add_option("--order-every", arguments.order_every,
                  "For fluids: number of steps after which the particles are ordered again; 0: when it pays")
      ->check(in_range(0, 1'000'000));
  subcommand.add_option("--steps", arguments.steps, "Number of steps")->check(in_range(1, 1'000'000));
  subcommand.add_option("--preconditioner", arguments.preconditioner,
                        "For backward Euler: " + names_of<PreconditionerKind>());
  subcommand.add_option("--precision", arguments.precision,
                        "Precision, double or single: of the matrix in CG, of all arrays in ADMM");
}

void add_output_options(CLI::App& subcommand, SimulateArguments& arguments) {
  CLI::Option* const frames = subcommand.add_option(
      "--vtk", arguments.frames, "Write the motion into this folder, for ParaView: open SCENARIO.pvd");
  subcommand.add_option("--every", arguments.every, "Number of steps between frames")
      ->check(whole_from(1))
      ->needs(frames)
      ->capture_default_str();
  CLI::Option* const checkpoint =
      subcommand.add_option("--checkpoint", arguments.checkpoint,
                            "Write checkpoints to this file; Ctrl-C saves one before exiting");
  subcommand
      .add_option("--checkpoint-every", arguments.checkpoint_every, "Number of steps between checkpoints")
      ->check(whole_from(1))
      ->needs(checkpoint)
      ->capture_default_str();
  subcommand.add_option(
      "--resume", arguments.resume,
      "Continue from a checkpoint of the same scenario, mesh and order; the motion is the same to\n"
      "the last bit");
}

}  // namespace

void add_simulate(CLI::App& subcommand) {
  subcommand.footer(
      "Example:\n"
      "  meshorder simulate falling --order fiedler --vtk frames\n"
      "  meshorder simulate splash --order scrambled");
  const auto arguments = std::make_shared<SimulateArguments>();
  add_scenario_options(subcommand, *arguments);
  add_output_options(subcommand, *arguments);
  add_ordering_options(subcommand, arguments->ordering);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
