// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/projective_dynamics.hpp"

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "kernels/positions.hpp"
#include "lab/motion/mass.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace meshorder {
namespace {

constexpr Index kVertices = 4096;  // of a chunk
/// Largest number of times that the last global step is made; it is repeated while a new contact is violated.
constexpr int kLastRounds = 8;
/// Largest depth that a vertex may keep inside, as a share of ContactOptions::reach.
constexpr double kAllowedDepth = 1e-2;

const ProjectiveOptions& checked(const ProjectiveOptions& options, Index vertex_count) {
  check_options(options, vertex_count);
  require(options.iterations >= 1, "the number of ADMM iterations", options.iterations, "1 or more");
  require(options.tolerance >= 0.0 && options.tolerance < 1.0, "the tolerance of ADMM", options.tolerance,
          "0 or more, and below 1");
  return options;
}

template <class Real>
double squared_distance(std::span<const Real> a, std::span<const Real> b) {
  return sum_over_chunks<double>(static_cast<Index>(a.size()), 4 * kVertices, [&](Index begin, Index end) {
    double sum = 0.0;
    for (Offset i = begin; i < end; ++i) {
      const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
      sum += difference * difference;
    }
    return sum;
  });
}

}  // namespace

template <class Real>
ProjectiveDynamics<Real>::ProjectiveDynamics(std::span<const Point> points, const ProjectiveBody& body,
                                             ProjectiveOptions options)
    : options_(checked(options, index_size(points))),
      masses_(lumped_masses(rest_shapes(body.simplices, points), body.densities, index_size(points))),
      local_(body.law, body.simplices, points),
      system_(local_.stiffness(), masses_, options_.time_step * options_.time_step),
      positions_(padded_positions(points)),
      velocities_(3 * points.size()),
      loads_(velocities_.size()),
      x_(positions_.size()),
      inertia_(positions_.size()),
      right_side_(Offset{kPaddedStride} * local_.room()) {
  if (options_.tolerance > 0.0) last_right_side_ = x_;
  collect_loads(options_, steps_, masses_, loads_, held_);
  system_.hold(held_);
  if (options_.contact.obstacles.empty() && !options_.contact.with_itself) return;
  contacts_.emplace(ContactFinder(body.simplices, points, options_.contact));
  contact_solver_ =
      DualContactSolver<Real>::make(system_.matrix(), system_.factor(), options_.contact_solver);
}

template <class Real>
MotionState ProjectiveDynamics<Real>::state() const {
  MotionState state = state_of(steps_, options_.time_step, positions_, velocities_);
  if (options_.keep_duals && steps_ > 0) {
    const std::vector<Real> duals = local_.duals();
    state.memory.assign(duals.begin(), duals.end());
  }
  return state;
}

template <class Real>
void ProjectiveDynamics<Real>::set_state(const MotionState& state) {
  check_state(state, index_size(masses_));
  if (state.memory.empty() || !options_.keep_duals) {
    local_.reset_duals();
  } else {
    local_.set_duals(std::vector<Real>(state.memory.begin(), state.memory.end()));
  }
  take_state(state, positions_, velocities_);
  steps_ = state.step;
}

template <class Real>
StepReport ProjectiveDynamics<Real>::step() {
  const Stopwatch stopwatch;
  StepReport report;
  collect_loads(options_, steps_, masses_, loads_, held_);
  if (system_.hold(held_) && contacts_)
    contact_solver_ =
        DualContactSolver<Real>::make(system_.matrix(), system_.factor(), options_.contact_solver);
  if (!options_.keep_duals) local_.reset_duals();
  if (contacts_) {
    contacts_->begin(positions_);
    contact_solver_->forget();
    contact_forces_.clear();
  }
  predict();
  const double h = options_.time_step;
  while (report.admm_iterations < options_.iterations) {
    const bool last = report.admm_iterations + 1 == options_.iterations;
    const Stopwatch local_time;
    const LocalResidual residual = local_.pass(x_, static_cast<Real>(h * h), right_side_);
    report.seconds.local += local_time.seconds();
    if (options_.tolerance > 0.0 && has_converged(residual, report)) break;
    ++report.admm_iterations;
    complete_right_side();
    solve(last, report);
  }
  if (contacts_ && report.admm_iterations < options_.iterations) {
    complete_right_side();
    solve(true, report);
  }
  finish(report);
  report.time_step = options_.time_step;
  report.seconds.total = stopwatch.seconds();
  return report;
}

