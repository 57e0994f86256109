// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/random.hpp"
#include "kernels/assembly.hpp"
#include "kernels/elasticity.hpp"
#include "kernels/positions.hpp"
#include "mesh/graphs.hpp"

#include <Eigen/Dense>

#include <vector>

namespace meshorder::test {

/// M + K of a mesh of tetrahedra at rest. Each tetrahedron adds `density` times a quarter of its volume to
/// the mass of each corner; every vertex has at least the mass `density` / 1000.
inline BlockCsr elastic_system(const Mesh& mesh, double density) {
  const RestShapes rest = rest_shapes(cut_into_simplices(mesh), mesh.points);
  BlockCsr matrix = zero_block_csr(vertex_graph(mesh));
  Elasticity elasticity;
  elasticity.lame = Lame::from_young(1.0, 0.4);
  const AssemblyMap map = assembly_map(rest, matrix);
  const Stiffness stiffness{map, matrix};
  add_elasticity(rest, elasticity, padded_positions(mesh.points), {}, &stiffness);
  std::vector<double> masses(mesh.points.size(), 1e-3 * density);
  for (Offset s = 0; s < rest.count; ++s) {
    for (int a = 0; a < 4; ++a) masses[rest.vertex(s, a)] += density * rest.volume(s) / 4;
  }
  for (Index v = 0; v < matrix.size(); ++v) {
    for (int c = 0; c < 3; ++c) matrix.values[9 * matrix.find(v, v) + 4 * c] += masses[v];
  }
  return matrix;
}

/// The matrix in dense form.
template <class Value>
Eigen::MatrixXd dense(const BlockCsrOf<Value>& matrix) {
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

/// 3 numbers from −½ to ½ for each vertex.
inline std::vector<double> random_vector(Index vertices, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> result(3 * static_cast<std::size_t>(vertices));
  for (double& value : result) value = random.unit() - 0.5;
  return result;
}

inline Eigen::Map<const Eigen::VectorXd> as_eigen(const std::vector<double>& vector) {
  return {vector.data(), static_cast<Eigen::Index>(vector.size())};
}

}  // namespace meshorder::test
