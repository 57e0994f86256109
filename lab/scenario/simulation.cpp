// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/simulation.hpp"

#include "base/checksum.hpp"
#include "base/stopwatch.hpp"
#include "lab/fluid/fluid.hpp"
#include "lab/scenario/scenario_obstacles.hpp"
#include "lab/scenario/vertex_choice.hpp"
#include "mesh/graphs.hpp"
#include "mesh/groups.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Returns the vertices of simplices, ascending.
std::vector<Index> used_vertices(const Simplices& simplices, Index vertex_count) {
  std::vector<char> used(vertex_count, 0);
  for (const Index v : simplices.vertices) used[v] = 1;
  std::vector<Index> result;
  for (Index v = 0; v < vertex_count; ++v) {
    if (used[v] != 0) result.push_back(v);
  }
  return result;
}

/// Sets the time span of a selection. Its ends are halfway between steps, so that rounding cannot matter.
void set_times(const StepRange& steps, double time_step, Selection& selection) {
  selection.from = (steps.first - 1.5) * time_step;
  if (steps.last < kMaxIndex) selection.until = (steps.last - 0.5) * time_step;
}

/// Scales and moves the mesh so that the bounding box of `vertices` is as the scenario says.
void place(Mesh& mesh, std::span<const Index> vertices, const Scenario& scenario, const std::string& file) {
  BoundingBox box = bounding_box(mesh.points, vertices);
  if (scenario.longest_side > 0 || scenario.height > 0) {
    const double factor = scenario.longest_side > 0 ? scenario.longest_side / box.longest_side()
                                                    : scenario.height / (box.high[1] - box.low[1]);
    if (!std::isfinite(factor) || !(factor > 0.0))
      throw InputError(file, "its volume cells have no extent", "give a mesh of a body with a volume");
    for (Point& point : mesh.points) {
      for (double& x : point) x *= factor;
    }
    box = bounding_box(mesh.points, vertices);
  }
  if (!scenario.bottom) return;
  const Point bottom{0.5 * (box.low[0] + box.high[0]), box.low[1], 0.5 * (box.low[2] + box.high[2])};
  for (Point& point : mesh.points) {
    for (int c = 0; c < 3; ++c) point[c] += (*scenario.bottom)[c] - bottom[c];
  }
}

/// Returns the materials of the simplices. Throws Error, which names the scenario's file, for unknown
/// regions.
SimplexMaterials materials_of(const Scenario& scenario, const Mesh& mesh, const Simplices& simplices) {
  if (scenario.regions.empty()) return uniform_material(scenario.material);
  try {
    return materials_by_region(simplices, grouping_by(mesh, scenario.regions_by), scenario.material,
                               scenario.regions);
  } catch (const InvalidArgument& error) {
    throw InputError(scenario.file, std::string("material.regions: ") + error.what(),
                     "name groups that the mesh has");
  }
}

/// Adds the scenario's forces and prescribed motions with the vertices that they describe.
void bind_loads(const Scenario& scenario, const Mesh& mesh, std::span<const Index> candidates,
                MotionOptions& options) {
  for (const ScenarioForce& force : scenario.forces) {
    VertexForce& bound_force = options.forces.emplace_back();
    bound_force.vertices = choose_vertices(mesh, candidates, force.on, scenario.file);
    bound_force.newtons = force.newtons;
    set_times(force.steps, options.time_step, bound_force);
  }
  for (const ScenarioMotion& motion : scenario.motions) {
    PrescribedMotion& bound_motion = options.prescribed.emplace_back();
    bound_motion.vertices = choose_vertices(mesh, candidates, motion.on, scenario.file);
    bound_motion.velocity = motion.velocity;
    set_times(motion.steps, options.time_step, bound_motion);
  }
}

/// Returns the state in which the motion starts.
MotionState start_of(const Scenario& scenario, const Mesh& mesh, std::span<const Index> candidates) {
  MotionState state;
  state.positions = mesh.points;
  state.velocities.resize(mesh.points.size());
  const BoundingBox box = bounding_box(mesh.points, candidates);
  for (const ScenarioStart& start : scenario.start) {
    for (const Index v : choose_vertices(mesh, candidates, start.on, scenario.file)) {
      if (start.velocity) state.velocities[v] = *start.velocity;
      for (int c = 0; c < 3 && start.at; ++c)
        state.positions[v][c] = box.low[c] + (*start.at)[c] * (box.high[c] - box.low[c]);
    }
  }
  return state;
}

