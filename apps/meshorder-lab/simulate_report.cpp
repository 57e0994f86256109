// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "simulate_report.hpp"

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "lab/fluid/fluid.hpp"
#include "lab/scenario/vertex_choice.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace meshorder::command {
namespace {

/// Returns the sums over the steps.
StepReport sums(const MotionRecord& record) {
  StepReport sum;
  for (const auto& [report, shape_distance] : record.steps) {
    sum.newton_iterations += report.newton_iterations;
    sum.cg_iterations += report.cg_iterations;
    sum.admm_iterations += report.admm_iterations;
    sum.contact_iterations += report.contact_iterations;
    sum.seconds += report.seconds;
  }
  return sum;
}

/// Returns the part of `total` that no other field contains.
double other(const StepReport::Seconds& seconds) {
  return seconds.total - seconds.assembly - seconds.solve - seconds.local - seconds.global -
         seconds.collision - seconds.triangulation - seconds.order - seconds.motion;
}

/// Returns the smallest and the largest value of a field over the steps; there must be a step.
template <class Number>
std::pair<Number, Number> range(const MotionRecord& record, Number StepReport::*number) {
  Number lowest = record.steps.front().report.*number;
  Number highest = lowest;
  for (const StepRecord& step : record.steps) {
    lowest = std::min(lowest, step.report.*number);
    highest = std::max(highest, step.report.*number);
  }
  return {lowest, highest};
}

/// Returns a list with the value of a field in every step.
template <class Number>
nlohmann::ordered_json each(const MotionRecord& record, Number StepReport::*number) {
  auto list = nlohmann::ordered_json::array();
  for (const StepRecord& step : record.steps) list.push_back(step.report.*number);
  return list;
}

bool touches(const ProjectiveScenario& options) {
  return !options.obstacles.empty() || options.contact.with_itself;
}

bool has_stiffness(LocalModel model) { return model == LocalModel::springs || model == LocalModel::strain; }

double length(const Point& vector) { return std::hypot(vector[0], vector[1], vector[2]); }

std::string in_words(const Point& vector) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", vector[0], vector[1], vector[2]);
}

double total_energy(const Balance& balance) { return balance.kinetic + balance.elastic + balance.potential; }

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
  if (scenario.is_fluid())
    return {
        {"model", "fluid"}, {"density", scenario.fluid().density}, {"viscosity", scenario.fluid().viscosity}};
  nlohmann::ordered_json json;
  if (scenario.is_implicit()) {
    json["model"] = to_string(scenario.model);
    json["tangent"] = to_string(scenario.tangent);
  } else {
    json["model"] = to_string(scenario.projective().model);
  }
  if (!scenario.is_implicit() && has_stiffness(scenario.projective().model)) {
    json["stiffness"] = scenario.material.young;
  } else {
    json["young"] = scenario.material.young;
    json["poisson"] = scenario.material.poisson;
  }
  json["density"] = scenario.material.density;
  json["regions"] = scenario.regions.size();
  return json;
}

nlohmann::ordered_json integrator_json(const ImplicitOptions& options) {
  return {{"method", "backward-euler"},
          {"time_step", options.time_step},
          {"mass", to_string(options.mass)},
          {"alpha", options.mass_damping},
          {"beta", options.stiffness_damping},
          {"gravity", options.gravity},
          {"newton_iterations", options.newton_iterations},
          {"newton_tolerance", options.newton_tolerance}};
}

nlohmann::ordered_json integrator_json(const ProjectiveScenario& options) {
  return {{"method", "admm"},
          {"time_step", options.time_step},
          {"gravity", options.gravity},
          {"iterations", options.iterations},
          {"tolerance", options.tolerance},
          {"duals", options.keep_duals ? "kept" : "reset"}};
}

nlohmann::ordered_json integrator_json(const FluidScenario& options) {
  return {
      {"method", "particle-fem"},   {"time_step", options.time_step}, {"gravity", options.gravity},
      {"courant", options.courant}, {"evening", options.evening},     {"volume_gain", options.volume_gain},
      {"spacing", options.spacing}, {"basin", options.basin},         {"column", options.column},
      {"lid", options.lid},         {"jitter", options.jitter},       {"wave", options.wave}};
}

