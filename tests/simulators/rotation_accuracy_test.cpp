// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The accuracy of the kernels' closest rotations, which the local steps of strain compute.
#include "base/random.hpp"
#include "simulators/local_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace meshorder {
namespace {

using Matrix3l = Eigen::Matrix<long double, 3, 3>;
using Vector3l = Eigen::Matrix<long double, 3, 1>;

#ifdef MESHORDER_IS_SANITIZED
constexpr std::size_t kBatches = 8;
#else
constexpr std::size_t kBatches = 64;
#endif
constexpr std::size_t kMatrices = 16384;  // of all kinds together

/// The rotation closest to F = U diag(σ) Vᵀ by one-sided Jacobi (Hestenes 1958) in long double.
struct Decomposition {
  Matrix3l rotation;
  long double condition = 0.0;  ///< σ₁ / (σ₂ + σ₃) of the signed values

  explicit Decomposition(const Eigen::Matrix3d& f) {
    Matrix3l a = f.cast<long double>();
    Matrix3l v = Matrix3l::Identity();
    for (int sweep = 0; sweep < 30; ++sweep) {
      bool turned = false;
      for (int p = 0; p < 2; ++p) {
        for (int q = p + 1; q < 3; ++q) {
          const long double pp = a.col(p).squaredNorm();
          const long double qq = a.col(q).squaredNorm();
          const long double pq = a.col(p).dot(a.col(q));
          if (std::abs(pq) <= 1e-19L * std::sqrt(pp * qq)) continue;
          turned = true;
          const long double zeta = (qq - pp) / (2 * pq);
          const long double t = std::copysign(1.0L, zeta) / (std::abs(zeta) + std::hypot(1.0L, zeta));
          const long double c = 1 / std::hypot(1.0L, t);
          for (Matrix3l* m : {&a, &v}) {
            const Vector3l old = m->col(p);
            m->col(p) = c * (old - t * m->col(q));
            m->col(q) = c * (t * old + m->col(q));
          }
        }
      }
      if (!turned) break;
    }
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int p, int q) { return a.col(p).norm() > a.col(q).norm(); });
    const Vector3l u0 = a.col(order[0]).normalized();
    const Vector3l u1 = a.col(order[1]).normalized();
    const Vector3l v0 = v.col(order[0]);
    const Vector3l v1 = v.col(order[1]);
    // the third pair has the sign that makes a rotation
    const Vector3l u2 = u0.cross(u1);
    const Vector3l v2 = v0.cross(v1);
    rotation = u0 * v0.transpose() + u1 * v1.transpose() + u2 * v2.transpose();
    const long double last = u2.dot(f.cast<long double>() * v2);
    condition = a.col(order[0]).norm() / (a.col(order[1]).norm() + last);
  }
};