/// Returns the law. For springs and strain, Young's modulus with ν = 0 is the stiffness, which is then 2μ.
LocalLaw local_law_of(const SimplexMaterials& materials, LocalModel model, Offset simplices) {
  LocalLaw law;
  law.model = model;
  const auto first = [&](const AlignedVector<double>& padded) {
    return std::vector<double>(padded.begin(), padded.begin() + (padded.empty() ? 0 : simplices));
  };
  if (model == LocalModel::springs || model == LocalModel::strain) {
    law.stiffness = 2.0 * materials.lame.mu;
    law.stiffnesses = first(materials.mu);
    for (double& stiffness : law.stiffnesses) stiffness *= 2.0;
  } else {
    law.lame = materials.lame;
    law.mu = first(materials.mu);
    law.lambda = first(materials.lambda);
  }
  return law;
}

/// ContactOptions::reach of a body, as a share of the longest side of its bounding box.
constexpr double kReach = 0.02;

void set_up_implicit(Simplices simplices, const MotionState& start, Simulation& simulation) {
  const Scenario& scenario = simulation.scenario;
  Body body;
  SimplexMaterials materials = materials_of(scenario, simulation.mesh, simplices);
  body.densities = std::move(materials.densities);
  body.elasticity = elasticity_of(std::move(materials), scenario.model, scenario.tangent);
  body.simplices = std::move(simplices);
  ImplicitOptions options = scenario.implicit();
  bind_loads(scenario, simulation.mesh, simulation.vertices, options);
  simulation.fingerprint.parameters = checksum_of(options, body, start);
  simulation.body = std::make_unique<BackwardEuler>(simulation.mesh.points, body, std::move(options));
}

void set_up_projective(Simplices simplices, const MotionState& start, Simulation& simulation) {
  const Scenario& scenario = simulation.scenario;
  const ProjectiveScenario& method = scenario.projective();
  ProjectiveBody body;
  SimplexMaterials materials = materials_of(scenario, simulation.mesh, simplices);
  body.densities = std::move(materials.densities);
  body.law = local_law_of(materials, method.model, simplices.size());
  body.simplices = std::move(simplices);
  ProjectiveOptions options = static_cast<const ProjectiveOptions&>(method);
  bind_loads(scenario, simulation.mesh, simulation.vertices, options);
  for (const ScenarioObstacle& obstacle : method.obstacles)
    options.contact.obstacles.push_back({obstacle_of(obstacle), obstacle.friction});
  options.contact.reach = kReach * bounding_box(simulation.mesh.points, simulation.vertices).longest_side();
  simulation.fingerprint.parameters = checksum_of(options, method, body, start);
  const std::vector<Point>& points = simulation.mesh.points;
  if (method.precision == MatrixPrecision::single) {
    simulation.body = std::make_unique<ProjectiveDynamics<float>>(points, body, std::move(options));
  } else {
    simulation.body = std::make_unique<ProjectiveDynamics<double>>(points, body, std::move(options));
  }
}

/// Returns the checksum of the settings by which a fluid is ordered.
std::uint64_t checksum_of(const FluidOrdering& ordering) {
  Checksum sum;
  sum.add_all(ordering.vertices);
  sum.add_all(ordering.elements);
  sum.add(ordering.every);
  sum.add(ordering.options.seed);
  sum.add(ordering.options.tolerance);
  sum.add(ordering.options.workload);
  return sum.value();
}

}  // namespace

Mesh mesh_at_start(const Scenario& scenario) {
  const FluidScenario& options = scenario.fluid();
  Particles particles = particles_at_start(options);
  const FluidMesh made = alpha_shape(delaunay_program()(particles.positions), particles.positions,
                                     particles.walls, options.spacing);
  Mesh mesh;
  mesh.points = std::move(particles.positions);
  mesh.cells = made.cells();
  return mesh;
}

