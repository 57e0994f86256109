// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/implicit/backward_euler.hpp"

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "kernels/block_csr.hpp"
#include "kernels/half_block_csr.hpp"
#include "kernels/positions.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kVerticesPerChunk = 4096;

double inner_product(std::span<const double> a, std::span<const double> b) {
  const auto vertices = static_cast<Index>(a.size() / 3);
  return sum_over_chunks<double>(vertices, kVerticesPerChunk, [&](Index begin, Index end) {
    double sum = 0.0;
    for (Offset i = Offset{3} * begin; i < Offset{3} * end; ++i) sum += a[i] * b[i];
    return sum;
  });
}

double norm(std::span<const double> a) { return std::sqrt(inner_product(a, a)); }

void check_options(const ImplicitOptions& options, Index vertex_count) {
  check_options(static_cast<const MotionOptions&>(options), vertex_count);
  require(options.mass_damping >= 0.0 && std::isfinite(options.mass_damping), "Rayleigh's alpha",
          options.mass_damping, "0 or more");
  require(options.stiffness_damping >= 0.0 && std::isfinite(options.stiffness_damping), "Rayleigh's beta",
          options.stiffness_damping, "0 or more");
  require(options.newton_iterations >= 1, "the number of Newton iterations", options.newton_iterations,
          "1 or more");
  require(options.newton_tolerance > 0.0 && options.newton_tolerance < 1.0, "Newton's tolerance",
          options.newton_tolerance, "between 0 and 1");
}

}  // namespace

/// State of Newton's method: v, the gradient at v and the next step.
struct BackwardEuler::Iterate {
  std::vector<double> velocities;
  std::vector<double> gradient;  ///< 0 at held vertices
  std::vector<double> step;      ///< CG's first guess, then its result
  std::vector<double> right_side;
};

BackwardEuler::BackwardEuler(std::span<const Point> points, const Body& body, ImplicitOptions options)
    : options_(std::move(options)),
      system_(points, body, options_.mass),
      stores_half_(half_storage_pays(system_.matrix())),
      positions_(padded_positions(points)),
      velocities_(3 * points.size()),
      loads_(velocities_.size()),
      moved_(positions_),
      scratch_(velocities_.size()) {
  check_options(options_, index_size(points));
  preconditioner_ = make_preconditioner(options_.preconditioner, system_.matrix(), points);
  const bool moves = std::any_of(options_.prescribed.begin(), options_.prescribed.end(),
                                 [](const PrescribedMotion& p) { return p.velocity != Point{}; });
  if (options_.stiffness_damping > 0.0 && (options_.newton_iterations > 1 || moves)) {
    damping_ = system_.matrix();
  }
  // a preconditioner may keep parts of its first matrix: that matrix must not depend on where a run resumes
  StepReport report;
  collect_loads(options_, steps_, system_.mass().vertices, loads_, held_);
  assemble(0, system_.elasticity().tangent, report);
  preconditioner_->update(system_.matrix());
}

MotionState BackwardEuler::state() const {
  return state_of(steps_, options_.time_step, positions_, velocities_);
}

void BackwardEuler::set_state(const MotionState& state) {
  check_state(state, system_.vertex_count());
  // copied into the old arrays, which are at a distance from the forces in memory (see kApart)
  take_state(state, positions_, velocities_);
  steps_ = state.step;
}

StepReport BackwardEuler::step() {
  const Stopwatch stopwatch;
  StepReport report;
  collect_loads(options_, steps_, system_.mass().vertices, loads_, held_);
  const bool newton = options_.newton_iterations > 1;
  Iterate iterate;
  iterate.velocities.assign(velocities_.size(), 0.0);
  iterate.gradient = iterate.step = iterate.velocities;
  held_.set(iterate.velocities);
  double at_rest = 0.0;
  for (Index k = 0;; ++k) {
    const bool last = k == options_.newton_iterations;
    if (last && !newton) break;
    move_to(iterate.velocities);
    last ? system_.compute_forces(moved_) : assemble(k, system_.elasticity().tangent, report);
    compute_gradient(iterate);
    const double residual = norm(iterate.gradient);
    if (k == 0) at_rest = residual;
    if (newton) report.newton_residual = residual > 0.0 ? residual / at_rest : 0.0;
    if (residual == 0.0 || (newton && residual <= options_.newton_tolerance * at_rest)) break;
    if (last) {
      report.warnings.push_back(fmt::format(
          "Newton's method stopped after {} iterations at the residual {:.1e}, largest at vertex {}", k,
          report.newton_residual, largest_vertex(iterate.gradient)));
      break;
    }
    // for the first iterate, CG starts from the velocities of the last step
    if (k == 0) {
      iterate.step = velocities_;
      held_.set_zero(iterate.step);
    } else {
      std::fill(iterate.step.begin(), iterate.step.end(), 0.0);
    }
    solve(iterate, report);
    ++report.newton_iterations;
    if (newton && !search_line(iterate, report)) break;
    for (std::size_t i = 0; i < iterate.step.size(); ++i) iterate.velocities[i] += iterate.step[i];
  }
  move_to(iterate.velocities);
  std::swap(positions_, moved_);
  std::swap(velocities_, iterate.velocities);
  ++steps_;
  report.time_step = options_.time_step;
  report.seconds.total = stopwatch.seconds();
  return report;
}

