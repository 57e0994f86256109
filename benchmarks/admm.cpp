// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// admm [--scenarios a,b,…] [--steps N] [--orders a,b,…] [--json FILE]: times the steps of the ADMM scenarios
// on their own meshes: every order in double precision on one and two threads, then the last order in single
// precision. The bodies of a scenario take their steps in turn. Prints medians over the steps:
//   set-up     of the body, s; memory in bytes an element
//   iteration  of ADMM, ms: local steps, global step and search for contacts; and the times of the local
//              and global steps if memory delivered their arrays once at the measured bandwidth
//   step       whole, ms, and its speedup over the first order
// Scenarios with obstacles are measured twice: in free flight, and after the body was put right above the
// obstacle with the speed of its fall.
#include "io/format.hpp"
#include "lab/models/catalogue.hpp"
#include "lab/scenario/simulation.hpp"
#include "measuring.hpp"
#include "rotation_time.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace mo = meshorder;

namespace {

struct Settings {
  std::string scenarios = "unsquash,stretch,bounce,bowl";
  int steps = 5;
  std::string orders = "scrambled,original,fiedler,spectral,hilbert";
  std::string json;
};

/// Bytes that the two halves of an iteration move if every array passes through the processor once.
struct IterationBytes {
  double local = 0.0, global = 0.0;
};

template <class Real>
IterationBytes bytes_of(const mo::ProjectiveDynamics<Real>& body) {
  const double vectors = 4.0 * sizeof(Real) * static_cast<double>(body.masses().size());
  // duals are read and written; the factor is read forwards and backwards
  const double duals = sizeof(Real) * static_cast<double>(body.local_steps().duals().size());
  return {static_cast<double>(body.local_steps().bytes()) + duals + 3 * vectors,
          2 * static_cast<double>(body.system().factor().bytes()) + 4 * vectors};
}

IterationBytes bytes_of(const mo::Simulation& simulation) {
  if (const auto* const body = dynamic_cast<const mo::ProjectiveDynamics<double>*>(simulation.body.get()))
    return bytes_of(*body);
  return bytes_of(dynamic_cast<const mo::ProjectiveDynamics<float>&>(*simulation.body));
}

/// A simulation on a number of threads, and the times of its steps, ms.
struct Runner {
  std::string name;
  int threads;
  mo::Simulation simulation;
  std::vector<double> local = {}, global = {}, collision = {}, iteration = {}, step = {}, inner = {};

  void take_step(bool counts) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const mo::StepReport report = simulation.body->step();
    if (!counts) return;
    const double each = 1e3 / report.admm_iterations;
    local.push_back(each * report.seconds.local);
    global.push_back(each * report.seconds.global);
    collision.push_back(each * report.seconds.collision);
    iteration.push_back(each * report.seconds.total);
    step.push_back(1e3 * report.seconds.total);
    inner.push_back(static_cast<double>(report.contact_iterations) / report.admm_iterations);
  }
};

Runner make_runner(const std::string& name, int threads, mo::Scenario scenario, const mo::Mesh& mesh,
                   const std::string& file) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return {name, threads, mo::set_up(std::move(scenario), mesh, file)};
}

/// Returns the scenario with the body just above `top`, the highest point of the obstacles, with the speed of
/// a fall from its first place.
mo::Scenario before_contact(mo::Scenario scenario, double top) {
  const double gravity = -scenario.motion().gravity[1];
  const double fall = (*scenario.bottom)[1] - top;
  mo::ScenarioStart& start = scenario.start.emplace_back();
  start.velocity = mo::Point{0, -std::sqrt(2 * gravity * fall), 0};
  (*scenario.bottom)[1] = top;
  return scenario;
}

/// Returns the height of the highest point of the obstacles, which are floors and bowls about the y axis.
double top_of(const mo::ProjectiveScenario& options) {
  double top = 0.0;
  for (const mo::ScenarioObstacle& obstacle : options.obstacles) {
    const double rim = obstacle.radius * std::cos(obstacle.opening * 3.14159265358979323846 / 180.0);
    top = std::max(top, obstacle.place[1] + rim + obstacle.thickness / 2);
  }
  return top;
}

