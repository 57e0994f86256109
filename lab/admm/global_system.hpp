// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/cholesky/cholesky.hpp"
#include "lab/motion/loads.hpp"

#include <optional>
#include <span>
#include <vector>

namespace meshorder {

/// The matrix A = M + h² Σ Dᵀw²D of ADMM's global step, the same for x, y and z, with its factor. Held
/// vertices are not unknowns: their rows are those of the identity, and their influence on other vertices
/// is part of the right-hand side.
template <class Real>
class GlobalSystem {
 public:
  /// `stiffness` is Σ Dᵀw²D and `squared_step` h². Vertices of mass 0 must be held.
  GlobalSystem(SparseMatrix stiffness, std::span<const double> masses, double squared_step);

  /// Holds these vertices. On the first call, or if other vertices were held, refactors and returns true.
  bool hold(const HeldVertices& held);

  /// Adds the held vertices' influence on other vertices to the right-hand side b, then copies the held
  /// vertices' positions from x to b. Vectors have kPaddedStride numbers for each vertex. O(entries in the
  /// rows of held vertices).
  void apply_held(std::span<const Real> x, std::span<Real> b) const;

  [[nodiscard]] const SparseMatrix& matrix() const noexcept { return matrix_; }
  [[nodiscard]] const CholeskyFactor<Real>& factor() const noexcept { return *factor_; }
  [[nodiscard]] bool is_held(Index v) const { return held_[v] != 0; }
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Coupling {
    Index vertex, held;
    Real value;
  };

  SparseMatrix whole_;  ///< A with no vertex held
  SparseMatrix matrix_;
  std::vector<char> held_;
  std::vector<Index> held_vertices_;
  std::vector<Coupling> couplings_;
  std::optional<CholeskyFactor<Real>> factor_;
};

}  // namespace meshorder