nlohmann::ordered_json solver_json(const FluidScenario& options) {
  return {{"preconditioner", "jacobi"},
          {"tolerance", options.solve.tolerance},
          {"max_iterations", options.solve.max_iterations},
          {"precision", "double"}};
}

nlohmann::ordered_json solver_json(const ImplicitOptions& options) {
  return {{"preconditioner", to_string(options.preconditioner)},
          {"tolerance", options.solve.tolerance},
          {"max_iterations", options.solve.max_iterations},
          {"precision", to_string(options.precision)}};
}

nlohmann::ordered_json solver_json(const ProjectiveScenario& options) {
  nlohmann::ordered_json json{{"precision", to_string(options.precision)}};
  if (touches(options)) {
    json["contact"] = {{"method", "uzawa"},
                       {"tolerance", options.contact_solver.tolerance},
                       {"max_iterations", options.contact_solver.max_iterations},
                       {"obstacles", options.obstacles.size()},
                       {"with_itself", options.contact.with_itself}};
  }
  return json;
}

std::string material_in_words(const Scenario& scenario) {
  if (scenario.is_fluid())
    return fmt::format("fluid, nu {:g} m²/s, rho {:g} kg/m³", scenario.fluid().viscosity,
                       scenario.fluid().density);
  const Material& material = scenario.material;
  std::string words;
  if (scenario.is_implicit()) {
    words = fmt::format("{} ({} tangent), E {:g} Pa, nu {:g}", to_string(scenario.model),
                        to_string(scenario.tangent), material.young, material.poisson);
  } else if (const LocalModel model = scenario.projective().model; has_stiffness(model)) {
    words = fmt::format("{}, k {:g} {}", to_string(model), material.young,
                        model == LocalModel::springs ? "N/m" : "Pa");
  } else {
    words = fmt::format("{}, E {:g} Pa, nu {:g}", to_string(model), material.young, material.poisson);
  }
  words += fmt::format(", rho {:g} kg/m³", material.density);
  if (!scenario.regions.empty()) words += fmt::format(", {} regions", scenario.regions.size());
  return words;
}

std::string method_in_words(const ImplicitOptions& options) {
  return fmt::format("backward Euler, CG with {} to {:g}{}", to_string(options.preconditioner),
                     options.solve.tolerance,
                     options.precision == MatrixPrecision::single ? " in single precision" : "");
}

std::string method_in_words(const FluidScenario& options) {
  return fmt::format("particle finite elements, CG with jacobi to {:g}", options.solve.tolerance);
}

std::string method_in_words(const ProjectiveScenario& options) {
  return fmt::format("ADMM, {}{} iterations, duals {}{}", options.tolerance > 0 ? "at most " : "",
                     options.iterations, options.keep_duals ? "kept" : "reset",
                     options.precision == MatrixPrecision::single ? ", in single precision" : "");
}

std::string contact_in_words(const ProjectiveScenario& options) {
  std::string words;
  for (const ScenarioObstacle& obstacle : options.obstacles) {
    constexpr std::array kNames{"half-space", "sphere", "bowl", "surface"};
    words += fmt::format("{}{}", words.empty() ? "" : ", ", kNames[static_cast<std::size_t>(obstacle.kind)]);
    if (obstacle.friction > 0) words += fmt::format(" (friction {:g})", obstacle.friction);
  }
  if (options.contact.with_itself) words += words.empty() ? "with itself" : ", with itself";
  return words + ", by uzawa";
}