/// Sets the iterate to x̄ and computes M x̄.
template <class Real>
void ProjectiveDynamics<Real>::predict() {
  const double h = options_.time_step;
  for_each_chunk(index_size(masses_), kVertices, [&](Index, Index begin, Index end) {
    for (Offset v = begin; v < end; ++v) {
      const double inverse = masses_[v] > 0.0 ? 1.0 / masses_[v] : 0.0;
      for (int c = 0; c < 3; ++c) {
        const double x = positions_[kPaddedStride * v + c] +
                         h * (velocities_[3 * v + c] + h * inverse * loads_[3 * v + c]);
        x_[kPaddedStride * v + c] = static_cast<Real>(x);
        inertia_[kPaddedStride * v + c] = static_cast<Real>(masses_[v] * x);
      }
    }
  });
  held_.for_each([&](Index v, const Point& velocity) {
    for (int c = 0; c < 3; ++c) {
      x_[Offset{kPaddedStride} * v + c] =
          static_cast<Real>(positions_[Offset{kPaddedStride} * v + c] + h * velocity[c]);
    }
  });
}

/// Sets report.residual to the larger residual of the last iteration, if any was made; `local` is from the
/// local steps after that iteration. Returns whether its residual is within the tolerance; false if none was
/// made.
template <class Real>
bool ProjectiveDynamics<Real>::has_converged(const LocalResidual& local, StepReport& report) {
  const std::span<const Real> forces(right_side_.data(), x_.size());
  if (report.admm_iterations > 0) {
    const AlignedVector<Real> zeros(x_.size(), Real{0});
    const double change = squared_distance<Real>(forces, last_right_side_);
    const double size = squared_distance<Real>(forces, zeros);
    const double dual = size > 0.0 ? std::sqrt(change / size) : 0.0;
    const double primal = local.magnitude > 0.0 ? std::sqrt(local.primal / local.magnitude) : 0.0;
    report.residual = std::max(primal, dual);
  }
  std::copy(forces.begin(), forces.end(), last_right_side_.begin());
  return report.admm_iterations > 0 && report.residual <= options_.tolerance;
}

/// Adds M x̄ and the influence of held vertices to the right-hand side.
template <class Real>
void ProjectiveDynamics<Real>::complete_right_side() {
  for_each_chunk(static_cast<Index>(x_.size()), kPaddedStride * kVertices,
                 [&](Index, Index begin, Index end) {
                   for (Offset i = begin; i < end; ++i) right_side_[i] += inertia_[i];
                 });
  system_.apply_held(x_, right_side_);
}

template <class Real>
void ProjectiveDynamics<Real>::solve(bool last, StepReport& report) {
  if (contacts_) return solve_with_contacts(last, report);
  const Stopwatch global_time;
  system_.factor().solve(std::span<const Real>(right_side_.data(), x_.size()), x_);
  report.seconds.global += global_time.seconds();
}

template <class Real>
void ProjectiveDynamics<Real>::solve_with_contacts(bool last, StepReport& report) {
  const std::span<const Real> right_side(right_side_.data(), x_.size());
  const double allowed = kAllowedDepth * options_.contact.reach;
  for (int round = 0; round < (last ? kLastRounds : 1); ++round) {
    const Stopwatch collision_time;
    const bool is_new = contacts_->update(in_double(), contact_forces_, allowed);
    report.seconds.collision += collision_time.seconds();
    if (round > 0 && !is_new) break;
    const Stopwatch global_time;
    drop_held_contacts();
    const ContactSolveReport solved = contact_solver_->solve(free_contacts_, right_side, positions_, x_);
    spread_forces();
    report.contact_iterations += solved.iterations;
    report.contacts = solved.pushing;
    report.seconds.global += global_time.seconds();
    if (last && !solved.converged) {
      report.residual = solved.residual;
      report.warnings.push_back(
          fmt::format("contacts were left unsolved after {} iterations, at the residual {:.1e}",
                      solved.iterations, solved.residual));
    }
  }
}

/// Returns the iterate in double.
template <class Real>
std::span<const double> ProjectiveDynamics<Real>::in_double() {
  if constexpr (std::is_same_v<Real, double>) {
    return x_;
  } else {
    widened_.assign(x_.begin(), x_.end());
    return widened_;
  }
}