Simulation set_up_fluid(Scenario scenario, const OrderOptions& ordering) {
  const Stopwatch setup_time;
  const FluidScenario& options = scenario.fluid();
  const FluidOrdering orders{scenario.vertex_order, scenario.element_order, options.order_every, ordering};
  auto fluid = std::make_unique<Fluid>(options, orders, delaunay_program());
  Simulation result;
  result.mesh.points = fluid->state().positions;
  result.order.vertices.permutation = Permutation::identity(result.mesh.vertex_count());
  result.order.vertices.method.name = scenario.vertex_order;
  result.order.cells.method.name = scenario.element_order;
  result.tetrahedra = fluid->mesh().tetrahedra();
  result.vertices.resize(result.mesh.points.size());
  std::iota(result.vertices.begin(), result.vertices.end(), Index{0});
  result.fingerprint = {checksum_of(result.mesh.points, {}), checksum_of(orders), checksum_of(options)};
  result.body = std::move(fluid);
  result.scenario = std::move(scenario);
  result.setup_seconds = setup_time.seconds();
  return result;
}

void require_volume_cells(const Mesh& mesh, const std::string& file) {
  const int dimension = mesh.cells.highest_dimension();
  const std::vector<Shape>& shapes = mesh.cells.shapes;
  if (std::find(shapes.begin(), shapes.end(), Shape::polyhedron) != shapes.end()) {
    throw InputError(file, "has polyhedra",
                     "cut them into tetrahedra first, in ParaView with Tetrahedralize");
  }
  if (dimension == 3) return;
  throw InputError(
      file, dimension == 2 ? "is a surface: it has no volume cells" : "has no volume cells",
      "a body needs tetrahedra (or hexahedra, wedges, pyramids), with which TetGen or Gmsh fill a "
      "closed surface");
}

Simulation set_up(Scenario scenario, Mesh mesh, const std::string& file, const OrderOptions& ordering) {
  require_volume_cells(mesh, file);
  const Stopwatch ordering_time;
  mesh.cell_blocks.clear();  // blocks are a file's layout and would restrict the order of the cells
  MeshOrder order =
      compute_reordering(mesh, vertex_graph(mesh),
                         {.methods = {scenario.vertex_order, scenario.element_order}, .order = ordering});
  const double seconds = ordering_time.seconds();
  Simulation result = set_up(std::move(scenario), std::move(mesh), file, std::move(order));
  result.order_seconds += seconds;
  return result;
}

Simulation set_up(Scenario scenario, Mesh mesh, const std::string& file, MeshOrder order) {
  require_volume_cells(mesh, file);
  Notes notes;
  Simplices simplices = cut_into_simplices(mesh);
  const std::vector<Index> used = used_vertices(simplices, mesh.vertex_count());
  if (const Index unused = mesh.vertex_count() - index_size(used); unused > 0)
    notes.push_back(fmt::format("{} vertices are corners of no volume cell and take no part", unused));
  place(mesh, used, scenario, file);
  Simulation result;
  result.fingerprint.mesh = checksum_of(mesh.points, simplices);

  const Stopwatch moving_time;
  mesh.cell_blocks.clear();
  apply_reordering(mesh, order);
  result.order_seconds = moving_time.seconds();
  result.order = std::move(order);
  result.fingerprint.order = checksum_of(result.order);

  const Stopwatch setup_time;
  simplices = cut_into_simplices(mesh);
  result.tetrahedra = simplices.size();
  result.vertices = used_vertices(simplices, mesh.vertex_count());
  result.scenario = std::move(scenario);
  result.mesh = std::move(mesh);
  result.notes = std::move(notes);
  const MotionState start = start_of(result.scenario, result.mesh, result.vertices);
  if (result.scenario.is_implicit()) {
    set_up_implicit(std::move(simplices), start, result);
  } else {
    set_up_projective(std::move(simplices), start, result);
  }
  if (!result.scenario.start.empty()) result.body->set_state(start);
  result.setup_seconds = setup_time.seconds();
  return result;
}

}  // namespace meshorder
