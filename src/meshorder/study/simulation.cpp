// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/base/stopwatch.hpp>
#include <meshorder/mesh/graphs.hpp>
#include <meshorder/mesh/grouping.hpp>
#include <meshorder/mesh/reorder.hpp>
#include <meshorder/study/simulation.hpp>
#include <meshorder/study/vertex_choice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>
#include <utility>

namespace meshorder {
namespace {

/// FNV-1a (Fowler, Noll, Vo) over 64-bit words.
class Checksum {
 public:
  template <class Number>
  void add(Number number) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    if constexpr (std::is_floating_point_v<Number>) {
      mix(std::bit_cast<std::uint64_t>(static_cast<double>(number)));
    } else {
      mix(static_cast<std::uint64_t>(number));
    }
  }
  void add(const Point& point) {
    for (const double x : point) add(x);
  }
  template <class Range>
  void add_all(const Range& range) {
    add(range.size());
    for (const auto& entry : range) add(entry);
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void mix(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001B3U ^ (value_ >> 32U); }

  std::uint64_t value_ = 0xCBF29CE484222325U;
};

std::uint64_t checksum_of(const std::vector<Point>& points, const Simplices& simplices) {
  Checksum sum;
  sum.add_all(points);
  sum.add_all(simplices.vertices);
  return sum.value();
}

std::uint64_t checksum_of(const Reordering& order) {
  Checksum sum;
  sum.add_all(order.vertices.old_to_new());
  sum.add_all(order.cells.old_to_new());
  return sum.value();
}

std::uint64_t checksum_of(const ImplicitOptions& options, const Body& body) {
  Checksum sum;
  for (const double number : {options.time_step, options.mass_damping, options.stiffness_damping,
                              options.newton_tolerance, options.solve.tolerance})
    sum.add(number);
  for (const int number : {options.newton_iterations, options.solve.max_iterations}) sum.add(number);
  sum.add(options.mass);
  sum.add(options.preconditioner);
  sum.add(options.precision);
  sum.add(options.gravity);
  const auto add_selection = [&](const Selection& selection) {
    sum.add_all(selection.vertices);
    sum.add(selection.from);
    sum.add(selection.until);
  };
  for (const VertexForce& force : options.forces) {
    add_selection(force);
    sum.add(force.newtons);
  }
  sum.add(options.forces.size());
  for (const PrescribedMotion& motion : options.prescribed) {
    add_selection(motion);
    sum.add(motion.velocity);
  }
  sum.add(body.elasticity.model);
  sum.add(body.elasticity.tangent);
  sum.add(body.elasticity.lame.mu);
  sum.add(body.elasticity.lame.lambda);
  sum.add_all(body.elasticity.mu);
  sum.add_all(body.elasticity.lambda);
  sum.add_all(body.densities);
  return sum.value();
}

/// The vertices that simplices use, rising.
std::vector<Index> used_vertices(const Simplices& simplices, Index vertex_count) {
  std::vector<char> used(vertex_count, 0);
  for (const Index v : simplices.vertices) used[v] = 1;
  std::vector<Index> result;
  for (Index v = 0; v < vertex_count; ++v) {
    if (used[v] != 0) result.push_back(v);
  }
  return result;
}

/// Puts the times of the steps, between which no rounding can move them, into a selection.
void set_times(const StepRange& steps, double time_step, Selection& selection) {
  selection.from = (steps.first - 1.5) * time_step;
  if (steps.last < kMaxIndex) selection.until = (steps.last - 0.5) * time_step;
}

/// Scales the mesh so that the longest side of the box around `vertices` becomes `length`.
void scale(Mesh& mesh, std::span<const Index> vertices, double length, const std::string& file) {
  const double factor = length / bounding_box(mesh.points, vertices).longest_side();
  if (!std::isfinite(factor) || !(factor > 0.0))
    throw Error(file, "its volume cells have no extent", "give a mesh with a volume");
  for (Point& point : mesh.points) {
    for (double& x : point) x *= factor;
  }
}

/// Throws Error that names the scenario's file for regions that the mesh has not.
SimplexMaterials materials_of(const Scenario& scenario, const Mesh& mesh, const Simplices& simplices) {
  if (scenario.regions.empty()) return uniform_material(scenario.material);
  try {
    return materials_by_region(simplices, grouping_by(mesh, scenario.regions_by), scenario.material,
                               scenario.regions);
  } catch (const InvalidArgument& error) {
    throw Error(scenario.file, std::string("material.regions: ") + error.what(),
                "name groups that the mesh has");
  }
}

Body body_of(const Scenario& scenario, const Mesh& mesh, Simplices simplices) {
  Body body;
  SimplexMaterials materials = materials_of(scenario, mesh, simplices);
  body.densities = std::move(materials.densities);
  body.elasticity = elasticity_of(std::move(materials), scenario.model, scenario.tangent);
  body.simplices = std::move(simplices);
  return body;
}

ImplicitOptions bound(const Scenario& scenario, const Mesh& mesh, std::span<const Index> candidates) {
  ImplicitOptions options = scenario.integrator;
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
  return options;
}

}  // namespace

void require_volume_cells(const Mesh& mesh, const std::string& file) {
  const int dimension = mesh.cells.highest_dimension();
  if (dimension == 3) return;
  throw Error(file, dimension == 2 ? "is a surface: it has no volume cells" : "has no volume cells",
              "a body needs tetrahedra (or hexahedra, wedges, pyramids), with which TetGen or Gmsh fill a "
              "closed surface");
}

Simulation set_up(Scenario scenario, Mesh mesh, const std::string& file, const OrderingOptions& ordering) {
  require_volume_cells(mesh, file);
  Notes notes;
  Simplices simplices = cut_into_simplices(mesh);
  std::vector<Index> used = used_vertices(simplices, mesh.vertex_count());
  if (const Index unused = mesh.vertex_count() - index_size(used); unused > 0)
    notes.push_back(fmt::format("{} vertices are corners of no volume cell and take no part", unused));
  if (scenario.longest_side > 0) scale(mesh, used, scenario.longest_side, file);
  Fingerprint fingerprint;
  fingerprint.mesh = checksum_of(mesh.points, simplices);

  const Stopwatch ordering_time;
  mesh.cell_blocks.clear();  // they are a file's layout, and would keep cells from their places
  Reordering order = compute_reordering(mesh, vertex_graph(mesh),
                                        {scenario.vertex_order, scenario.element_order, ordering, {}});
  reorder(mesh, order.vertices, order.cells);
  const double order_seconds = ordering_time.seconds();
  fingerprint.order = checksum_of(order);

  const Stopwatch setup_time;
  simplices = cut_into_simplices(mesh);
  used = used_vertices(simplices, mesh.vertex_count());
  const Offset tetrahedra = simplices.size();
  const Body body = body_of(scenario, mesh, std::move(simplices));
  const ImplicitOptions options = bound(scenario, mesh, used);
  fingerprint.parameters = checksum_of(options, body);
  auto integrator = std::make_unique<BackwardEuler>(mesh.points, body, options);
  const double setup_seconds = setup_time.seconds();
  return {std::move(scenario), std::move(mesh),  std::move(order), tetrahedra,   std::move(integrator),
          fingerprint,         std::move(notes), order_seconds,    setup_seconds};
}

}  // namespace meshorder
