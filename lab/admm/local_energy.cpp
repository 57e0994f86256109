// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "kernels/positions.hpp"
#include "lab/admm/local_elements.hpp"
#include "lab/admm/local_steps.hpp"
#include "lab/support/rotation.hpp"

#include <cmath>
#include <limits>

namespace meshorder {
namespace {

double squared_norm(const Matrix3& f) {
  double sum = 0.0;
  for (const auto& row : f) {
    for (const double entry : row) sum += entry * entry;
  }
  return sum;
}

double determinant(const Matrix3& f) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    sum += f[0][i] * (f[1][(i + 1) % 3] * f[2][(i + 2) % 3] - f[1][(i + 2) % 3] * f[2][(i + 1) % 3]);
  }
  return sum;
}

double strain(const Matrix3& f) {
  Matrix3 difference = closest_rotation(f);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) difference[i][j] -= f[i][j];
  }
  return 0.5 * squared_norm(difference);
}

// energy densities, and Lamé's parameters m and l, all divided by the bulk modulus

double stvk(const Matrix3& f, double m, double l) {
  double trace = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double sum = i == j ? -1.0 : 0.0;
      for (int k = 0; k < 3; ++k) sum += f[k][i] * f[k][j];
      squares += 0.25 * sum * sum;
      if (i == j) trace += 0.5 * sum;
    }
  }
  return m * squares + 0.5 * l * trace * trace;
}

double neo_hookean(const Matrix3& f, double m, double l) {
  const double mu = 4.0 / 3.0 * m;
  const double lambda = l + 5.0 / 6.0 * m;
  const double growth = determinant(f) - 1.0;
  const double stretch = squared_norm(f) - 3.0;
  // ½λ' ((J − α)² − (1 − α)²) = ½ (J − 1) (λ' (J − 1) − 3/2 μ') with α = 1 + ¾ μ'/λ'
  return 0.5 * (growth * (lambda * growth - 1.5 * mu) + mu * (stretch - std::log1p(0.25 * stretch)));
}

double log_neo_hookean(const Matrix3& f, double m, double l) {
  const double volume = determinant(f);
  if (volume <= 0.0) return std::numeric_limits<double>::infinity();
  const double log = std::log(volume);
  return 0.5 * m * (squared_norm(f) - 3.0) - m * log + 0.5 * l * log * log;
}

/// Returns U/w² of a tetrahedron.
double density(LocalModel model, const Matrix3& f, double m) {
  const double l = 1.0 - 2.0 / 3.0 * m;
  if (model == LocalModel::strain) return strain(f);
  if (model == LocalModel::stvk) return stvk(f, m, l);
  if (model == LocalModel::neo_hookean) return neo_hookean(f, m, l);
  return log_neo_hookean(f, m, l);
}

template <class Real>
double energy_of_element(LocalModel model, const LocalElements<Real>& elements, Offset s,
                         std::span<const Real> positions) {
  double d[4][3];
  const double weight = elements.load(s, d);
  Matrix3 f{};
  const auto coordinate = [&](Index corner, int c) {
    return static_cast<double>(positions[Offset{kPaddedStride} * elements.vertex(s, corner) + c]);
  };
  if (model == LocalModel::springs) {
    const double length = std::hypot(coordinate(0, 0) - coordinate(1, 0), coordinate(0, 1) - coordinate(1, 1),
                                     coordinate(0, 2) - coordinate(1, 2));
    const double stretch = length - static_cast<double>(elements.rest[s]);
    return 0.5 * weight * stretch * stretch;
  }
  // an element without weight has the energy 0, even where its density is infinite
  if (weight <= 0.0) return 0.0;
  for (Index a = 1; a < 4; ++a) {
    for (int c = 0; c < 3; ++c) {
      for (int j = 0; j < 3; ++j) f[c][j] += (coordinate(a, c) - coordinate(0, c)) * d[a][j];
    }
  }
  double softness = 0.0;
  if (!elements.softness.empty()) {
    const Offset batch = s / kLocalBatch<Real>;
    softness =
        static_cast<double>(elements.softness[elements.softness_stride * batch + s % kLocalBatch<Real>]);
  }
  return weight * density(model, f, softness);
}

}  // namespace

template <class Real>
double energy_of(LocalModel model, const LocalElements<Real>& elements, std::span<const Real> positions) {
  constexpr Index kElementsOfAChunk = 4096;
  return sum_over_chunks<double>(static_cast<Index>(elements.count), kElementsOfAChunk,
                                 [&](Index begin, Index end) {
                                   double sum = 0.0;
                                   for (Index s = begin; s < end; ++s)
                                     sum += energy_of_element(model, elements, s, positions);
                                   return sum;
                                 });
}

template double energy_of(LocalModel, const LocalElements<double>&, std::span<const double>);
template double energy_of(LocalModel, const LocalElements<float>&, std::span<const float>);

}  // namespace meshorder
