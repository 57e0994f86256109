// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// implicit [--scenario NAME] [--steps N] [--orders a,b,…] [--preconditioners a,b,…] [--json FILE] MESH…:
// times the steps of an implicit scenario on each mesh, on one and two threads: every order with the
// scenario's own solver, then every preconditioner in the last order. The bodies of each group take their
// steps in turn. Prints medians over the steps:
//   set-up   of the body, s; memory in bytes a tetrahedron
//   assembly of forces and matrix, ms
//   CG       an iteration, ms, and its rate of reading the matrix, in per cent of the measured bandwidth
//   step     whole, ms, and its speedup over the first order
#include "io/format.hpp"
#include "lab/scenario/simulation.hpp"
#include "measuring.hpp"
#include "peak_flops.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace mo = meshorder;

namespace {

struct Settings {
  std::string scenario = "falling";
  int steps = 5;
  std::string orders = "scrambled,original,fiedler,spectral,rcm,hilbert";
  std::string preconditioners = "jacobi,block-jacobi,incomplete-cholesky,multigrid";
  std::string json;
  std::vector<std::string> files;
};

/// A simulation on a number of threads, and the times of its steps.
struct Runner {
  std::string name;
  int threads;
  mo::Simulation simulation;
  std::vector<double> assembly_ms = {}, solve_ms = {}, iteration_ms = {}, step_ms = {}, iterations = {};

  void step() {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const mo::StepReport report = simulation.body->step();
    assembly_ms.push_back(1e3 * report.seconds.assembly);
    solve_ms.push_back(1e3 * report.seconds.solve);
    iteration_ms.push_back(1e3 * report.seconds.solve / std::max(1, report.cg_iterations));
    step_ms.push_back(1e3 * report.seconds.total);
    iterations.push_back(report.cg_iterations);
  }
};

Runner make_runner(const std::string& name, int threads, mo::Scenario scenario, const mo::Mesh& mesh,
                   const std::string& file) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return {name, threads, mo::set_up(std::move(scenario), mesh, file)};
}

const mo::ElasticSystem& system_of(const Runner& runner) {
  return dynamic_cast<const mo::BackwardEuler&>(*runner.simulation.body).system();
}

/// Number of operations for the forces and the matrix of a tetrahedron: counted in the source of the
/// corotational law, including the rotation. StVK takes about as many.
constexpr double kAssemblyOperations = 700;

/// Returns the bytes that the assembly of forces and matrix moves if every array passes through the processor
/// once. An array that is set and then added to is written, read and written again.
double assembly_bytes(const Runner& runner) {
  const mo::ElasticSystem& system = system_of(runner);
  const mo::RestShapes& rest = system.rest();
  const auto tetrahedra = static_cast<double>(rest.count);
  const double map = 16 * sizeof(mo::Index);
  const double shape = 4 * sizeof(mo::Index) + 7 * sizeof(double);
  return tetrahedra * (map + shape) + 3 * 72 * static_cast<double>(system.matrix().block_count()) +
         4 * 4 * sizeof(double) * system.vertex_count();
}

/// Returns the operations of an iteration: 18 a block, and 12 for each entry of the vectors.
double iteration_operations(const Runner& runner) {
  // a product with half of the matrix takes as many operations
  const mo::BlockCsr& matrix = system_of(runner).matrix();
  return 18 * static_cast<double>(matrix.block_count()) + 12 * 3.0 * matrix.size();
}

double matrix_bytes(const Runner& runner) {
  const auto blocks =
      static_cast<double>(dynamic_cast<const mo::BackwardEuler&>(*runner.simulation.body).blocks_read());
  const double value = runner.simulation.scenario.implicit().precision == mo::MatrixPrecision::single ? 4 : 8;
  return blocks * (9 * value + sizeof(mo::Index));
}

