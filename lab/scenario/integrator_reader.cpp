// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/integrator_reader.hpp"

#include <cmath>
#include <filesystem>
#include <utility>

namespace meshorder {
namespace {

constexpr NumberRange kTolerance{.min = 0, .max = 1, .min_open = true, .max_open = true};
constexpr int kMostIterations = 1'000'000;

enum class Method : std::uint8_t { backward_euler, admm, particle_fem };
constexpr std::array kMethods{std::pair{Method::backward_euler, "backward-euler"},
                              std::pair{Method::admm, "admm"},
                              std::pair{Method::particle_fem, "particle-fem"}};
constexpr std::array kContactSolvers{std::pair{true, "uzawa"}};  // the only solver
constexpr std::array kFluidModels{std::pair{true, "fluid"}};     // the only model
constexpr std::array kDuals{std::pair{true, "kept"}, std::pair{false, "reset"}};

void read_count(const JsonValue& owner, std::string_view key, int most, int& count) {
  if (const auto value = owner.find(key)) count = static_cast<int>(value->whole(1, most));
}

// ---- materials

/// The numbers of an elastic material: Young's modulus and Poisson's ratio, or a stiffness.
enum class Elastic : std::uint8_t { moduli, stiffness };

Material material_of(const JsonValue& value, Elastic elastic, Material numbers) {
  if (elastic == Elastic::stiffness) {
    numbers.poisson = 0.0;
    if (const auto stiffness = value.find("stiffness")) numbers.young = stiffness->number(kPositive);
  } else {
    if (const auto young = value.find("young")) numbers.young = young->number(kPositive);
    if (const auto poisson = value.find("poisson"))
      numbers.poisson = poisson->number({.min = -1, .max = 0.5, .min_open = true, .max_open = true});
  }
  if (const auto density = value.find("density")) numbers.density = density->number(kPositive);
  return numbers;
}

void read_regions(const JsonValue& value, Elastic elastic, Scenario& scenario) {
  value.expect_keys({"by", "groups"});
  scenario.regions_by = value["by"].text();
  for (const JsonValue& entry : value["groups"].items(1)) {
    if (elastic == Elastic::stiffness) {
      entry.expect_keys({"group", "stiffness", "density"});
    } else {
      entry.expect_keys({"group", "young", "poisson", "density"});
    }
    const JsonValue group = entry["group"];
    RegionMaterial region;
    region.region = group.is_text() ? group.text()
                                    : std::to_string(group.whole(std::numeric_limits<std::int64_t>::min(),
                                                                 std::numeric_limits<std::int64_t>::max()));
    for (const RegionMaterial& other : scenario.regions) {
      if (other.region == region.region) throw group.error("already has an entry", "keep one of them");
    }
    region.material = material_of(entry, elastic, scenario.material);
    scenario.regions.push_back(std::move(region));
  }
}

void read_numbers(const JsonValue& value, Elastic elastic, Scenario& scenario) {
  if (elastic == Elastic::stiffness) {
    for (const std::string_view needed : {"stiffness", "density"}) (void)value[needed];
  } else {
    for (const std::string_view needed : {"young", "poisson", "density"}) (void)value[needed];
  }
  scenario.material = material_of(value, elastic, scenario.material);
  if (const auto regions = value.find("regions")) read_regions(*regions, elastic, scenario);
}

// ---- backward Euler

void read_implicit_material(const JsonValue& value, Scenario& scenario) {
  value.expect_keys({"model", "tangent", "young", "poisson", "density", "regions"});
  scenario.model = value["model"].one_of<MaterialModel>();
  if (const auto tangent = value.find("tangent")) {
    scenario.tangent = tangent->one_of<Tangent>();
    if (scenario.tangent == Tangent::approximate && scenario.model != MaterialModel::corotational)
      throw tangent->error("'approximate' is for the corotational model only", "give exact or projected");
  }
  read_numbers(value, Elastic::moduli, scenario);
}

void read_implicit(const JsonValue& value, ImplicitOptions& options) {
  value.expect_keys({"method", "time_step", "mass", "rayleigh", "gravity", "newton"});
  if (const auto mass = value.find("mass")) options.mass = mass->one_of<Mass>();
  if (const auto rayleigh = value.find("rayleigh")) {
    rayleigh->expect_keys({"alpha", "beta"});
    if (const auto alpha = rayleigh->find("alpha")) options.mass_damping = alpha->number(kNotNegative);
    if (const auto beta = rayleigh->find("beta")) options.stiffness_damping = beta->number(kNotNegative);
  }
  if (const auto newton = value.find("newton")) {
    newton->expect_keys({"iterations", "tolerance"});
    read_count(*newton, "iterations", kMostIterations, options.newton_iterations);
    if (const auto tolerance = newton->find("tolerance"))
      options.newton_tolerance = tolerance->number(kTolerance);
  }
}

void read_implicit_solver(const JsonValue& value, ImplicitOptions& options) {
  value.expect_keys({"preconditioner", "tolerance", "max_iterations", "precision"});
  if (const auto preconditioner = value.find("preconditioner"))
    options.preconditioner = preconditioner->one_of<PreconditionerKind>();
  if (const auto tolerance = value.find("tolerance")) options.solve.tolerance = tolerance->number(kTolerance);
  read_count(value, "max_iterations", kMostIterations, options.solve.max_iterations);
  if (const auto precision = value.find("precision"))
    options.precision = precision->one_of<MatrixPrecision>();
}

// ---- ADMM

void read_projective_material(const JsonValue& value, ProjectiveScenario& options, Scenario& scenario) {
  options.model = value["model"].one_of<LocalModel>();
  switch (options.model) {
    case LocalModel::springs:
      value.expect_keys({"model", "stiffness", "density"});
      return read_numbers(value, Elastic::stiffness, scenario);
    case LocalModel::strain:
      value.expect_keys({"model", "stiffness", "density", "regions"});
      return read_numbers(value, Elastic::stiffness, scenario);
    case LocalModel::stvk:
    case LocalModel::neo_hookean:
    case LocalModel::log_neo_hookean:
      value.expect_keys({"model", "young", "poisson", "density", "regions"});
      return read_numbers(value, Elastic::moduli, scenario);
  }
}

void read_projective(const JsonValue& value, ProjectiveScenario& options) {
  value.expect_keys({"method", "time_step", "gravity", "iterations", "tolerance", "duals"});
  read_count(value, "iterations", kMostIterations, options.iterations);
  if (const auto tolerance = value.find("tolerance"))
    options.tolerance = tolerance->number({.min = 0, .max = 1, .max_open = true});
  if (const auto duals = value.find("duals")) options.keep_duals = duals->one_of(kDuals);
}

/// Reads a vector other than 0.
Point direction(const JsonValue& value) {
  const Point vector = value.vector();
  if (!(std::hypot(vector[0], vector[1], vector[2]) > 0.0))
    throw value.error("has no direction", "give a vector other than 0");
  return vector;
}

ScenarioObstacle obstacle(const JsonValue& value) {
  using Kind = ScenarioObstacle::Kind;
  value.expect_keys({"half_space", "sphere", "bowl", "surface", "friction"});
  int kinds = 0;
  for (const std::string_view kind : {"half_space", "sphere", "bowl", "surface"})
    kinds += value.has(kind) ? 1 : 0;
  if (kinds != 1)
    throw value.error("does not say which obstacle", "give one of half_space, sphere, bowl, surface");
  ScenarioObstacle result;
  if (const auto plane = value.find("half_space")) {
    plane->expect_keys({"point", "normal"});
    result.kind = Kind::half_space;
    result.place = (*plane)["point"].vector();
    result.direction = direction((*plane)["normal"]);
  } else if (const auto ball = value.find("sphere")) {
    ball->expect_keys({"center", "radius"});
    result.kind = Kind::sphere;
    result.place = (*ball)["center"].vector();
    result.radius = (*ball)["radius"].number(kPositive);
  } else if (const auto bowl = value.find("bowl")) {
    bowl->expect_keys({"center", "axis", "radius", "thickness", "opening"});
    result.kind = Kind::bowl;
    result.place = (*bowl)["center"].vector();
    result.direction = direction((*bowl)["axis"]);
    result.radius = (*bowl)["radius"].number(kPositive);
    result.thickness =
        (*bowl)["thickness"].number({.min = 0, .max = 2 * result.radius, .min_open = true, .max_open = true});
    result.opening = (*bowl)["opening"].number({.min = 0, .max = 180, .min_open = true, .max_open = true});
  } else {
    result.kind = Kind::surface;
    result.folder = std::filesystem::path(value.file()).parent_path();
    result.file = (result.folder / value["surface"].text()).string();
  }
  if (const auto friction = value.find("friction")) result.friction = friction->number(kNotNegative);
  return result;
}

void read_contact(const JsonValue& value, ProjectiveScenario& options) {
  value.expect_keys({"obstacles", "with_itself", "friction", "solver", "tolerance", "max_iterations"});
  if (const auto obstacles = value.find("obstacles")) {
    for (const JsonValue& entry : obstacles->items()) options.obstacles.push_back(obstacle(entry));
  }
  if (const auto with_itself = value.find("with_itself")) options.contact.with_itself = with_itself->truth();
  if (const auto friction = value.find("friction"))
    options.contact.friction_with_itself = friction->number(kNotNegative);
  ContactSolverOptions& solver = options.contact_solver;
  if (const auto kind = value.find("solver")) (void)kind->one_of(kContactSolvers);
  if (const auto tolerance = value.find("tolerance")) solver.tolerance = tolerance->number(kTolerance);
  read_count(value, "max_iterations", kMostIterations, solver.max_iterations);
}

// ---- fluids

void read_water(const JsonValue& value, FluidOptions& options) {
  value.expect_keys({"basin", "lid", "column", "spacing", "jitter", "wave"});
  options.basin = value["basin"].vector();
  options.column = value["column"].vector();
  options.spacing = value["spacing"].number(kPositive);
  if (const auto lid = value.find("lid")) options.lid = lid->truth();
  if (const auto jitter = value.find("jitter")) options.jitter = jitter->number(kNotNegative);
  if (const auto wave = value.find("wave")) options.wave = wave->number();
}

FluidScenario read_fluid(const JsonValue& root, const JsonValue& material, const JsonValue& integrator) {
  FluidScenario options;
  read_water(root["water"], options);
  material.expect_keys({"model", "density", "viscosity"});
  (void)material["model"].one_of(kFluidModels);
  options.density = material["density"].number(kPositive);
  if (const auto viscosity = material.find("viscosity")) options.viscosity = viscosity->number(kNotNegative);
  integrator.expect_keys({"method", "time_step", "gravity", "courant", "evening", "volume_gain"});
  if (const auto courant = integrator.find("courant")) options.courant = courant->number(kPositive);
  if (const auto evening = integrator.find("evening")) options.evening = evening->number(kNotNegative);
  if (const auto gain = integrator.find("volume_gain")) options.volume_gain = gain->number(kNotNegative);
  if (const auto solver = root.find("solver")) {
    solver->expect_keys({"tolerance", "max_iterations"});
    if (const auto tolerance = solver->find("tolerance"))
      options.solve.tolerance = tolerance->number(kTolerance);
    read_count(*solver, "max_iterations", kMostIterations, options.solve.max_iterations);
  }
  if (const auto order = root.find("order")) {
    if (const auto every = order->find("every"))
      options.order_every = static_cast<Index>(every->whole(0, kMostIterations));
  }
  return options;
}

}  // namespace

void read_integrator(const JsonValue& root, Scenario& scenario) {
  const JsonValue integrator = root["integrator"];
  const JsonValue material = root["material"];
  const auto solver = root.find("solver");
  const auto contact = root.find("contact");
  const auto read_common = [&](MotionOptions& options) {
    options.time_step = integrator["time_step"].number(kPositive);
    if (const auto gravity = integrator.find("gravity")) options.gravity = gravity->vector();
  };
  const auto method_name = integrator.find("method");
  const Method method = method_name ? method_name->one_of(kMethods) : Method::backward_euler;
  if (root.has("water") != (method == Method::particle_fem))
    throw root.error("water and the method particle-fem belong together", "give both or neither");
  if (method == Method::particle_fem) {
    if (contact) throw contact->error("is unknown to particle-fem", "leave it out");
    FluidScenario options = read_fluid(root, material, integrator);
    read_common(options);
    try {
      check_options(options);
    } catch (const InvalidArgument& error) {
      throw root["water"].error(error.what(), "change the file");
    }
    scenario.integrator = std::move(options);
    return;
  }
  if (const auto order = root.find("order"); order && order->has("every"))
    throw(*order)["every"].error("is for water, whose mesh changes", "leave it out");
  if (method == Method::backward_euler) {
    ImplicitOptions options;
    read_implicit_material(material, scenario);
    read_implicit(integrator, options);
    read_common(options);
    if (solver) read_implicit_solver(*solver, options);
    if (contact) throw contact->error("is unknown to backward-euler", "give the integrator the method admm");
    scenario.integrator = std::move(options);
    return;
  }
  ProjectiveScenario options;
  read_projective_material(material, options, scenario);
  read_projective(integrator, options);
  read_common(options);
  if (solver) {
    solver->expect_keys({"precision"});
    if (const auto precision = solver->find("precision"))
      options.precision = precision->one_of<MatrixPrecision>();
  }
  if (contact) read_contact(*contact, options);
  scenario.integrator = std::move(options);
}

}  // namespace meshorder
