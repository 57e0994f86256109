// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/force_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace meshorder {
namespace {

// a force counts as on the rim of its disc if (length / radius)² is at least this
constexpr double kOnRim = 1.0 - 1e-9;
// a step reduces the residual of its face (the forces that it selects) to this share
constexpr double kFaceTolerance = 0.1;
// steps allowed without a new minimum of the energy
constexpr int kPatience = 10;
// a careful step must reach this share of the decrease that the gradient predicts (Armijo)
constexpr double kEnoughFall = 1e-4;
constexpr double kMinWay = 1e-9;

using Pair = std::array<double, 2>;

Pair pair_at(std::span<const double> vector, Index row) { return {vector[row], vector[row + 1]}; }

double dot(const Pair& a, const Pair& b) { return a[0] * b[0] + a[1] * b[1]; }

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Replaces a force by the nearest force in a disc.
void shorten(Pair& force, double radius) {
  const double length = std::hypot(force[0], force[1]);
  if (length <= radius) return;
  for (double& c : force) c *= radius / length;
}

bool on_rim(const Pair& force, double radius) { return dot(force, force) >= kOnRim * radius * radius; }

/// Calls `normal(row)` for the rows of normal forces and `disc(row, radius)` for the first row of each disc.
template <class Normal, class Disc>
void for_each_force(const ForceBounds& bounds, Normal normal, Disc disc) {
  for (Index k = 0; k < bounds.normals; ++k) normal(k);
  for (Index k = 0; k < index_size(bounds.radii); ++k) disc(bounds.normals + 2 * k, bounds.radii[k]);
}

class Minimiser {
 public:
  Minimiser(ForceOperator& matrix, const ForceBounds& bounds, const ForceSolveOptions& options,
            std::span<double> forces, std::span<double> gradient)
      : matrix_(matrix),
        bounds_(bounds),
        options_(options),
        x_(forces),
        g_(gradient),
        freedom_(forces.size()),
        stiffening_(forces.size()),
        step_(forces.size()),
        step_product_(forces.size()),
        trial_(forces.size()),
        r_(forces.size()),
        z_(forces.size()),
        product_(forces.size()) {}

  ForceSolveReport run() {
    save_best();
    int since_best = 0;
    for (;;) {
      report_.residual = projected_gradient(bounds_, options_.scale, x_, g_);
      if (!(report_.residual > options_.tolerance) || spent()) break;
      const bool careful = since_best >= kPatience;
      if (careful) restore_best();
      find_face(careful);
      solve_on_face();
      if (careful) follow_gradient_to_bounds();
      if (!take_step(careful)) break;
      ++since_best;
      if (energy_ >= 0.0) continue;
      since_best = 0;
      save_best();
    }
    if (report_.residual > options_.tolerance && energy_ > 0.0) {
      restore_best();
      report_.residual = projected_gradient(bounds_, options_.scale, x_, g_);
    }
    return report_;
  }

 private:
  enum class Freedom : std::uint8_t { none, all, along_rim };

  [[nodiscard]] bool spent() const { return report_.multiplications >= options_.max_multiplications; }

  void save_best() {
    best_.assign(x_.begin(), x_.end());
    best_gradient_.assign(g_.begin(), g_.end());
    energy_ = 0.0;
  }

  void restore_best() {
    std::copy(best_.begin(), best_.end(), x_.begin());
    std::copy(best_gradient_.begin(), best_gradient_.end(), g_.begin());
    energy_ = 0.0;
  }

  /// Returns whether the forces that are 0 and would grow promise a larger gain than the positive forces.
  [[nodiscard]] bool new_ones_gain_most() const {
    double pushing = 0.0;
    double wanting = 0.0;
    for (Index k = 0; k < bounds_.normals; ++k) {
      const double gain = g_[k] * g_[k] / options_.scale[k];
      if (x_[k] > 0.0) {
        pushing += gain;
      } else if (g_[k] > 0.0) {
        wanting += gain;
      }
    }
    return wanting > pushing;
  }

