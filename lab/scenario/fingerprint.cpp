// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/fingerprint.hpp"

#include "base/checksum.hpp"

namespace meshorder {
namespace {

void add_selection(const Selection& selection, Checksum& sum) {
  sum.add_all(selection.vertices);
  sum.add(selection.from);
  sum.add(selection.until);
}

void add_motion(const MotionOptions& options, const MotionState& start, Checksum& sum) {
  sum.add(options.time_step);
  sum.add(options.gravity);
  for (const VertexForce& force : options.forces) {
    add_selection(force, sum);
    sum.add(force.newtons);
  }
  sum.add(options.forces.size());
  for (const PrescribedMotion& motion : options.prescribed) {
    add_selection(motion, sum);
    sum.add(motion.velocity);
  }
  sum.add_all(start.positions);
  sum.add_all(start.velocities);
}

void add_obstacle(const ScenarioObstacle& obstacle, Checksum& sum) {
  sum.add(obstacle.kind);
  sum.add(obstacle.place);
  sum.add(obstacle.direction);
  for (const double number : {obstacle.radius, obstacle.thickness, obstacle.opening, obstacle.friction})
    sum.add(number);
  if (!obstacle.file.empty()) sum.add_all(FilePath::in(obstacle.folder, obstacle.file).read());
}

}  // namespace

std::uint64_t checksum_of(const std::vector<Point>& points, const Simplices& simplices) {
  Checksum sum;
  sum.add_all(points);
  sum.add_all(simplices.vertices);
  return sum.value();
}

std::uint64_t checksum_of(const MeshOrder& order) {
  Checksum sum;
  sum.add_all(order.vertices.permutation.old_to_new());
  sum.add_all(order.cells.permutation.old_to_new());
  return sum.value();
}

std::uint64_t checksum_of(const FluidOptions& options) {
  Checksum sum;
  for (const Point& vector : {options.gravity, options.basin, options.column}) sum.add(vector);
  for (const double number :
       {options.time_step, options.spacing, options.jitter, options.wave, options.density, options.viscosity,
        options.courant, options.evening, options.volume_gain, options.solve.tolerance})
    sum.add(number);
  sum.add(options.solve.max_iterations);
  sum.add(options.lid);
  return sum.value();
}

std::uint64_t checksum_of(const ImplicitOptions& options, const Body& body, const MotionState& start) {
  Checksum sum;
  add_motion(options, start, sum);
  for (const double number :
       {options.mass_damping, options.stiffness_damping, options.newton_tolerance, options.solve.tolerance})
    sum.add(number);
  for (const int number : {options.newton_iterations, options.solve.max_iterations}) sum.add(number);
  sum.add(options.mass);
  sum.add(options.preconditioner);
  sum.add(options.precision);
  sum.add(body.elasticity.model);
  sum.add(body.elasticity.tangent);
  sum.add(body.elasticity.lame.mu);
  sum.add(body.elasticity.lame.lambda);
  sum.add_all(body.elasticity.mu);
  sum.add_all(body.elasticity.lambda);
  sum.add_all(body.densities);
  return sum.value();
}

std::uint64_t checksum_of(const ProjectiveOptions& options, const ProjectiveScenario& scenario,
                          const ProjectiveBody& body, const MotionState& start) {
  Checksum sum;
  add_motion(options, start, sum);
  sum.add(options.iterations);
  sum.add(options.tolerance);
  sum.add(options.keep_duals);
  sum.add(0);  // defaults of removed options, here and below, so that fingerprints stay valid
  for (const ScenarioObstacle& obstacle : scenario.obstacles) add_obstacle(obstacle, sum);
  sum.add(options.contact.with_itself);
  sum.add(options.contact.friction_with_itself);
  sum.add(options.contact.reach);
  sum.add(0);
  sum.add(options.contact_solver.tolerance);
  sum.add(options.contact_solver.max_iterations);
  sum.add(1.9);
  sum.add(scenario.precision);
  sum.add(body.law.model);
  for (const double number : {body.law.stiffness, body.law.lame.mu, body.law.lame.lambda}) sum.add(number);
  for (const auto* numbers : {&body.law.stiffnesses, &body.law.mu, &body.law.lambda, &body.densities})
    sum.add_all(*numbers);
  return sum.value();
}

}  // namespace meshorder
