// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "simulate_report.hpp"

#include "report.hpp"
#include <meshorder/base/parallel.hpp>
#include <meshorder/mesh/graphs.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder::command {
namespace {

/// Sums over the steps.
StepRecord sums(const MotionRecord& record) {
  StepRecord sum;
  for (const StepRecord& step : record.steps) {
    sum.newton_iterations += step.newton_iterations;
    sum.cg_iterations += step.cg_iterations;
    sum.seconds += step.seconds;
    sum.assembly += step.assembly;
    sum.solve += step.solve;
  }
  return sum;
}

double length(const Point& vector) { return std::hypot(vector[0], vector[1], vector[2]); }

std::string in_words(const Point& vector) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", vector[0], vector[1], vector[2]);
}

double total_energy(const Balance& balance) { return balance.kinetic + balance.elastic + balance.potential; }

/// Count of cells of the highest dimension.
Index element_count(const Mesh& mesh) {
  return static_cast<Index>(std::count_if(mesh.cells.shapes.begin(), mesh.cells.shapes.end(),
                                          [](Shape shape) { return dimension(shape) == 3; }));
}

nlohmann::ordered_json to_json(const Balance& balance) {
  return {{"kinetic", balance.kinetic},
          {"elastic", balance.elastic},
          {"potential", balance.potential},
          {"total", total_energy(balance)}};
}

nlohmann::ordered_json material_json(const Scenario& scenario) {
  return {{"model", name_in(kMaterialModels, scenario.model)},
          {"tangent", name_in(kTangents, scenario.tangent)},
          {"young", scenario.material.young},
          {"poisson", scenario.material.poisson},
          {"density", scenario.material.density},
          {"regions", scenario.regions.size()}};
}

nlohmann::ordered_json integrator_json(const ImplicitOptions& options) {
  return {{"method", "backward-euler"},
          {"time_step", options.time_step},
          {"mass", name_in(kMasses, options.mass)},
          {"alpha", options.mass_damping},
          {"beta", options.stiffness_damping},
          {"gravity", options.gravity},
          {"newton_iterations", options.newton_iterations},
          {"newton_tolerance", options.newton_tolerance}};
}

nlohmann::ordered_json solver_json(const ImplicitOptions& options) {
  return {{"preconditioner", name_in(kPreconditioners, options.preconditioner)},
          {"tolerance", options.solve.tolerance},
          {"max_iterations", options.solve.max_iterations},
          {"precision", name_in(kPrecisions, options.precision)}};
}

}  // namespace

void print_header(const Console& console, const Simulation& simulation, const std::string& mesh) {
  const Scenario& scenario = simulation.scenario;
  const ImplicitOptions& options = scenario.integrator;
  console.print("{}{}{}", scenario.name, scenario.title.empty() ? "" : ": ", scenario.title);
  console.print("{:<10} {}: {} vertices, {} tetrahedra{}", "mesh", mesh,
                with_commas(simulation.mesh.vertex_count()), with_commas(simulation.tetrahedra),
                scenario.longest_side > 0 ? fmt::format(", scaled to {:g} m", scenario.longest_side) : "");
  console.print("{:<10} vertices {}, elements {}", "order", method_in_words(simulation.order.vertex_method),
                method_in_words(simulation.order.element_method));
  console.print("{:<10} {} ({} tangent), E {:g} Pa, nu {:g}, rho {:g} kg/m³{}", "material",
                name_in(kMaterialModels, scenario.model), name_in(kTangents, scenario.tangent),
                scenario.material.young, scenario.material.poisson, scenario.material.density,
                scenario.regions.empty() ? "" : fmt::format(", {} regions", scenario.regions.size()));
  console.print("{:<10} {} of {:g} s by backward Euler, CG with {} to {:g}{}, {} thread{}", "steps",
                scenario.steps, options.time_step, name_in(kPreconditioners, options.preconditioner),
                options.solve.tolerance, options.precision == MatrixPrecision::single ? " in single" : "",
                thread_count(), thread_count() == 1 ? "" : "s");
  std::fflush(stdout);
}