Eigen::Matrix3d some_rotation(Random& random) {
  Eigen::Quaterniond q(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
  return q.normalized().toRotationMatrix();
}

/// Matrices of ten kinds in turn, from common to hard ones.
Eigen::Matrix3d some_matrix(std::size_t i, Random& random) {
  const double small = std::pow(10.0, -14 * random.unit());
  const double sign = random.unit() < 0.5 ? -1.0 : 1.0;
  Eigen::Vector3d sigma(1, 1, 1);
  switch (i % 10) {
    case 0: {  // any at all
      Eigen::Matrix3d f;
      for (int k = 0; k < 9; ++k) f(k / 3, k % 3) = 2 * random.unit() - 1;
      return f;
    }
    case 1:  // near rest
      sigma = {1 + small, 1 - small * random.unit(), 1 - 0.1 * random.unit()};
      break;
    case 2:  // nearly flat, on either side
      sigma = {1 + random.unit(), random.unit(), sign * small};
      break;
    case 3:  // nearly a line
      sigma = {1, small, sign * small * random.unit()};
      break;
    case 4:  // nearly several closest rotations
      sigma = {1 + random.unit(), random.unit(), 0};
      sigma[2] = -sigma[1] * (1 - small);
      break;
    case 5:  // three nearly alike, inverted
      sigma = {1, 1 - small, -1 + small * (1 + random.unit())};
      break;
    case 6:  // long
      sigma = {1 / (1e-3 + random.unit()), random.unit(), sign * random.unit()};
      break;
    case 7: {  // small integers: singular ones and all symmetries
      Eigen::Matrix3d f;
      for (int k = 0; k < 9; ++k) f(k / 3, k % 3) = static_cast<double>(random.below(3)) - 1.0;
      return f;
    }
    case 8:  // two alike
      sigma = {1 + random.unit(), 0.5, sign * (0.5 - 0.5 * small)};
      break;
    default:  // diagonal, as axes of coordinates make them
      return Eigen::Vector3d(random.unit(), sign * random.unit(), small).asDiagonal();
  }
  return some_rotation(random) * sigma.asDiagonal() * some_rotation(random);
}

std::vector<Eigen::Matrix3d> some_matrices(std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Matrix3d> result;
  for (std::size_t i = 0; i < kMatrices; ++i) result.push_back(some_matrix(i, random));
  return result;
}

/// The deviation of R, relative to F, from a rotation that makes S = RᵀF symmetric and tr(S) I − S
/// semi-definite. The eigenvalues of the latter are σ₂ + σ₃, σ₁ + σ₃ and σ₁ + σ₂.
double defect(const Eigen::Matrix3d& f, const Eigen::Matrix3d& r) {
  const double scale = 1.0 / std::max(f.norm(), 1e-300);
  const Eigen::Matrix3d s = r.transpose() * (scale * f);
  const Eigen::Matrix3d sums = s.trace() * Eigen::Matrix3d::Identity() - 0.5 * (s + s.transpose());
  // the symmetric functions of its eigenvalues
  const double minors = 0.5 * (sums.trace() * sums.trace() - (sums * sums).trace());
  const double negative = std::max({-sums.trace(), -minors, -sums.determinant(), 0.0});
  return std::max({(r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
                   std::abs(r.determinant() - 1.0), (s - s.transpose()).cwiseAbs().maxCoeff(), negative});
}

/// Returns the largest defect of the rotations closest to these matrices.
template <class Real>
double greatest_defect() {
  LocalLaw law = test::law_of(LocalModel::strain);
  test::UnitSteps<Real> steps(law, kMatrices);
  double result = 0.0;
  for (std::size_t batch = 0; batch < kBatches; ++batch) {
    std::vector<Eigen::Matrix3d> f = some_matrices(batch);
    for (Eigen::Matrix3d& m : f) m = m.cast<Real>().template cast<double>();
    const std::vector<Eigen::Matrix3d> r = steps.reflections(f);
    for (std::size_t i = 0; i < kMatrices; ++i) {
      const double here = defect(f[i], r[i]);
      // also true for NaN
      if (!(here <= result)) result = here;
    }
  }
  return result;
}

TEST(RotationsOfDoubles, AreClosestForAMillionMatrices) { EXPECT_LT(greatest_defect<double>(), 3e-13); }

TEST(RotationsOfFloats, AreClosestForAMillionMatrices) { EXPECT_LT(greatest_defect<float>(), 1.5e-4); }

/// Returns the largest error of well-conditioned rotations, relative to the error from rounding F, which is
/// σ₁ / (σ₂ + σ₃), or 1 if that is larger.
template <class Real>
double greatest_error() {
  test::UnitSteps<Real> steps(test::law_of(LocalModel::strain), kMatrices);
  double result = 0.0;
  for (std::size_t batch = 0; batch < kBatches / 8; ++batch) {
    std::vector<Eigen::Matrix3d> f = some_matrices(1000 + batch);
    for (Eigen::Matrix3d& m : f) m = m.cast<Real>().template cast<double>();
    const std::vector<Eigen::Matrix3d> r = steps.reflections(f);
    for (std::size_t i = 0; i < kMatrices; ++i) {
      const Decomposition exact(f[i]);
      if (!(exact.condition > 0.0L && exact.condition < 1e3L)) continue;
      const double error =
          static_cast<double>((r[i].cast<long double>() - exact.rotation).cwiseAbs().maxCoeff());
      result = std::max(result, error / std::max(1.0, static_cast<double>(exact.condition)));
    }
  }
  return result;
}

TEST(RotationsOfDoubles, AreThoseOfLongDoubleDecompositions) { EXPECT_LT(greatest_error<double>(), 4e-15); }

TEST(RotationsOfFloats, AreThoseOfLongDoubleDecompositions) { EXPECT_LT(greatest_error<float>(), 2e-6); }

}  // namespace
}  // namespace meshorder