/// Sets moved_ to xₙ + h v.
void BackwardEuler::move_to(std::span<const double> velocities) {
  for_each_chunk(system_.vertex_count(), kVerticesPerChunk, [&](Index, Index begin, Index end) {
    for (Offset v = begin; v < end; ++v) {
      for (int c = 0; c < 3; ++c) {
        moved_[kPaddedStride * v + c] =
            positions_[kPaddedStride * v + c] + options_.time_step * velocities[3 * v + c];
      }
    }
  });
}

/// Assembles the matrix M + hC + h²K at `moved_`, without the held vertices.
void BackwardEuler::assemble(Index iteration, Tangent tangent, StepReport& report) {
  const Stopwatch stopwatch;
  const double h = options_.time_step;
  const double damping = h * options_.stiffness_damping;
  const double mass_factor = 1.0 + h * options_.mass_damping;
  if (damping_.size() == 0) {
    system_.assemble(moved_, tangent, mass_factor, h * h + damping);
  } else {
    if (iteration == 0) {
      system_.assemble(moved_, tangent, 0.0, damping);
      damping_.values = system_.matrix().values;
    }
    system_.assemble(moved_, tangent, mass_factor, h * h, &damping_);
  }
  held_.remove_from(system_.matrix());
  report.seconds.assembly += stopwatch.seconds();
}

/// Computes g(v) = M(v − vₙ) − h(f_ext − f_int) + h C v, with f_int from the system.
void BackwardEuler::compute_gradient(Iterate& iterate) {
  const double h = options_.time_step;
  std::vector<double>& g = iterate.gradient;
  const std::vector<double>& v = iterate.velocities;
  for (std::size_t i = 0; i < g.size(); ++i) {
    scratch_[i] = (1.0 + h * options_.mass_damping) * v[i] - velocities_[i];
  }
  multiply(system_.mass(), system_.matrix(), scratch_, g);
  if (damping_.size() > 0) {
    multiply(damping_, v, scratch_);
    for (std::size_t i = 0; i < g.size(); ++i) g[i] += scratch_[i];
  }
  const std::span<const double> forces = system_.forces();
  for_each_chunk(system_.vertex_count(), kVerticesPerChunk, [&](Index, Index begin, Index end) {
    for (Offset vertex = begin; vertex < end; ++vertex) {
      for (int c = 0; c < 3; ++c) {
        g[3 * vertex + c] -= h * (loads_[3 * vertex + c] + forces[kPaddedStride * vertex + c]);
      }
    }
  });
  held_.set_zero(g);
}

/// Returns ½(v − vₙ)ᵀM(v − vₙ) + E(xₙ + h v) − h f_extᵀv + ½h vᵀC v, whose gradient is g.
double BackwardEuler::potential(std::span<const double> velocities) {
  const double h = options_.time_step;
  std::vector<double> difference(velocities.begin(), velocities.end());
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= velocities_[i];
  multiply(system_.mass(), system_.matrix(), difference, scratch_);
  double sum = 0.5 * inner_product(difference, scratch_);
  if (options_.mass_damping > 0.0) {
    multiply(system_.mass(), system_.matrix(), velocities, scratch_);
    sum += 0.5 * h * options_.mass_damping * inner_product(velocities, scratch_);
  }
  if (damping_.size() > 0) {
    multiply(damping_, velocities, scratch_);
    sum += 0.5 * inner_product(velocities, scratch_);
  }
  move_to(velocities);
  return sum - h * inner_product(loads_, velocities) +
         elastic_energy(system_.rest(), system_.elasticity(), moved_);
}

