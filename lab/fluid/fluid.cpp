// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/fluid/fluid.hpp"

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "ordering/reorderer_state.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace meshorder {
namespace {

constexpr double kMostVolumeGain = 0.02;  ///< most volume that a step restores, as a share of the volume
constexpr double kReach = 1.3;            ///< distance within which particles are moved apart, in spacings

/// Sets to 0 the components that point through a particle's walls.
void hold(Walls walls, Point& vector) {
  for (int axis = 0; axis < 3; ++axis) {
    if (is_held(walls, axis)) vector[axis] = 0;
  }
}

template <class T>
void move_rows(const Permutation& order, std::vector<T>& rows) {
  if (rows.empty()) return;
  std::vector<T> moved(rows.size());
  order.move(rows, moved);
  rows = std::move(moved);
}

/// Throws InvalidArgument unless `memory` is that of a state of n particles: their pressures, walls and
/// numbers, the last time step, and the bytes of the order's state.
void check_memory(std::span<const double> memory, std::size_t n) {
  const auto all_within = [&](std::size_t begin, std::size_t end, double least, double most) {
    return std::all_of(memory.begin() + static_cast<std::ptrdiff_t>(begin),
                       memory.begin() + static_cast<std::ptrdiff_t>(end),
                       [&](double x) { return x >= least && x <= most; });
  };
  constexpr double kMost = std::numeric_limits<double>::max();
  if (memory.size() > 3 * n && all_within(0, n, -kMost, kMost) && all_within(n, 2 * n, 0, 63) &&
      all_within(2 * n, 3 * n, 0, static_cast<double>(n) - 1) && all_within(3 * n, 3 * n + 1, 0, kMost) &&
      all_within(3 * n + 1, memory.size(), 0, 255))
    return;
  throw InvalidArgument("the state is not one of this fluid");
}

void note(const char* whose, const SolveReport& solved, StepReport& report) {
  report.cg_iterations += solved.iterations;
  if (solved.status == SolveStatus::converged) return;
  report.warnings.push_back(fmt::format("{} solver ended after {} iterations: {}", whose, solved.iterations,
                                        to_string(solved.status)));
}

/// Calls `work(i)` for i = 0 … n − 1, on all threads.
template <class Work>
void for_each(std::size_t n, const Work& work) {
  for_each_chunk(static_cast<Index>(n), kParticlesInChunk, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) work(static_cast<std::size_t>(i));
  });
}

}  // namespace

Fluid::Fluid(const FluidOptions& options, FluidOrdering ordering, Triangulate triangulate)
    : Fluid(options, particles_at_start(options), std::move(ordering), std::move(triangulate)) {}

Fluid::Fluid(const FluidOptions& options, Particles particles, FluidOrdering ordering,
             Triangulate triangulate)
    : options_(options),
      triangulate_(std::move(triangulate)),
      order_(std::move(ordering)),
      positions_(std::move(particles.positions)),
      velocities_(positions_.size(), Point{}),
      pressures_(positions_.size(), 0),
      walls_(std::move(particles.walls)),
      numbers_(positions_.size()) {
  check_options(options);
  std::iota(numbers_.begin(), numbers_.end(), Index{0});
  make_mesh();
  system_ = assemble(mesh_, positions_);
  shares_ = system_.masses;
  volume_ = volume_at_start_ = std::accumulate(shares_.begin(), shares_.end(), 0.0);
  const double gravity = norm(options_.gravity);
  if (!(gravity > 0)) return;
  // the first pressures are hydrostatic below the highest particle, whatever the shape of the free surface
  double top = 0;
  for (const Point& x : positions_) top = std::max(top, -dot(x, options_.gravity) / gravity);
  for (std::size_t i = 0; i < positions_.size(); ++i)
    pressures_[i] = options_.density * (gravity * top + dot(positions_[i], options_.gravity));
}

MotionState Fluid::state() const {
  const std::size_t n = positions_.size();
  MotionState state{
      .step = steps_, .time = time_, .positions = std::vector<Point>(n), .velocities = std::vector<Point>(n)};
  const std::vector<std::byte> order = order_.state();
  state.memory.resize(3 * n + 1 + order.size());
  for (std::size_t i = 0; i < n; ++i) {
    const auto particle = static_cast<std::size_t>(numbers_[i]);
    state.positions[particle] = positions_[i];
    state.velocities[particle] = velocities_[i];
    state.memory[particle] = pressures_[i];
    state.memory[n + particle] = walls_[i];
    state.memory[2 * n + i] = numbers_[i];
  }
  state.memory[3 * n] = last_time_step_;
  std::ranges::transform(order, state.memory.begin() + static_cast<std::ptrdiff_t>(3 * n + 1),
                         [](std::byte byte) { return static_cast<double>(std::to_integer<int>(byte)); });
  return state;
}

