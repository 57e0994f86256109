// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "../measuring.hpp"

#include <dolfinx/common/IndexMap.h>
#include <dolfinx/fem/Constant.h>
#include <dolfinx/fem/CoordinateElement.h>
#include <dolfinx/fem/Form.h>
#include <dolfinx/fem/Function.h>
#include <dolfinx/fem/FunctionSpace.h>
#include <dolfinx/fem/assembler.h>
#include <dolfinx/fem/utils.h>
#include <dolfinx/graph/AdjacencyList.h>
#include <dolfinx/la/MatrixCSR.h>
#include <dolfinx/la/SparsityPattern.h>
#include <dolfinx/mesh/Geometry.h>
#include <dolfinx/mesh/Mesh.h>
#include <dolfinx/mesh/Topology.h>
#include <dolfinx/mesh/cell_types.h>
#include <dolfinx/mesh/graphbuild.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

/// Shared by the test and the measuring program: −Δu + u = 1 + x by linear tetrahedra, on meshes in given
/// orders.
namespace problem {

/// A function that takes a graph and returns the new index of each node, as DOLFINx needs it.
using Reorder = std::function<std::vector<int>(const dolfinx::graph::AdjacencyList<std::int32_t>&)>;

/// Returns the identity.
inline std::vector<int> stay(const dolfinx::graph::AdjacencyList<std::int32_t>& graph) {
  std::vector<int> map(static_cast<std::size_t>(graph.num_nodes()));
  for (std::size_t k = 0; k < map.size(); ++k) map[k] = static_cast<int>(k);
  return map;
}

/// Makes a mesh as `create_mesh` does on one process, but with the given orders of cells and of points:
/// `create_mesh` of DOLFINx 0.5 takes no orders.
inline std::shared_ptr<dolfinx::mesh::Mesh> create_mesh(const measuring::Tetrahedra& tetrahedra,
                                                        const Reorder& cell_order,
                                                        const Reorder& point_order) {
  std::vector<std::int64_t> corners;
  std::vector<std::int32_t> offsets{0};
  for (const auto& cell : tetrahedra.cells) {
    corners.insert(corners.end(), cell.begin(), cell.end());
    offsets.push_back(static_cast<std::int32_t>(corners.size()));
  }
  const std::size_t count = tetrahedra.cells.size();
  const auto dual = std::get<0>(dolfinx::mesh::build_local_dual_graph(corners, offsets, 3));
  const std::vector<int> map = cell_order(dual);
  std::vector<std::int64_t> ordered(corners.size());
  std::vector<std::int64_t> original(count);
  for (std::size_t old = 0; old < count; ++old) {
    const auto at = static_cast<std::size_t>(map[old]);
    for (std::size_t c = 0; c < 4; ++c) ordered[4 * at + c] = corners[4 * old + c];
    original[at] = static_cast<std::int64_t>(old);
  }
  const dolfinx::graph::AdjacencyList<std::int64_t> cells(std::move(ordered), std::move(offsets));
  std::vector<double> x;
  for (const auto& point : tetrahedra.points) x.insert(x.end(), point.begin(), point.end());
  auto topology =
      dolfinx::mesh::create_topology(MPI_COMM_SELF, cells, original, std::vector<int>{},
                                     dolfinx::mesh::CellType::tetrahedron, dolfinx::mesh::GhostMode::none);
  const dolfinx::fem::CoordinateElement element(dolfinx::mesh::CellType::tetrahedron, 1);
  auto geometry = dolfinx::mesh::create_geometry(MPI_COMM_SELF, topology, element, cells, x, 3, point_order);
  return std::make_shared<dolfinx::mesh::Mesh>(MPI_COMM_SELF, std::move(topology), std::move(geometry));
}

/// The matrix and the right-hand side in a function space.
class System {
 public:
  System(std::shared_ptr<const dolfinx::fem::FunctionSpace> space, const ufcx_form& bilinear,
         const ufcx_form& linear)
      : bilinear_(
            dolfinx::fem::create_form<double>(bilinear, {space, space}, Coefficients{}, Constants{}, {})),
        linear_(dolfinx::fem::create_form<double>(linear, {space}, Coefficients{}, Constants{}, {})),
        matrix_(pattern()),
        right_(static_cast<std::size_t>(space->dofmap()->index_map->size_local())) {}

  void assemble() {
    std::ranges::fill(matrix_.values(), 0);
    dolfinx::fem::assemble_matrix(matrix_.mat_add_values(), bilinear_, {});
    std::ranges::fill(right_, 0);
    dolfinx::fem::assemble_vector(std::span(right_), linear_);
  }

  /// Solves by conjugate gradients without a preconditioner; returns the number of iterations.
  int solve(std::vector<double>& u, double tolerance) const {
    const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
      return sum;
    };
    u.assign(right_.size(), 0);
    std::vector<double> residual = right_;
    std::vector<double> direction = right_;
    std::vector<double> product(right_.size());
    double square = dot(residual, residual);
    const double wanted = square * tolerance * tolerance;
    int iterations = 0;
    for (; square > wanted && iterations < 10000; ++iterations) {
      multiply(direction, product);
      const double step = square / dot(direction, product);
      for (std::size_t i = 0; i < u.size(); ++i) {
        u[i] += step * direction[i];
        residual[i] -= step * product[i];
      }
      const double before = std::exchange(square, dot(residual, residual));
      for (std::size_t i = 0; i < u.size(); ++i) direction[i] = residual[i] + square / before * direction[i];
    }
    return iterations;
  }

  /// Returns the mean distance of the off-diagonal entries from the diagonal.
  double mean_span() const {
    double sum = 0;
    for (std::size_t row = 0; row < right_.size(); ++row) {
      for (auto k = matrix_.row_ptr()[row]; k < matrix_.row_ptr()[row + 1]; ++k) {
        sum += std::abs(static_cast<double>(row) - matrix_.cols()[static_cast<std::size_t>(k)]);
      }
    }
    return sum / static_cast<double>(matrix_.cols().size() - right_.size());
  }

 private:
  using Coefficients = std::vector<std::shared_ptr<const dolfinx::fem::Function<double>>>;
  using Constants = std::vector<std::shared_ptr<const dolfinx::fem::Constant<double>>>;

  dolfinx::la::SparsityPattern pattern() const {
    auto found = dolfinx::fem::create_sparsity_pattern(bilinear_);
    found.assemble();
    return found;
  }

  void multiply(const std::vector<double>& x, std::vector<double>& y) const {
    for (std::size_t row = 0; row < y.size(); ++row) {
      double sum = 0;
      for (auto k = matrix_.row_ptr()[row]; k < matrix_.row_ptr()[row + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        sum += matrix_.values()[entry] * x[static_cast<std::size_t>(matrix_.cols()[entry])];
      }
      y[row] = sum;
    }
  }

  dolfinx::fem::Form<double> bilinear_;
  dolfinx::fem::Form<double> linear_;
  dolfinx::la::MatrixCSR<double> matrix_;
  std::vector<double> right_;
};

}  // namespace problem