  /// Returns whether a gradient step would take a positive normal force to its bound.
  [[nodiscard]] bool leaves(Index row) const {
    return x_[row] > 0.0 && x_[row] + g_[row] / options_.scale[row] <= 0.0;
  }

  void find_face(bool careful) {
    const bool take_new = new_ones_gain_most();
    for_each_force(
        bounds_,
        [&](Index row) {
          const bool stays = x_[row] > 0.0 && !(careful && leaves(row));
          freedom_[row] = stays || (take_new && g_[row] > 0.0) ? Freedom::all : Freedom::none;
        },
        [&](Index row, double radius) {
          const Pair force = pair_at(x_, row);
          const double out = dot(force, pair_at(g_, row));
          const bool held = on_rim(force, radius) && out >= 0.0;
          freedom_[row] = !held ? Freedom::all : radius > 0.0 ? Freedom::along_rim : Freedom::none;
          freedom_[row + 1] = freedom_[row];
          stiffening_[row] = freedom_[row] == Freedom::along_rim ? out / (radius * radius) : 0.0;
          stiffening_[row + 1] = stiffening_[row];
        });
  }

  /// Removes the components of a vector along which forces are fixed.
  void keep_free(std::span<double> vector) const {
    for (std::size_t i = 0; i < vector.size(); ++i) {
      if (freedom_[i] == Freedom::none) vector[i] = 0.0;
    }
    for (Index row = bounds_.normals; row < bounds_.size(); row += 2) {
      if (freedom_[row] != Freedom::along_rim) continue;
      const Pair force = pair_at(x_, row);
      const double out = dot(force, pair_at(vector, row)) / dot(force, force);
      vector[row] -= out * force[0];
      vector[row + 1] -= out * force[1];
    }
  }

  /// Computes result = S vector, with the softness.
  void multiply(std::span<const double> vector, std::span<double> result) {
    matrix_.multiply(vector, result);
    for (std::size_t i = 0; i < vector.size(); ++i)
      result[i] += options_.softness * options_.scale[i] * vector[i];
    ++report_.multiplications;
  }

  /// Computes z ≈ (S + stiffening)⁻¹ r on the face. Along rims, z is r divided by scale + stiffening.
  void precondition() {
    for (std::size_t i = 0; i < r_.size(); ++i) product_[i] = freedom_[i] == Freedom::all ? r_[i] : 0.0;
    matrix_.precondition(product_, z_);
    for (std::size_t i = 0; i < r_.size(); ++i) {
      if (freedom_[i] == Freedom::along_rim) z_[i] = r_[i] / (options_.scale[i] + stiffening_[i]);
    }
    keep_free(z_);
  }

  /// Computes the step to the approximate minimum of the energy on the face by conjugate gradients, and
  /// step_product = S step. The rim of a disc is curved, which adds to S for forces that move along the rim.
  void solve_on_face() {
    std::fill(step_.begin(), step_.end(), 0.0);
    std::fill(step_product_.begin(), step_product_.end(), 0.0);
    std::copy(g_.begin(), g_.end(), r_.begin());
    keep_free(r_);
    precondition();
    double rz = dot(r_, z_);
    const double enough = kFaceTolerance * kFaceTolerance * rz;
    direction_ = z_;
    while (rz > enough && !spent()) {
      multiply(direction_, product_);
      double curvature = dot(direction_, product_);
      for (std::size_t i = 0; i < r_.size(); ++i) curvature += stiffening_[i] * direction_[i] * direction_[i];
      const double way = rz / curvature;
      if (!(way > 0.0) || !std::isfinite(way)) return;
      for (std::size_t i = 0; i < r_.size(); ++i) {
        step_[i] += way * direction_[i];
        step_product_[i] += way * product_[i];
        r_[i] -= way * (product_[i] + stiffening_[i] * direction_[i]);
      }
      keep_free(r_);
      if (std::sqrt(dot(r_, r_)) <= 0.5 * options_.tolerance) return;
      precondition();
      const double before = rz;
      rz = dot(r_, z_);
      for (std::size_t i = 0; i < r_.size(); ++i) direction_[i] = z_[i] + rz / before * direction_[i];
    }
  }

