// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/fluid/alpha_shape.hpp"
#include "lab/linear/cg/solve.hpp"
#include <meshorder/order.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

/// Linear elements of a mesh of tetrahedra with one unknown for each vertex: the matrix K of ∫ ∇q·∇p and the
/// lumped masses M of ∫ q. Sums add tetrahedra by ascending number, so they are the same for any number of
/// threads.
struct ScalarSystem {
  Graph pattern;                 ///< of K without its diagonal
  std::vector<double> values;    ///< of K, one for each neighbour, m
  std::vector<double> diagonal;  ///< of K, m
  std::vector<double> masses;    ///< volume that belongs to each vertex, m³

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(diagonal.size()); }
};

/// Assembles K and M. O(tetrahedra).
ScalarSystem assemble(const FluidMesh& mesh, std::span<const Point> points);

/// Solves (α K + β M) x = b by conjugate gradients with the diagonal as preconditioner; x is the start and
/// becomes the result. Where `held` is not 0, x is given and stays. `tolerance` limits ‖b − A x‖ / ‖b‖. The
/// result has the same bits for any number of threads.
SolveReport solve(const ScalarSystem& system, double alpha, double beta, std::span<const std::uint8_t> held,
                  std::span<const double> b, std::span<double> x, const SolveOptions& options);

/// Returns ∫ ∇q·u of the piecewise linear u, for the hat function q of each vertex.
std::vector<double> divergence(const FluidMesh& mesh, std::span<const Point> points,
                               std::span<const Point> u);

/// Returns ∫ q ∇p of the piecewise linear p.
std::vector<Point> gradient(const FluidMesh& mesh, std::span<const Point> points, std::span<const double> p);

/// Returns ∫ q ∇u of the piecewise linear u: row c is the gradient of its component c.
std::vector<std::array<Point, 3>> gradient(const FluidMesh& mesh, std::span<const Point> points,
                                           std::span<const Point> u);

}  // namespace meshorder
