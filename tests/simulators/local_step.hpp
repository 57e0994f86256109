// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/random.hpp"
#include "kernels/positions.hpp"
#include "lab/admm/local_steps.hpp"
#include "payoff/deformed.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace meshorder::test {

/// `count` tetrahedra that share no vertex, each at rest on the origin and the three unit vectors.
struct UnitTetrahedra {
  std::vector<Point> points;
  Simplices simplices;

  explicit UnitTetrahedra(std::size_t count) {
    simplices.dimension = 3;
    for (std::size_t s = 0; s < count; ++s) {
      for (int a = 0; a < 4; ++a) {
        simplices.vertices.push_back(static_cast<Index>(points.size()));
        points.push_back({a == 1 ? 1.0 : 0.0, a == 2 ? 1.0 : 0.0, a == 3 ? 1.0 : 0.0});
      }
    }
  }

  /// Returns positions x with D x = q exactly.
  template <class Real>
  static AlignedVector<Real> positions(const std::vector<Eigen::Matrix3d>& q) {
    AlignedVector<Real> result(16 * q.size(), Real{0});
    for (std::size_t s = 0; s < q.size(); ++s) {
      for (int a = 0; a < 3; ++a) {
        for (int c = 0; c < 3; ++c) result[16 * s + 4 * a + 4 + c] = static_cast<Real>(q[s](c, a));
      }
    }
    return result;
  }
};

/// Returns w² per volume.
inline double weight_of(const LocalLaw& law) {
  return law.model == LocalModel::strain ? law.stiffness : law.lame.lambda + 2.0 / 3.0 * law.lame.mu;
}

/// Computes the kernels' local steps for any matrices q, from the forces of unit tetrahedra on their corners.
template <class Real>
class UnitSteps {
 public:
  UnitSteps(const LocalLaw& law, std::size_t count)
      : body_(count), steps_(law, body_.simplices, body_.points), weight_(weight_of(law) / 6.0) {}

  /// Returns 2z − q of a step that begins with duals 0, for one matrix per tetrahedron.
  std::vector<Eigen::Matrix3d> reflections(const std::vector<Eigen::Matrix3d>& q) {
    AlignedVector<Real> sums(kPaddedStride * static_cast<std::size_t>(steps_.room()));
    steps_.reset_duals();
    steps_.pass(UnitTetrahedra::positions<Real>(q), Real{1}, sums);
    std::vector<Eigen::Matrix3d> result(q.size());
    for (std::size_t s = 0; s < q.size(); ++s) {
      for (int a = 0; a < 3; ++a) {
        for (int c = 0; c < 3; ++c) {
          result[s](c, a) = static_cast<double>(sums[16 * s + 4 * a + 4 + c]) / weight_;
        }
      }
    }
    return result;
  }

 private:
  UnitTetrahedra body_;
  LocalSteps<Real> steps_;
  double weight_;
};

/// Returns z of one local step for each q.
template <class Real>
std::vector<Eigen::Matrix3d> local_steps(const LocalLaw& law, const std::vector<Eigen::Matrix3d>& q) {
  std::vector<Eigen::Matrix3d> result = UnitSteps<Real>(law, q.size()).reflections(q);
  for (std::size_t s = 0; s < q.size(); ++s) result[s] = 0.5 * (result[s] + q[s]);
  return result;
}

inline std::string name_of(LocalModel model) {
  const char* const names[] = {"Springs", "Strain", "Stvk", "NeoHookean", "LogNeoHookean"};
  return names[static_cast<int>(model)];
}

/// A row of tetrahedra; neighbours share three vertices.
inline Patch tetrahedra(Index count) { return deformed_patch(3, count); }

template <class Real = double>
LocalSteps<Real> steps_of(const LocalLaw& law, const Patch& patch) {
  return LocalSteps<Real>(law, patch.simplices, patch.points);
}

template <class Real = double>
AlignedVector<Real> sums_for(const LocalSteps<Real>& steps) {
  // detects entries that the pass does not set
  return AlignedVector<Real>(kPaddedStride * static_cast<std::size_t>(steps.room()), Real{17});
}

/// The rest positions with noise that differs from pass to pass.
inline AlignedVector<double> shaken(const Patch& patch, int pass, double amplitude = 0.2) {
  Random random(100 + static_cast<std::uint64_t>(pass));
  AlignedVector<double> x = padded_positions(patch.points);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % kPaddedStride != 3) x[i] += amplitude * (random.unit() - 0.5);
  }
  return x;
}

/// A law of Young's modulus 1.
inline LocalLaw law_of(LocalModel model, double poisson = 0.3) {
  LocalLaw law;
  law.model = model;
  law.stiffness = 6.0;
  law.lame = Lame::from_young(1.0, poisson);
  return law;
}

/// Returns the signed singular values, in descending order of size.
inline Eigen::Vector3d singular_values(const Eigen::Matrix3d& f) {
  Eigen::Vector3d sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(f).singularValues();
  if (f.determinant() < 0.0) sigma[2] = -sigma[2];
  return sigma;
}

/// The energy per volume from its definition, by the signed singular values.
inline double density(const LocalLaw& law, const Eigen::Vector3d& sigma) {
  const auto [mu, lambda] = law.lame;
  const double j = sigma.prod();
  const double norm = sigma.squaredNorm();
  switch (law.model) {
    case LocalModel::springs:
      break;
    case LocalModel::strain:
      return 0.5 * law.stiffness * (sigma.array() - 1.0).square().sum();
    case LocalModel::stvk: {
      const Eigen::Vector3d green = 0.5 * (sigma.array().square() - 1.0);
      return mu * green.squaredNorm() + 0.5 * lambda * green.sum() * green.sum();
    }
    case LocalModel::neo_hookean: {
      const double m = 4.0 / 3.0 * mu;
      const double l = lambda + 5.0 / 6.0 * mu;
      const double alpha = 1.0 + 0.75 * m / l;
      const auto psi = [&](double ic, double volume) {
        return 0.5 * m * (ic - 3.0) + 0.5 * l * std::pow(volume - alpha, 2) - 0.5 * m * std::log(ic + 1.0);
      };
      return psi(norm, j) - psi(3.0, 1.0);
    }
    case LocalModel::log_neo_hookean:
      if (!(sigma.minCoeff() > 0.0)) return std::numeric_limits<double>::infinity();
      return 0.5 * mu * (norm - 3.0) - mu * std::log(j) + 0.5 * lambda * std::log(j) * std::log(j);
  }
  return 0.0;
}

/// Returns the objective of a local step, over w².
inline double objective(const LocalLaw& law, const Eigen::Matrix3d& z, const Eigen::Matrix3d& q) {
  return density(law, singular_values(z)) / weight_of(law) + 0.5 * (z - q).squaredNorm();
}

}  // namespace meshorder::test