void print_summary(const Console& console, const Simulation& simulation, const MotionRecord& record) {
  const auto steps = static_cast<double>(record.steps.size());
  if (!record.steps.empty()) {
    const StepRecord sum = sums(record);
    const auto [least, most] =
        std::minmax_element(record.steps.begin(), record.steps.end(),
                            [](const auto& a, const auto& b) { return a.cg_iterations < b.cg_iterations; });
    console.print("\n{:<10} {}: {} a step, of which assembly {}, CG {}, other {}", "time",
                  duration(sum.seconds), duration(sum.seconds / steps), duration(sum.assembly / steps),
                  duration(sum.solve / steps), duration((sum.seconds - sum.assembly - sum.solve) / steps));
    console.print("{:<10} {} iterations, {:.1f} a step, {} to {}", "CG", with_commas(sum.cg_iterations),
                  sum.cg_iterations / steps, least->cg_iterations, most->cg_iterations);
  }
  console.print("{:<10} {:.1f} MB", "memory", static_cast<double>(simulation.body->bytes()) * 1e-6);
  const Balance& first = record.balances.front();
  const Balance& last = record.balances.back();
  console.print("{:<10} kinetic {:.5g} → {:.5g} J, elastic {:.5g} → {:.5g} J, of gravity {:.5g} → {:.5g} J",
                "energy", first.kinetic, last.kinetic, first.elastic, last.elastic, first.potential,
                last.potential);
  console.print("{:<10} {} → {} kg m/s", "momentum", in_words(first.momentum), in_words(last.momentum));
  console.print("{:<10} {:.4g} → {:.4g} kg m²/s about the origin", "angular", length(first.angular_momentum),
                length(last.angular_momentum));
  for (const WarningRecord& warning : record.warnings) {
    console.log("{}{}, step {}: {}", warning.count > 1 ? with_commas(warning.count) + " times" : "once",
                warning.count > 1 ? ", first" : "", warning.first_step, warning.first);
  }
}

nlohmann::ordered_json to_json(const Simulation& simulation, const MotionRecord& record) {
  const Scenario& scenario = simulation.scenario;
  const StepRecord sum = sums(record);
  const auto half = [](const MethodChoice& method, double seconds) {
    nlohmann::ordered_json json = to_json(method);
    json["seconds"] = seconds;
    return json;
  };
  auto cg_iterations = nlohmann::ordered_json::array();
  auto newton_iterations = nlohmann::ordered_json::array();
  auto step_seconds = nlohmann::ordered_json::array();
  for (const StepRecord& step : record.steps) {
    cg_iterations.push_back(step.cg_iterations);
    newton_iterations.push_back(step.newton_iterations);
    step_seconds.push_back(step.seconds);
  }
  auto energy = nlohmann::ordered_json::array();
  auto momentum = nlohmann::ordered_json::array();
  auto angular_momentum = nlohmann::ordered_json::array();
  for (const Balance& balance : record.balances) {
    energy.push_back(to_json(balance));
    momentum.push_back(balance.momentum);
    angular_momentum.push_back(balance.angular_momentum);
  }
  auto warnings = nlohmann::ordered_json::array();
  for (const WarningRecord& warning : record.warnings) {
    warnings.push_back(
        {{"sentence", warning.first}, {"first_step", warning.first_step}, {"count", warning.count}});
  }
  return {{"scenario", scenario.name},
          {"vertices", simulation.mesh.vertex_count()},
          {"elements", element_count(simulation.mesh)},
          {"tetrahedra", simulation.tetrahedra},
          {"steps", record.steps.size()},
          {"threads", thread_count()},
          {"order",
           {{"vertices", half(simulation.order.vertex_method, simulation.order.vertex_seconds)},
            {"elements", half(simulation.order.element_method, simulation.order.element_seconds)}}},
          {"material", material_json(scenario)},
          {"integrator", integrator_json(scenario.integrator)},
          {"solver", solver_json(scenario.integrator)},
          {"seconds",
           {{"total", sum.seconds},
            {"assembly", sum.assembly},
            {"solve", sum.solve},
            {"other", sum.seconds - sum.assembly - sum.solve}}},
          {"setup_seconds", {{"order", simulation.order_seconds}, {"body", simulation.setup_seconds}}},
          {"step_seconds", step_seconds},
          {"cg_iterations", cg_iterations},
          {"newton_iterations", newton_iterations},
          {"energy", energy},
          {"momentum", momentum},
          {"angular_momentum", angular_momentum},
          {"warnings", warnings},
          {"bytes", simulation.body->bytes()},
          {"paper", scenario.paper}};
}

}  // namespace meshorder::command