nlohmann::ordered_json run(std::vector<Runner>& runners, const std::vector<double>& bandwidths, int steps) {
  for (int i = 0; i < steps; ++i) {
    for (Runner& runner : runners) runner.step();
  }
  fmt::print("{:<22}{:>8}{:>8}{:>7}{:>10}{:>11}{:>9}{:>7}{:>9}{:>9}\n", "", "threads", "set-up", "bytes",
             "assembly", "iterations", "CG", "%", "step", "speedup");
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  for (const Runner& runner : runners) {
    const mo::Simulation& simulation = runner.simulation;
    const double bytes =
        static_cast<double>(simulation.body->bytes()) / static_cast<double>(simulation.tetrahedra);
    const double rate = 1e-6 * matrix_bytes(runner) / median(runner.iteration_ms);
    const auto reference = std::find_if(runners.begin(), runners.end(),
                                        [&](const Runner& other) { return other.threads == runner.threads; });
    fmt::print("{:<22}{:>8}{:>8.2f}{:>7.0f}{:>10.1f}{:>11.0f}{:>9.3f}{:>7.0f}{:>9.1f}{:>9.2f}\n", runner.name,
               runner.threads, simulation.setup_seconds, bytes, median(runner.assembly_ms),
               median(runner.iterations), median(runner.iteration_ms),
               100 * rate / bandwidths[runner.threads - 1], median(runner.step_ms),
               median(reference->step_ms) / median(runner.step_ms));
    results.push_back({{"name", runner.name},
                       {"threads", runner.threads},
                       {"setup_seconds", simulation.setup_seconds},
                       {"bytes_per_tetrahedron", bytes},
                       {"assembly",
                        {{"ms", median(runner.assembly_ms)},
                         {"operations", kAssemblyOperations * static_cast<double>(simulation.tetrahedra)},
                         {"bytes", assembly_bytes(runner)}}},
                       {"iterations", median(runner.iterations)},
                       {"iteration",
                        {{"ms", median(runner.iteration_ms)},
                         {"operations", iteration_operations(runner)},
                         {"bytes", matrix_bytes(runner)}}},
                       {"step_ms", median(runner.step_ms)}});
  }
  return results;
}

nlohmann::ordered_json measure(const std::string& file, const Settings& settings,
                               const std::vector<double>& bandwidths) {
  const mo::Mesh mesh = mo::read_mesh(file);
  const mo::Scenario scenario = mo::find_scenario(settings.scenario);
  const std::vector<std::string> orders = split(settings.orders);
  nlohmann::ordered_json result{
      {"mesh", file}, {"scenario", scenario.name}, {"vertices", mesh.vertex_count()}};
  fmt::print("\n{}, {}: {} vertices, {} cells\n", file, scenario.title, mesh.vertex_count(),
             mesh.cell_count());
  {
    std::vector<Runner> runners;
    for (const std::string& order : orders) {
      for (int threads = 1; threads <= static_cast<int>(bandwidths.size()); ++threads) {
        runners.push_back(make_runner(order, threads, in_order(scenario, order), mesh, file));
      }
    }
    result["orders"] = run(runners, bandwidths, settings.steps);
  }
  std::vector<Runner> runners;
  for (const std::string& preconditioner : split(settings.preconditioners)) {
    for (const bool single : {false, true}) {
      for (int threads = 1; threads <= static_cast<int>(bandwidths.size()); ++threads) {
        mo::Scenario changed = in_order(scenario, orders.back());
        changed.implicit().preconditioner = mo::parse<mo::PreconditionerKind>(preconditioner);
        if (single) changed.implicit().precision = mo::MatrixPrecision::single;
        runners.push_back(
            make_runner(preconditioner + (single ? ", float" : ""), threads, changed, mesh, file));
      }
    }
  }
  result["preconditioners"] = run(runners, bandwidths, settings.steps);
  return result;
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool has_value = i + 1 < argc;
    if (argument == "--scenario" && has_value)
      settings.scenario = argv[++i];
    else if (argument == "--steps" && has_value)
      settings.steps = std::max(1, std::atoi(argv[++i]));
    else if (argument == "--orders" && has_value)
      settings.orders = argv[++i];
    else if (argument == "--preconditioners" && has_value)
      settings.preconditioners = argv[++i];
    else if (argument == "--json" && has_value)
      settings.json = argv[++i];
    else
      settings.files.push_back(argument);
  }
  return settings;
}

}  // namespace

int main(int argc, char** argv) {
  const Settings settings = parse(argc, argv);
  const std::vector<double> bandwidths = measure_bandwidths();
  const double peak = peak_gflops();
  fmt::print("1 thread computes {:.1f} Gflop/s\n", peak);
  nlohmann::ordered_json results{
      {"bandwidth", bandwidths}, {"peak_gflops", peak}, {"meshes", nlohmann::ordered_json::array()}};
  for (const std::string& file : settings.files)
    results["meshes"].push_back(measure(file, settings, bandwidths));
  if (!settings.json.empty()) std::ofstream(settings.json) << results.dump(1) << '\n';
}