/// Prints the time of each part of a fluid's steps, and how often the fluid was ordered.
void print_fluid_steps(const Console& console, const Simulation& simulation, const MotionRecord& record) {
  const auto steps = static_cast<double>(record.steps.size());
  const StepReport sum = sums(record);
  const StepReport::Seconds& seconds = sum.seconds;
  const auto a_step = [&](double total) { return duration(total / steps); };
  console.print("\n{:<10} {}: {} a step, of which triangulation {}, order {}, assembly {}, CG {}, motion {}",
                "time", duration(seconds.total), a_step(seconds.total), a_step(seconds.triangulation),
                a_step(seconds.order), a_step(seconds.assembly), a_step(seconds.solve),
                a_step(seconds.motion));
  const auto [lowest, highest] = range(record, &StepReport::cg_iterations);
  console.print("{:<10} {} iterations, {:.1f} a step, {} to {}", "CG", with_commas(sum.cg_iterations),
                sum.cg_iterations / steps, lowest, highest);
  const auto& fluid = dynamic_cast<const Fluid&>(*simulation.body);
  if (!fluid.order().ordering().stays()) {
    const auto orders = fluid.order().fresh_orders();
    console.print("{:<10} {} more {} in this run", "ordered", orders, orders == 1 ? "time" : "times");
  }
  double time = 0;
  for (const StepRecord& step : record.steps) time += step.report.time_step;
  console.print("{:<10} {:.4g} s of the flow; {} tetrahedra in the last step", "flow", time,
                with_commas(fluid.mesh().tetrahedra()));
  console.print("{:<10} {:.2f} % of that at the start; {} of {} particles are outside the mesh", "volume",
                fluid.volume_at_start() > 0 ? 100 * fluid.volume() / fluid.volume_at_start() : 0.0,
                with_commas(std::ranges::count(fluid.mesh().alone, 1)),
                with_commas(simulation.mesh.vertex_count()));
}

void print_steps(const Console& console, const Scenario& scenario, const MotionRecord& record) {
  const auto steps = static_cast<double>(record.steps.size());
  const StepReport sum = sums(record);
  const StepReport::Seconds& seconds = sum.seconds;
  const auto a_step = [&](double total) { return duration(total / steps); };
  if (scenario.is_implicit()) {
    console.print("\n{:<10} {}: {} a step, of which assembly {}, CG {}, other {}", "time",
                  duration(seconds.total), a_step(seconds.total), a_step(seconds.assembly),
                  a_step(seconds.solve), a_step(other(seconds)));
    const auto [lowest, highest] = range(record, &StepReport::cg_iterations);
    console.print("{:<10} {} iterations, {:.1f} a step, {} to {}", "CG", with_commas(sum.cg_iterations),
                  sum.cg_iterations / steps, lowest, highest);
    return;
  }
  console.print("\n{:<10} {}: {} a step, of which local {}, global {}, collision {}, other {}", "time",
                duration(seconds.total), a_step(seconds.total), a_step(seconds.local), a_step(seconds.global),
                a_step(seconds.collision), a_step(other(seconds)));
  const auto [lowest, highest] = range(record, &StepReport::admm_iterations);
  console.print("{:<10} {} iterations, {} to {} a step, {} each", "ADMM", with_commas(sum.admm_iterations),
                lowest, highest, duration(seconds.total / std::max(1, sum.admm_iterations)));
  if (!touches(scenario.projective())) return;
  console.print("{:<10} at most {} vertices, {} iterations in all; deepest in an obstacle {:.2g} m",
                "contact", with_commas(range(record, &StepReport::contacts).second),
                with_commas(sum.contact_iterations), range(record, &StepReport::penetration).second);
  if (scenario.projective().contact.with_itself)
    console.print("{:<10} at most {} vertices inside the body after a step, {} after the last", "itself",
                  range(record, &StepReport::vertices_in_itself).second,
                  record.steps.back().report.vertices_in_itself);
}

/// Prints the distance of the body from its shape at rest; if the distance ends within 1 % of the body's
/// height, also the step from which on it stays there.
void print_shape(const Console& console, const Simulation& simulation, const MotionRecord& record) {
  const BoundingBox box = bounding_box(simulation.mesh.points, simulation.vertices);
  const double near = 0.01 * (box.high[1] - box.low[1]);
  const auto last_far = std::find_if(record.steps.rbegin(), record.steps.rend(),
                                     [&](const StepRecord& step) { return step.shape_distance > near; });
  const double distance = record.steps.back().shape_distance;
  if (last_far == record.steps.rbegin()) {
    console.print("{:<10} {:.4g} m from the shape at rest", "shape", distance);
  } else {
    console.print("{:<10} {:.4g} m from the shape at rest, within 1 % of the height from step {} on", "shape",
                  distance, record.steps.rend() - last_far + 1);
  }
}

}  // namespace