  /// Lets forces that are about to reach their bounds step along the gradient; else they would limit every
  /// careful step.
  void follow_gradient_to_bounds() {
    for (Index row = 0; row < bounds_.normals; ++row) {
      if (leaves(row)) step_[row] = g_[row] / options_.scale[row];
    }
  }

  /// Takes the step, projected onto the bounds; halves a careful step until it lowers the energy. Returns
  /// false if no step was taken.
  bool take_step(bool careful) {
    for (double way = 1.0; way >= kMinWay; way *= 0.5) {
      for (std::size_t i = 0; i < trial_.size(); ++i) trial_[i] = x_[i] + way * step_[i];
      project(bounds_, trial_);
      bool inside = way == 1.0 && !careful;
      for (std::size_t i = 0; i < trial_.size(); ++i) {
        const double moved = trial_[i] - x_[i];
        inside = inside && trial_[i] == x_[i] + step_[i];
        trial_[i] = moved;
      }
      const double slope = dot(g_, trial_);
      if (careful && !(slope > 0.0)) continue;
      if (inside) {
        product_ = step_product_;
      } else if (spent()) {
        return false;
      } else {
        multiply(trial_, product_);
      }
      const double fall = slope - 0.5 * dot(trial_, product_);
      if (!std::isfinite(fall)) return false;
      if (careful && !(fall >= kEnoughFall * slope)) continue;
      for (std::size_t i = 0; i < trial_.size(); ++i) {
        x_[i] += trial_[i];
        g_[i] -= product_[i];
      }
      project(bounds_, x_);
      energy_ -= fall;
      return true;
    }
    return false;
  }

  ForceOperator& matrix_;
  const ForceBounds& bounds_;
  const ForceSolveOptions& options_;
  std::span<double> x_, g_;
  std::vector<Freedom> freedom_;             ///< of each row
  std::vector<double> stiffening_;           ///< of each row: added to S by the rim's curvature
  std::vector<double> step_, step_product_;  ///< step_product_ = S step_
  std::vector<double> trial_, r_, z_, direction_, product_;
  double energy_ =
      0.0;  ///< relative to the lowest so far; the last decreases of the total would be lost to rounding
  std::vector<double> best_, best_gradient_;
  ForceSolveReport report_;
};

}  // namespace

ForceSolveReport minimise_forces(ForceOperator& matrix, const ForceBounds& bounds,
                                 const ForceSolveOptions& options, std::span<double> forces,
                                 std::span<double> gradient) {
  return Minimiser(matrix, bounds, options, forces, gradient).run();
}

void project(const ForceBounds& bounds, std::span<double> forces) {
  for_each_force(
      bounds, [&](Index row) { forces[row] = std::max(forces[row], 0.0); },
      [&](Index row, double radius) {
        Pair force = pair_at(forces, row);
        shorten(force, radius);
        forces[row] = force[0];
        forces[row + 1] = force[1];
      });
}

double projected_gradient(const ForceBounds& bounds, std::span<const double> scale,
                          std::span<const double> forces, std::span<const double> gradient) {
  double square = 0.0;
  for_each_force(
      bounds,
      [&](Index row) {
        const double part = forces[row] > 0.0 ? gradient[row] : std::max(gradient[row], 0.0);
        square += part * part;
      },
      [&](Index row, double radius) {
        const Pair force = pair_at(forces, row);
        Pair aim = pair_at(gradient, row);
        for (std::size_t c = 0; c < 2; ++c) aim[c] = force[c] + aim[c] / scale[row];
        shorten(aim, radius);
        for (std::size_t c = 0; c < 2; ++c) aim[c] = scale[row] * (aim[c] - force[c]);
        square += dot(aim, aim);
      });
  return std::sqrt(square);
}

}  // namespace meshorder
