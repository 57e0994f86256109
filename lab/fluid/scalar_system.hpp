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

/// The matrix K of ∫ ∇q·∇p and the lumped masses M of ∫ q, for linear tetrahedra with one unknown at each
/// vertex. Sums add tetrahedra by ascending number, so they are the same for any number of threads.
struct ScalarSystem {
  Graph pattern;                 ///< of K without its diagonal
  std::vector<double> values;    ///< of K, one for each neighbour, m
  std::vector<double> diagonal;  ///< of K, m
  std::vector<double> masses;    ///< volume that belongs to each vertex, m³

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(diagonal.size()); }
};

/// Assembles K and M. O(tetrahedra).
ScalarSystem assemble(const FluidMesh& mesh, std::span<const Point> points);

/// Solves A x = b, A = α K + β M, by conjugate gradients with the diagonal as preconditioner; x is the first
/// guess and becomes the result. Where `held` is not 0, x is given and stays. `tolerance` limits
/// ‖b − A x‖ / ‖b‖ over the other rows. The result has the same bits for any number of threads.
SolveReport solve(const ScalarSystem& system, double alpha, double beta, std::span<const std::uint8_t> held,
                  std::span<const double> b, std::span<double> x, const SolveOptions& options);

/// Returns ∫ ∇q·u for the hat function q of each vertex and the piecewise linear u.
std::vector<double> divergence(const FluidMesh& mesh, std::span<const Point> points,
                               std::span<const Point> u);

/// Returns ∫ q ∇p for the hat function q of each vertex and the piecewise linear p.
std::vector<Point> gradient(const FluidMesh& mesh, std::span<const Point> points, std::span<const double> p);

/// Returns ∫ q ∇u for the hat functions q and a vector field u; row c is that of u's component c.
std::vector<std::array<Point, 3>> gradient(const FluidMesh& mesh, std::span<const Point> points,
                                           std::span<const Point> u);

}  // namespace meshorder
