// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "kernels/material.hpp"
#include "kernels/owned_batches.hpp"
#include "kernels/simplices.hpp"
#include "lab/admm/local_elements.hpp"
#include "lab/linear/cholesky/ldl.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

/// Element models of ADMM projective dynamics: an energy U of a linear function D x of the positions, and the
/// weight w² of its local step.
///
/// Springs and strain have a single minimum in closed form: halfway to the rest length or to the closest
/// rotation. If q (see LocalSteps::pass) is 0, the minimum is halfway to the rest edge or to the identity: a
/// body can unfold from a point. The step of a hyperelastic model is the minimum where the objective is
/// convex (near rest), and a local minimum elsewhere. Near rest the step is accurate to about 1e-13 (floats
/// 2e-6; floats of stvk 1e-5 at Poisson's ratio 0.3 and 1e-4 at 0). Singular values above 1e4 count as 1e4.
/// Finite q never give NaN.
enum class LocalModel : std::uint8_t {
  springs,  ///< on every edge: D x = x_a − x_b, U = ½k(‖D x‖ − ℓ₀)², w² = k
  strain,  ///< linear tetrahedral strain: D x = F, U = ½kV‖F − R‖², w² = kV (Narain, Overby, Brown 2016)
  stvk,         ///< D x = F, U = VΨ(F) of MaterialModel::stvk, w² = V times the bulk modulus
  neo_hookean,  ///< like stvk, with Ψ of MaterialModel::neo_hookean
  log_neo_hookean,  ///< ½μ(‖F‖² − 3) − μ log J + ½λ log² J, infinite for J ≤ 0 (Bonet, Wood 1997)
};

template <>
struct EnumNames<LocalModel> {
  static constexpr std::string_view kind = "material model";
  static constexpr std::array names{
      std::pair{LocalModel::springs, "springs"}, std::pair{LocalModel::strain, "strain"},
      std::pair{LocalModel::stvk, "stvk"}, std::pair{LocalModel::neo_hookean, "neo-hookean"},
      std::pair{LocalModel::log_neo_hookean, "log-neo-hookean"}};
};

struct LocalLaw {
  LocalModel model = LocalModel::strain;
  double stiffness = 0.0;           ///< k of all springs, N/m; k of the strain, Pa, if `stiffnesses` is empty
  std::vector<double> stiffnesses;  ///< strain: k of each simplex
  Lame lame;                        ///< hyperelastic models: of all simplices, if `mu` and `lambda` are empty
  std::vector<double> mu, lambda;   ///< of each simplex
};

/// Residual of one pass of local steps; sums over elements.
struct LocalResidual {
  double primal = 0.0;     ///< Σ w²‖D x − z‖²
  double magnitude = 0.0;  ///< Σ w²‖z‖², the scale of `primal`
};

/// The local steps of all elements, with their dual variables u. Elements are processed in the order of the
/// simplices (springs by their edges, see springs_on_edges). Results have the same bits on every run and for
/// any number of threads.
///
/// Each thread adds to a range of vertices of its own and computes all elements that touch this range (see
/// owned_batches). An element on a boundary has a copy of its duals for each thread. A tetrahedron that is
/// flat to rounding has no volume and no force; its duals are those of a nearby tetrahedron. A pass streams
/// 240 bytes for each tetrahedron and 64 for each spring in double, and about half as many in float.
template <class Real>
class LocalSteps {
 public:
  /// Makes the elements of `simplices` (tetrahedra) at rest at `points`, with duals 0. Throws
  /// InvalidArgument, naming the problem, for simplices that are not tetrahedra and for numbers that are out
  /// of range or not finite. O(simplices · log degree).
  LocalSteps(const LocalLaw& law, const Simplices& simplices, std::span<const Point> points);

  /// Returns Σ Dᵀw²D on the vertices: n × n, the same for x, y and z.
  [[nodiscard]] SparseMatrix stiffness() const;

  /// Takes the local step of every element, q = D x + u, z = argmin U(z) + ½w²‖z − q‖², u = q − z; then sets
  /// right_hand_side[v] = scale · Σ Dᵀw²(z − u) at each vertex v. Both vectors have kPaddedStride numbers for
  /// each vertex (see padded_positions); the right-hand side has `room()` vertices, and those after the
  /// mesh's are scratch. O(elements).
  LocalResidual pass(std::span<const Real> positions, Real scale, std::span<Real> right_hand_side);

  /// Returns the number of vertices that the right-hand side must hold, at least n.
  [[nodiscard]] Index room() const noexcept;

  void reset_duals();
  /// Returns the duals, 9 of each tetrahedron (row by row) and 3 of each spring, in an order that does not
  /// depend on the number of threads, for a checkpoint.
  [[nodiscard]] std::vector<Real> duals() const;
  /// Sets the duals. Throws InvalidArgument unless there are as many as in duals() and all are finite.
  void set_duals(std::span<const Real> duals);

  /// Returns the energy Σ U(D x), in joules; infinite if the energy of any element is infinite. O(elements).
  [[nodiscard]] double energy(std::span<const Real> positions) const;

  [[nodiscard]] Offset element_count() const noexcept;
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Returns the position of the duals of a copy of a batch. A batch has a copy for each share that computes
  /// it.
  [[nodiscard]] Offset duals_of(Offset copy) const noexcept {
    return copy * elements_.rows() * kLocalBatch<Real>;
  }

  LocalModel model_;
  Index vertex_count_;
  LocalElements<Real> elements_;
  std::vector<OwnedBatches> shares_;
  std::vector<Offset> first_copies_;  ///< index of each share's first copy; its copies are consecutive
  std::vector<Offset> copies_;        ///< for each batch, one of its copies
  AlignedVector<Real> duals_;
  std::vector<double> residuals_;  ///< of each copy: primal and magnitude
};

}  // namespace meshorder