void print_header(const Console& console, const Simulation& simulation, const std::string& mesh) {
  const Scenario& scenario = simulation.scenario;
  console.print("{}{}{}", scenario.name, scenario.title.empty() ? "" : ": ", visible(scenario.title));
  const std::string size = scenario.longest_side > 0
                               ? fmt::format(", scaled to {:g} m", scenario.longest_side)
                           : scenario.height > 0 ? fmt::format(", {:g} m high", scenario.height)
                                                 : "";
  if (scenario.is_fluid()) {
    const FluidScenario& fluid = scenario.fluid();
    const FluidOrdering& order = dynamic_cast<const Fluid&>(*simulation.body).order().ordering();
    console.print("{:<10} {} particles {:.3g} m apart, {} tetrahedra at the start", "water",
                  with_commas(simulation.mesh.vertex_count()), fluid.spacing,
                  with_commas(simulation.tetrahedra));
    console.print("{:<10} particles {}{}, tetrahedra {} in each step", "order", order.vertices,
                  order.stays()      ? ""
                  : order.every == 0 ? ", again when it pays"
                                     : fmt::format(", again every {} steps", order.every),
                  order.elements);
  } else {
    console.print("{:<10} {}: {} vertices, {} tetrahedra{}", "mesh", mesh,
                  with_commas(simulation.mesh.vertex_count()), with_commas(simulation.tetrahedra), size);
    console.print("{:<10} vertices {}, elements {}", "order",
                  method_in_words(simulation.order.vertices.method),
                  method_in_words(simulation.order.cells.method));
  }
  console.print("{:<10} {}", "material", material_in_words(scenario));
  console.print("{:<10} {} of {}{:g} s by {}, {} thread{}", "steps", scenario.steps,
                scenario.is_fluid() ? "at most " : "", scenario.motion().time_step,
                std::visit([](const auto& options) { return method_in_words(options); }, scenario.integrator),
                thread_count(), thread_count() == 1 ? "" : "s");
  if (scenario.is_projective() && touches(scenario.projective()))
    console.print("{:<10} {}", "contact", contact_in_words(scenario.projective()));
  flush_stdout();
}

void print_summary(Console& console, const Simulation& simulation, const MotionRecord& record) {
  if (!record.steps.empty() && simulation.scenario.is_fluid()) {
    print_fluid_steps(console, simulation, record);
  } else if (!record.steps.empty()) {
    print_steps(console, simulation.scenario, record);
    print_shape(console, simulation, record);
  }
  console.print("{:<10} {:.1f} MB", "memory", static_cast<double>(simulation.body->bytes()) * 1e-6);
  const Balance& first = record.balances.front();
  const Balance& last = record.balances.back();
  const std::string elastic = simulation.scenario.is_fluid()
                                  ? ""
                                  : fmt::format("elastic {:.5g} → {:.5g} J, ", first.elastic, last.elastic);
  console.print("{:<10} kinetic {:.5g} → {:.5g} J, {}gravity {:.5g} → {:.5g} J", "energy", first.kinetic,
                last.kinetic, elastic, first.potential, last.potential);
  console.print("{:<10} {} → {} kg m/s", "momentum", in_words(first.momentum), in_words(last.momentum));
  console.print("{:<10} {:.4g} → {:.4g} kg m²/s about the origin", "angular", length(first.angular_momentum),
                length(last.angular_momentum));
  for (const WarningRecord& warning : record.warnings) {
    console.warn(fmt::format("{}{}, step {}: {}",
                             warning.count > 1 ? with_commas(warning.count) + " times" : "once",
                             warning.count > 1 ? ", first" : "", warning.first_step, warning.first));
  }
}