SolveReport BackwardEuler::solve_once(Iterate& iterate, StepReport& report) {
  const Stopwatch stopwatch;
  preconditioner_->update(system_.matrix());
  const auto solve_with = [&](const auto& matrix) {
    return conjugate_gradients(matrix, *preconditioner_, iterate.right_side, iterate.step, options_.solve);
  };
  const auto solve_with_rounded = [&](const auto& rounded) {
    return refined_conjugate_gradients(system_.matrix(), rounded, *preconditioner_, iterate.right_side,
                                       iterate.step, options_.solve);
  };
  SolveReport solved;
  if (options_.precision == MatrixPrecision::double_) {
    if (stores_half_) store_half(system_.matrix(), half_);
    solved = stores_half_ ? solve_with(half_) : solve_with(system_.matrix());
  } else if (stores_half_) {
    store_half(system_.matrix(), rounded_half_);
    solved = solve_with_rounded(rounded_half_);
  } else {
    round_to_single(system_.matrix(), rounded_);
    solved = solve_with_rounded(rounded_);
  }
  report.cg_iterations += solved.iterations;
  report.residual = solved.residual;
  report.seconds.solve += stopwatch.seconds();
  return solved;
}

/// Solves A δ = −g; δ is `iterate.step`, on entry the first guess.
void BackwardEuler::solve(Iterate& iterate, StepReport& report) {
  iterate.right_side.resize(iterate.gradient.size());
  std::transform(iterate.gradient.begin(), iterate.gradient.end(), iterate.right_side.begin(),
                 [](double g) { return -g; });
  const std::vector<double> start = iterate.step;
  SolveReport solved = solve_once(iterate, report);
  if (solved.status == SolveStatus::negative_curvature &&
      system_.elasticity().tangent != Tangent::projected) {
    report.warnings.push_back(fmt::format(
        "the matrix is not positive definite (iteration {} of CG, largest residual at vertex {}): "
        "the step was taken with the tangent's semi-definite part",
        solved.iterations, solved.vertex));
    assemble(report.newton_iterations, Tangent::projected, report);
    iterate.step = start;
    solved = solve_once(iterate, report);
  }
  if (solved.status == SolveStatus::not_finite) {
    throw InputError(fmt::format("step {}", steps_ + 1),
                     fmt::format("the equations are not finite at vertex {}", solved.vertex),
                     "a smaller time step or another material may help");
  }
  if (solved.status != SolveStatus::converged) {
    report.warnings.push_back(
        fmt::format("CG ended after {} iterations at the residual {:.1e}: {}, largest at "
                    "vertex {}",
                    solved.iterations, solved.residual, to_string(solved.status), solved.vertex));
  }
}

/// Shortens the step until the potential decreases (Armijo). If no length decreases the potential, adds a
/// warning and returns false.
bool BackwardEuler::search_line(Iterate& iterate, StepReport& report) {
  constexpr double kEnough = 1e-4;     // of the decrease that the slope predicts
  constexpr double kRounding = 1e-13;  // of the potential's terms
  constexpr int kHalvings = 30;
  const double slope = inner_product(iterate.gradient, iterate.step);
  const double start = potential(iterate.velocities);
  std::vector<double> trial(iterate.velocities.size());
  double length = 1.0;
  for (int i = 0; i < kHalvings; ++i, length *= 0.5) {
    for (std::size_t j = 0; j < trial.size(); ++j) {
      trial[j] = iterate.velocities[j] + length * iterate.step[j];
    }
    const double end = potential(trial);
    if (end <= start + kEnough * length * slope + kRounding * std::abs(start)) {
      for (double& s : iterate.step) s *= length;
      return true;
    }
  }
  report.warnings.push_back(
      fmt::format("Newton's method stopped at the residual {:.1e}: no step lowers the "
                  "potential, largest at vertex {}",
                  report.newton_residual, largest_vertex(iterate.gradient)));
  return false;
}

Balance BackwardEuler::balance() const {
  std::vector<double> momenta(velocities_.size());
  multiply(system_.mass(), system_.matrix(), velocities_, momenta);
  Balance balance = balance_of(system_.mass().vertices, positions_, velocities_, momenta, options_.gravity);
  balance.elastic = elastic_energy(system_.rest(), system_.elasticity(), positions_);
  return balance;
}

Offset BackwardEuler::blocks_read() const noexcept {
  const Offset half = std::max(half_.block_count(), rounded_half_.block_count());
  return half > 0 ? half : system_.matrix().block_count();
}

std::size_t BackwardEuler::bytes() const {
  const auto of = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  // 4 vectors of CG and 4 of a step
  return system_.bytes() + preconditioner_->bytes() + of(damping_.values) + of(damping_.columns) +
         of(rounded_.values) + of(rounded_.columns) + of(half_.values) + of(half_.columns) +
         of(half_.offsets) + of(rounded_half_.values) + of(rounded_half_.columns) +
         of(rounded_half_.offsets) + of(damping_.offsets) + of(positions_) + of(moved_) + of(velocities_) +
         of(loads_) + of(scratch_) + 8 * of(velocities_);
}

}  // namespace meshorder