nlohmann::ordered_json run(std::vector<Runner>& runners, const std::vector<double>& bandwidths, int skipped,
                           int steps) {
  for (int i = 0; i < skipped + steps; ++i) {
    for (Runner& runner : runners) runner.take_step(i >= skipped);
  }
  fmt::print("{:<20}{:>8}{:>8}{:>7}{:>9}{:>8}{:>8}{:>8}{:>8}{:>10}{:>8}{:>9}{:>9}\n", "", "threads", "set-up",
             "bytes", "local", "floor", "global", "floor", "inner", "collision", "total", "step", "speedup");
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  for (const Runner& runner : runners) {
    const mo::Simulation& simulation = runner.simulation;
    const IterationBytes bytes = bytes_of(simulation);
    const double per_ms = 1e6 * bandwidths[runner.threads - 1];
    const double memory =
        static_cast<double>(simulation.body->bytes()) / static_cast<double>(simulation.tetrahedra);
    const auto reference = std::find_if(runners.begin(), runners.end(),
                                        [&](const Runner& other) { return other.threads == runner.threads; });
    fmt::print(
        "{:<20}{:>8}{:>8.2f}{:>7.0f}{:>9.2f}{:>8.2f}{:>8.2f}{:>8.2f}{:>8.1f}{:>10.2f}{:>8.2f}{:>9.1f}{:>9.2f}"
        "\n",
        runner.name, runner.threads, simulation.setup_seconds, memory, median(runner.local),
        bytes.local / per_ms, median(runner.global), bytes.global / per_ms, median(runner.inner),
        median(runner.collision), median(runner.iteration), median(runner.step),
        median(reference->step) / median(runner.step));
    results.push_back({{"name", runner.name},
                       {"threads", runner.threads},
                       {"setup_seconds", simulation.setup_seconds},
                       {"bytes_per_tetrahedron", memory},
                       {"local", {{"ms", median(runner.local)}, {"bytes", bytes.local}}},
                       {"global", {{"ms", median(runner.global)}, {"bytes", bytes.global}}},
                       {"contact_iterations", median(runner.inner)},
                       {"collision_ms", median(runner.collision)},
                       {"iteration_ms", median(runner.iteration)},
                       {"step_ms", median(runner.step)}});
  }
  return results;
}

/// Makes runners for all orders on 1 to `threads` threads, and for the last order in single precision.
std::vector<Runner> make_runners(const mo::Scenario& scenario, const mo::Mesh& mesh, const std::string& file,
                                 const std::vector<std::string>& orders, int threads) {
  std::vector<Runner> runners;
  for (const std::string& order : orders) {
    for (int t = 1; t <= threads; ++t)
      runners.push_back(make_runner(order, t, in_order(scenario, order), mesh, file));
  }
  mo::Scenario single = in_order(scenario, orders.back());
  single.projective().precision = mo::MatrixPrecision::single;
  for (int t = 1; t <= threads; ++t)
    runners.push_back(make_runner(orders.back() + ", float", t, single, mesh, file));
  return runners;
}

nlohmann::ordered_json measure(const std::string& name, const Settings& settings,
                               const std::vector<double>& bandwidths) {
  const mo::Scenario scenario = mo::find_scenario(name);
  const std::string file = mo::make_model(scenario.mesh, {}).path.string();
  const mo::Mesh mesh = mo::read_mesh(file);
  const std::vector<std::string> orders = split(settings.orders);
  const int threads = static_cast<int>(bandwidths.size());
  const bool touches = !scenario.projective().obstacles.empty();
  nlohmann::ordered_json result{{"scenario", name}, {"vertices", mesh.vertex_count()}};
  fmt::print("\n{}{}: {} vertices, {} cells\n", name, touches ? ", free flight" : "", mesh.vertex_count(),
             mesh.cell_count());
  {
    std::vector<Runner> runners = make_runners(scenario, mesh, file, orders, threads);
    result["free"] = run(runners, bandwidths, 1, settings.steps);
  }
  if (!touches) return result;
  fmt::print("\n{}, in contact\n", name);
  constexpr int kUntilDeep = 5;  // steps until the contact has spread
  std::vector<Runner> runners =
      make_runners(before_contact(scenario, top_of(scenario.projective())), mesh, file, orders, threads);
  result["contact"] = run(runners, bandwidths, kUntilDeep, settings.steps);
  return result;
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string argument = argv[i];
    if (argument == "--scenarios") settings.scenarios = argv[i + 1];
    if (argument == "--steps") settings.steps = std::max(1, std::atoi(argv[i + 1]));
    if (argument == "--orders") settings.orders = argv[i + 1];
    if (argument == "--json") settings.json = argv[i + 1];
  }
  return settings;
}

}  // namespace

int main(int argc, char** argv) {
  const Settings settings = parse(argc, argv);
  const std::vector<double> bandwidths = measure_bandwidths();
  auto rotations = nlohmann::ordered_json::array();
  for (const auto& [instructions, double_ns, float_ns] : rotation_times()) {
    fmt::print("closest rotation, {:<8} {:>6.1f} ns, float {:>6.1f} ns\n", instructions, double_ns, float_ns);
    rotations.push_back({{"instructions", instructions}, {"double_ns", double_ns}, {"float_ns", float_ns}});
  }
  nlohmann::ordered_json results{{"bandwidth", bandwidths},
                                 {"closest_rotation", rotations},
                                 {"scenarios", nlohmann::ordered_json::array()}};
  for (const std::string& name : split(settings.scenarios))
    results["scenarios"].push_back(measure(name, settings, bandwidths));
  if (!settings.json.empty()) std::ofstream(settings.json) << results.dump(1) << '\n';
}
