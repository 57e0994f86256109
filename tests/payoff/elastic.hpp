// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/incidence.hpp"
#include "kernels/elasticity.hpp"
#include "payoff/deformed.hpp"

#include <Eigen/Dense>

#include <ostream>
#include <string>
#include <vector>

namespace meshorder::test {

/// A law with one of its tangents, as a parameter of tests.
struct Case {
  MaterialModel model;
  Tangent tangent;
  int dimension = 3;
};

inline std::string name_of(const Case& law) {
  const char* const models[] = {"Corotational", "Stvk", "NeoHookean"};
  const char* const tangents[] = {"Exact", "Approximate", "Projected"};
  return std::string(models[static_cast<int>(law.model)]) + tangents[static_cast<int>(law.tangent)] +
         std::to_string(law.dimension);
}

inline std::ostream& operator<<(std::ostream& out, const Case& law) { return out << name_of(law); }

inline std::string case_name(const testing::TestParamInfo<Case>& info) { return name_of(info.param); }

inline Elasticity elasticity_of(const Case& law, const Lame& lame = kSteel) {
  return {law.model, law.tangent, lame, {}, {}};
}

inline CsrGraph graph_of(const Patch& patch) {
  Incidence elements;
  elements.vertex_count = index_size(patch.points);
  elements.vertices = patch.simplices.vertices;
  for (Offset s = 1; s <= patch.simplices.size(); ++s) {
    elements.offsets.push_back(s * (patch.simplices.dimension + 1));
  }
  return joined_vertices(elements);
}

inline AlignedVector<double> forces_of(const Patch& patch, const Elasticity& elasticity,
                                       const AlignedVector<double>& positions) {
  AlignedVector<double> forces(positions.size(), 0.0);
  add_elasticity(patch.rest, elasticity, positions, forces, nullptr);
  return forces;
}

inline BlockCsr stiffness_of(const Patch& patch, const Elasticity& elasticity,
                             const AlignedVector<double>& positions) {
  BlockCsr matrix = zero_block_csr(graph_of(patch));
  const AssemblyMap map = assembly_map(patch.rest, matrix);
  const Stiffness stiffness{map, matrix};
  add_elasticity(patch.rest, elasticity, positions, {}, &stiffness);
  return matrix;
}

inline Eigen::MatrixXd dense(const BlockCsr& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * matrix.size(), 3 * matrix.size());
  for (Index row = 0; row < matrix.size(); ++row) {
    for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
      for (int i = 0; i < 9; ++i) {
        result(3 * row + i / 3, 3 * matrix.columns[k] + i % 3) = matrix.values[9 * k + i];
      }
    }
  }
  return result;
}

inline Eigen::MatrixXd dense_stiffness(const Patch& patch, const Elasticity& elasticity,
                                       const AlignedVector<double>& positions) {
  return dense(stiffness_of(patch, elasticity, positions));
}

/// The energy by its definition, with another library's singular values and another rest frame.
inline double energy(const Patch& patch, const Elasticity& elasticity,
                     const AlignedVector<double>& positions) {
  const int d = patch.simplices.dimension;
  const auto [mu, lambda] = elasticity.lame;
  double sum = 0.0;
  for (Offset s = 0; s < patch.simplices.size(); ++s) {
    const Index* const corner = patch.simplices.vertices.data() + (d + 1) * s;
    Eigen::MatrixXd rest(3, d);
    Eigen::MatrixXd deformed(3, d);
    for (int a = 0; a < d; ++a) {
      for (int c = 0; c < 3; ++c) {
        rest(c, a) = patch.points[corner[a + 1]][c] - patch.points[corner[0]][c];
        deformed(c, a) =
            positions[kPaddedStride * corner[a + 1] + c] - positions[kPaddedStride * corner[0] + c];
      }
    }
    const Eigen::MatrixXd metric = rest.transpose() * rest;
    const double volume = std::sqrt(metric.determinant()) / (d == 3 ? 6 : d);
    Eigen::MatrixXd f =
        deformed * Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(metric).operatorInverseSqrt();
    Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(f).singularValues();
    if (d == 3 && rest.determinant() * deformed.determinant() < 0.0) sigma[2] = -sigma[2];
    const Eigen::VectorXd green = 0.5 * (sigma.array().square() - 1.0);
    const double squares = sigma.squaredNorm();
    double density = 0.0;
    switch (elasticity.model) {
      case MaterialModel::corotational:
        density = mu * (sigma.array() - 1.0).square().sum() + 0.5 * lambda * std::pow(sigma.sum() - 3.0, 2);
        break;
      case MaterialModel::stvk:
        density = mu * green.squaredNorm() + 0.5 * lambda * std::pow(green.sum(), 2);
        break;
      case MaterialModel::neo_hookean: {
        const double m = 4.0 / 3.0 * mu;
        const double l = lambda + 5.0 / 6.0 * mu;
        const double alpha = 1.0 + 0.75 * m / l;
        const auto psi = [&](double ic, double j) {
          return 0.5 * m * (ic - 3.0) + 0.5 * l * std::pow(j - alpha, 2) - 0.5 * m * std::log(ic + 1.0);
        };
        density = psi(squares, sigma.prod()) - psi(3.0, 1.0);
        break;
      }
    }
    sum += volume * density;
  }
  return sum;
}

/// The rest points moved by a linear map.
inline AlignedVector<double> mapped(const std::vector<Point>& points, const Eigen::Matrix3d& map) {
  std::vector<Point> result;
  for (const Point& p : points) {
    const Eigen::Vector3d x = map * Eigen::Vector3d(p[0], p[1], p[2]);
    result.push_back({x[0], x[1], x[2]});
  }
  return padded_positions(result);
}

/// A state that may occur in a simulation, by its singular values.
struct State {
  std::string name;
  Eigen::Vector3d sigma;
  bool smooth = true;  ///< the rotation closest to F is unique
};

inline std::vector<State> states() {
  return {{"stretched", {1.3, 1.1, 0.9}},
          {"at rest", {1.0, 1.0, 1.0}},
          {"swollen", {3.0, 3.0, 3.0}},
          {"compressed", {0.3, 0.2, 0.05}},
          {"inverted", {1.2, 0.8, -0.4}},
          {"inverted and long", {5.0, 0.3, -0.1}},
          {"flat", {1.1, 0.7, 0.0}},
          {"inverted, two alike", {1.2, 0.5, -0.5}, false},
          {"mirrored", {1.0, 1.0, -1.0}, false},
          {"a line", {1.5, 0.0, 0.0}, false},
          {"a point", {0.0, 0.0, 0.0}, false}};
}

/// Some rotation.
inline Eigen::Matrix3d some_rotation(std::uint64_t seed) {
  Random random(seed);
  Eigen::Quaterniond q(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
  return q.normalized().toRotationMatrix();
}

/// Returns a deformation gradient with these singular values.
inline Eigen::Matrix3d gradient_of(const State& state, std::uint64_t seed = 3) {
  return some_rotation(seed) * state.sigma.asDiagonal() * some_rotation(seed + 1).transpose();
}

}  // namespace meshorder::test