void Fluid::set_state(const MotionState& state) {
  const std::size_t n = positions_.size();
  check_state(state, static_cast<Index>(n));
  check_memory(state.memory, n);
  std::vector<Index> numbers(n);
  for (std::size_t i = 0; i < n; ++i) numbers[i] = static_cast<Index>(state.memory[2 * n + i]);
  (void)Permutation::from_new_to_old(IndexView(numbers));  // throws unless each number occurs once
  std::vector<std::byte> order(state.memory.size() - 3 * n - 1);
  std::transform(state.memory.begin() + static_cast<std::ptrdiff_t>(3 * n + 1), state.memory.end(),
                 order.begin(), [](double byte) { return static_cast<std::byte>(byte); });
  const ReordererState kept = reorderer_state(order);
  if (kept.begun != 0 && std::cmp_not_equal(kept.count, n))
    throw InvalidArgument("the state is not one of this fluid");
  order_.restore(order);
  std::vector<double> shares(n);
  for (std::size_t i = 0; i < n; ++i) shares[static_cast<std::size_t>(numbers_[i])] = shares_[i];
  numbers_ = std::move(numbers);
  steps_ = state.step;
  time_ = state.time;
  last_time_step_ = state.memory[3 * n];
  for (std::size_t i = 0; i < n; ++i) {
    const auto particle = static_cast<std::size_t>(numbers_[i]);
    positions_[i] = state.positions[particle];
    velocities_[i] = state.velocities[particle];
    pressures_[i] = state.memory[particle];
    walls_[i] = static_cast<Walls>(state.memory[n + particle]);
    shares_[i] = shares[particle];
  }
  make_mesh();
  assemble_system();
}

void Fluid::assemble_system() {
  system_ = assemble(mesh_, positions_);
  volume_ = volume_at_start_ = 0;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    volume_ += system_.masses[i];
    if (mesh_.alone[i] == 0) volume_at_start_ += shares_[i];
  }
}

void Fluid::make_mesh() {
  mesh_ = alpha_shape(triangulate_(positions_), positions_, walls_, options_.spacing);
}

void Fluid::reorder() {
  if (const auto order = order_.particles(steps_, mesh_, positions_)) {
    move_rows(*order, positions_);
    move_rows(*order, velocities_);
    move_rows(*order, pressures_);
    move_rows(*order, walls_);
    move_rows(*order, numbers_);
    move_rows(*order, shares_);
    move_rows(*order, mesh_.alone);
    move_rows(*order, mesh_.free);
    order->renumber(mesh_.corners);
  }
  order_.sort(mesh_, positions_);
}

double Fluid::next_time_step() const {
  double fastest = 0;
  for (const Point& u : velocities_) fastest = std::max(fastest, dot(u, u));
  double dt = options_.time_step;
  if (fastest > 0) dt = std::min(dt, options_.courant * options_.spacing / std::sqrt(fastest));
  const double gravity = norm(options_.gravity);
  if (gravity > 0) dt = std::min(dt, 0.25 * std::sqrt(options_.spacing / gravity));
  return dt;
}

/// Solves (M + τν K) u' = M u for each component, with τ = `kick`.
void Fluid::add_viscosity(double kick, StepReport& report) {
  const std::size_t n = positions_.size();
  std::vector<std::uint8_t> held(n);
  std::vector<double> old(n);
  std::vector<double> next(n);
  for (int axis = 0; axis < 3; ++axis) {
    for_each(n, [&](std::size_t i) {
      held[i] = mesh_.alone[i] != 0 || is_held(walls_[i], axis) ? 1 : 0;
      next[i] = velocities_[i][axis];
      old[i] = system_.masses[i] * next[i];
    });
    const SolveReport solved =
        meshorder::solve(system_, kick * options_.viscosity, 1, held, old, next, options_.solve);
    note("the viscosity's", solved, report);
    for_each(n, [&](std::size_t i) { velocities_[i][axis] = next[i]; });
  }
}

/// Finds the pressure and makes the velocities free of divergence.
void Fluid::project(double kick, double dt, StepReport& report) {
  Stopwatch stopwatch;
  std::vector<double> b = divergence(mesh_, positions_, velocities_);
  const bool has_surface = std::ranges::find(mesh_.free, 1) != mesh_.free.end();
  // a uniform source restores lost volume
  const double lost = has_surface && volume_ > 0 ? (volume_at_start_ - volume_) / volume_ : 0;
  const double source = std::clamp(options_.volume_gain * lost, -kMostVolumeGain, kMostVolumeGain) / dt;
  const double scale = options_.density / kick;
  for_each(b.size(), [&](std::size_t i) {
    b[i] = scale * (b[i] + source * system_.masses[i]);
    if (mesh_.free[i] != 0) pressures_[i] = 0;
  });
  report.seconds.assembly += stopwatch.seconds();
  stopwatch = {};
  const SolveReport solved = meshorder::solve(system_, 1, 0, mesh_.free, b, pressures_, options_.solve);
  report.seconds.solve += stopwatch.seconds();
  note("the pressure's", solved, report);
  report.residual = solved.residual;
  stopwatch = {};
  const std::vector<Point> force = gradient(mesh_, positions_, pressures_);
  for_each(force.size(), [&](std::size_t i) {
    if (system_.masses[i] > 0)
      velocities_[i] = plus_scaled(velocities_[i], -kick / (options_.density * system_.masses[i]), force[i]);
    hold(walls_[i], velocities_[i]);
  });
  report.seconds.motion += stopwatch.seconds();
}