/// Collects the contacts of vertices that are not held; adds held corners of triangles to the offsets.
template <class Real>
void ProjectiveDynamics<Real>::drop_held_contacts() {
  free_contacts_.assign(contacts_->contacts().begin(), contacts_->contacts().end());
  if (held_.vertices().empty()) return;
  std::erase_if(free_contacts_, [&](const Contact& contact) { return system_.is_held(contact.vertices[0]); });
  for (Contact& contact : free_contacts_) {
    for (std::size_t i = 1; i < contact.vertices.size() && contact.is_with_itself(); ++i) {
      const Index v = contact.vertices[i];
      if (!system_.is_held(v)) continue;
      for (int c = 0; c < 3; ++c) {
        contact.offset -=
            contact.weights[i] * contact.normal[c] * static_cast<double>(x_[Offset{kPaddedStride} * v + c]);
      }
      contact.weights[i] = 0.0;
    }
  }
}

/// Stores the solver's forces of all contacts; contacts that were dropped get 0.
template <class Real>
void ProjectiveDynamics<Real>::spread_forces() {
  const std::span<const double> forces = contact_solver_->forces();
  contact_forces_.assign(contacts_->contacts().size(), 0.0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < contact_forces_.size(); ++i) {
    if (!system_.is_held(contacts_->contacts()[i].vertices[0])) contact_forces_[i] = forces[next++];
  }
}

/// Takes the iterate as the new positions.
template <class Real>
void ProjectiveDynamics<Real>::finish(StepReport& report) {
  const auto wrong = std::find_if(x_.begin(), x_.end(), [](Real x) { return !std::isfinite(x); });
  if (wrong != x_.end()) {
    local_.reset_duals();  // the duals are not finite either
    throw InputError(
        fmt::format("step {}", steps_ + 1),
        fmt::format("the motion is not finite at vertex {}", (wrong - x_.begin()) / kPaddedStride),
        "a smaller time step or another material may help");
  }
  const double h = options_.time_step;
  for_each_chunk(index_size(masses_), kVertices, [&](Index, Index begin, Index end) {
    for (Offset v = begin; v < end; ++v) {
      for (int c = 0; c < 3; ++c) {
        const auto x = static_cast<double>(x_[kPaddedStride * v + c]);
        velocities_[3 * v + c] = (x - positions_[kPaddedStride * v + c]) / h;
        positions_[kPaddedStride * v + c] = x;
      }
    }
  });
  // held vertices get their exact velocities, whatever the precision of the iterations
  held_.for_each([&](Index v, const Point& velocity) {
    for (int c = 0; c < 3; ++c) velocities_[Offset{3} * v + c] = velocity[c];
  });
  ++steps_;
  if (!contacts_) return;
  const Stopwatch collision_time;
  const Penetration penetration = contacts_->finder().penetration(positions_);
  report.penetration = penetration.into_obstacles;
  report.vertices_in_itself = penetration.vertices_in_itself;
  report.seconds.collision += collision_time.seconds();
}

template <class Real>
Balance ProjectiveDynamics<Real>::balance() const {
  std::vector<double> momenta(velocities_.size());
  for (std::size_t i = 0; i < momenta.size(); ++i) momenta[i] = masses_[i / 3] * velocities_[i];
  Balance balance = balance_of(masses_, positions_, velocities_, momenta, options_.gravity);
  if constexpr (std::is_same_v<Real, double>) {
    balance.elastic = local_.energy(positions_);
  } else {
    balance.elastic = local_.energy(std::vector<Real>(positions_.begin(), positions_.end()));
  }
  return balance;
}

template <class Real>
std::size_t ProjectiveDynamics<Real>::bytes() const {
  const auto of = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  return local_.bytes() + system_.bytes() + (contacts_ ? contacts_->bytes() + contact_solver_->bytes() : 0) +
         of(masses_) + of(positions_) + of(velocities_) + of(loads_) + of(x_) + of(inertia_) +
         of(right_side_) + of(last_right_side_) + of(widened_) + of(free_contacts_) + of(contact_forces_);
}

template class ProjectiveDynamics<double>;
template class ProjectiveDynamics<float>;

}  // namespace meshorder