namespace {

/// Returns the time of all steps, stage by stage.
nlohmann::ordered_json seconds_json(const Scenario& scenario, const StepReport::Seconds& sum) {
  nlohmann::ordered_json seconds{{"total", sum.total}};
  if (!scenario.is_projective()) {
    seconds["assembly"] = sum.assembly;
    seconds["solve"] = sum.solve;
    if (scenario.is_fluid()) {
      seconds["triangulation"] = sum.triangulation;
      seconds["order"] = sum.order;
      seconds["motion"] = sum.motion;
    }
  } else {
    seconds["local"] = sum.local;
    seconds["global"] = sum.global;
    seconds["collision"] = sum.collision;
  }
  seconds["other"] = other(sum);
  return seconds;
}

/// Adds the counts of a simulator's steps, such as iterations.
void add_counts(nlohmann::ordered_json& json, const Simulation& simulation, const MotionRecord& record) {
  const Scenario& scenario = simulation.scenario;
  if (scenario.is_fluid()) {
    json["time_steps"] = each(record, &StepReport::time_step);
    json["cg_iterations"] = each(record, &StepReport::cg_iterations);
    const auto& fluid = dynamic_cast<const Fluid&>(*simulation.body);
    json["volume"] = fluid.volume();
    json["volume_at_start"] = fluid.volume_at_start();
    json["fresh_orders"] = fluid.order().fresh_orders();
    json["alone"] = std::ranges::count(fluid.mesh().alone, 1);
  } else if (scenario.is_implicit()) {
    json["cg_iterations"] = each(record, &StepReport::cg_iterations);
    json["newton_iterations"] = each(record, &StepReport::newton_iterations);
  } else {
    json["admm_iterations"] = each(record, &StepReport::admm_iterations);
    if (touches(scenario.projective())) {
      json["contact_iterations"] = each(record, &StepReport::contact_iterations);
      json["contacts"] = each(record, &StepReport::contacts);
      json["penetration"] = each(record, &StepReport::penetration);
      json["vertices_in_itself"] = each(record, &StepReport::vertices_in_itself);
    }
  }
}

}  // namespace

nlohmann::ordered_json to_json(const Simulation& simulation, const MotionRecord& record) {
  const Scenario& scenario = simulation.scenario;
  const auto half = [](const MethodChoice& method, double seconds) {
    nlohmann::ordered_json json = to_json(method);
    json["seconds"] = seconds;
    return json;
  };
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
  nlohmann::ordered_json json{
      {"scenario", scenario.name},
      {"vertices", simulation.mesh.vertex_count()},
      {"elements", scenario.is_fluid() ? simulation.tetrahedra : element_count(simulation.mesh)},
      {"tetrahedra", simulation.tetrahedra},
      {"steps", record.steps.size()},
      {"threads", thread_count()},
      {"order",
       {{"vertices", half(simulation.order.vertices.method, simulation.order.vertices.seconds)},
        {"elements", half(simulation.order.cells.method, simulation.order.cells.seconds)}}},
      {"material", material_json(scenario)}};
  std::visit(
      [&](const auto& options) {
        json["integrator"] = integrator_json(options);
        json["solver"] = solver_json(options);
      },
      scenario.integrator);
  json["seconds"] = seconds_json(scenario, sums(record).seconds);
  json["setup_seconds"] = {{"order", simulation.order_seconds}, {"body", simulation.setup_seconds}};
  auto step_seconds = nlohmann::ordered_json::array();
  auto shape_distance = nlohmann::ordered_json::array();
  for (const StepRecord& step : record.steps) {
    step_seconds.push_back(step.report.seconds.total);
    shape_distance.push_back(step.shape_distance);
  }
  json["step_seconds"] = step_seconds;
  add_counts(json, simulation, record);
  json["energy"] = energy;
  json["momentum"] = momentum;
  json["angular_momentum"] = angular_momentum;
  if (!scenario.is_fluid()) json["shape_distance"] = shape_distance;
  json["warnings"] = warnings;
  json["bytes"] = simulation.body->bytes();
  json["paper"] = scenario.paper;
  return json;
}

}  // namespace meshorder::command