/// Returns the shifts of inner particles, m, which make the distances between particles more even.
std::vector<Point> Fluid::evening() const {
  const std::span<const Offset> offsets = system_.pattern.offsets();
  const std::span<const Index> neighbours = system_.pattern.neighbours();
  std::vector<Point> shifts(positions_.size(), Point{});
  for_each(positions_.size(), [&](std::size_t i) {
    if (mesh_.free[i] != 0 || !(system_.masses[i] > 0)) return;
    Point push{};
    for (Offset k = offsets[i]; k < offsets[i + 1]; ++k) {
      const Point away = minus(positions_[i], positions_[neighbours[k]]);
      const double distance = norm(away);
      const double nearness = std::max(0.0, kReach - distance / options_.spacing);
      if (nearness > 0 && distance > 0) push = plus_scaled(push, nearness * nearness / distance, away);
    }
    for (double& x : push) x = std::clamp(2 * x, -1.0, 1.0) * options_.evening * options_.spacing;
    hold(walls_[i], push);
    shifts[i] = push;
  });
  return shifts;
}

void Fluid::move(double dt) {
  std::vector<Point> shifts;
  std::vector<std::array<Point, 3>> gradients;
  if (options_.evening > 0) {
    shifts = evening();
    gradients = gradient(mesh_, positions_, velocities_);
  }
  for_each(positions_.size(), [&](std::size_t i) {
    positions_[i] = plus_scaled(positions_[i], dt, velocities_[i]);
    if (options_.evening > 0 && system_.masses[i] > 0) {
      positions_[i] = plus_scaled(positions_[i], 1, shifts[i]);
      for (int c = 0; c < 3; ++c) velocities_[i][c] += dot(gradients[i][c], shifts[i]) / system_.masses[i];
    }
    keep_inside(options_, positions_[i], walls_[i]);
    hold(walls_[i], velocities_[i]);
  });
}

void Fluid::check_finite() const {
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (!is_finite(positions_[i]) || !is_finite(velocities_[i]))
      throw InputError(fmt::format("particle {}", numbers_[i]), "its motion is not finite",
                       "give a smaller courant number");
  }
}

StepReport Fluid::step() {
  const Stopwatch whole;
  StepReport report;
  make_mesh();
  report.seconds.triangulation = whole.seconds();
  Stopwatch stopwatch;
  reorder();
  report.seconds.order = stopwatch.seconds();
  stopwatch = {};
  assemble_system();
  report.seconds.assembly = stopwatch.seconds();
  const double dt = next_time_step();
  const double kick =
      (last_time_step_ + dt) / 2;  // from the middle of the last step to the middle of this step
  const auto before = std::tuple(positions_, velocities_, pressures_, walls_);
  stopwatch = {};
  if (options_.viscosity > 0) add_viscosity(kick, report);
  // particles on walls are not held: pressure balances gravity there, too
  for_each(velocities_.size(),
           [&](std::size_t i) { velocities_[i] = plus_scaled(velocities_[i], kick, options_.gravity); });
  report.seconds.solve = stopwatch.seconds();
  project(kick, dt, report);
  stopwatch = {};
  move(dt);
  report.seconds.motion += stopwatch.seconds();
  try {
    check_finite();
  } catch (...) {
    std::tie(positions_, velocities_, pressures_, walls_) = before;
    throw;
  }
  time_ += dt;
  last_time_step_ = report.time_step = dt;
  ++steps_;
  report.seconds.total = whole.seconds();
  return report;
}

Balance Fluid::balance() const {
  const std::size_t n = positions_.size();
  Balance balance;
  for (std::size_t i = 0; i < n; ++i) {
    const double mass = options_.density * (mesh_.alone[i] != 0 ? shares_[i] : system_.masses[i]);
    const Point& x = positions_[i];
    const Point& u = velocities_[i];
    balance.kinetic += mass / 2 * dot(u, u);
    balance.potential -= mass * dot(options_.gravity, x);
    balance.momentum = plus_scaled(balance.momentum, mass, u);
    balance.angular_momentum = plus_scaled(balance.angular_momentum, mass, cross(x, u));
  }
  return balance;
}

std::size_t Fluid::bytes() const {
  const auto of = [](const auto& rows) { return rows.size() * sizeof(rows[0]); };
  return of(positions_) + of(velocities_) + of(pressures_) + of(walls_) + of(numbers_) + of(shares_) +
         of(mesh_.corners) + of(mesh_.alone) + of(mesh_.free) + of(system_.values) + of(system_.diagonal) +
         of(system_.masses) + of(system_.pattern.offsets()) + of(system_.pattern.neighbours());
}

}  // namespace meshorder
