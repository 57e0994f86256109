// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/admm/local_pass.hpp"
#include "lab/linear/cholesky/ldl.hpp"

#include <cstdint>
#include <span>

namespace meshorder {

enum class LocalModel : std::uint8_t;
struct LocalLaw;

/// Rest data of elements for the local steps: springs on two corners or tetrahedra on four, in the batches of
/// LocalPass. The last batch is filled up with elements that have no force.
///
/// A tetrahedron that is flat to rounding (see RestShapes) has no deformation gradient: it gets weight 0, and
/// the corners and shape of a nearby tetrahedron that is not flat.
template <class Real>
struct LocalElements {
  Offset count = 0;
  Index corners = 0;
  AlignedVector<Index> vertices;
  AlignedVector<Real> rest, directions, softness;
  Offset softness_stride = 0;  ///< 0 if all batches share one batch of `softness`
  Real stiffness = 0;          ///< of springs

  [[nodiscard]] Offset batches() const noexcept {
    return (count + kLocalBatch<Real> - 1) / kLocalBatch<Real>;
  }
  /// Returns the number of rows of an element's D x.
  [[nodiscard]] Index rows() const noexcept { return corners == 2 ? 3 : 9; }

  [[nodiscard]] Index vertex(Offset element, Index corner) const {
    return vertices[place(element, corners) + corner * kLocalBatch<Real>];
  }
  /// Sets row k of d to the coefficients of corner k in an element's D: 1 or −1 for a spring, else the
  /// corner's shape gradient. Returns w².
  double load(Offset element, double (&d)[4][3]) const;

  /// Returns the index of an element's first number in an array of `numbers` numbers for each element.
  [[nodiscard]] static Offset place(Offset element, Index numbers) {
    return element / kLocalBatch<Real> * numbers * kLocalBatch<Real> + element % kLocalBatch<Real>;
  }
};

/// Makes the elements of tetrahedra at rest at the points: see LocalSteps. O(simplices · log degree).
template <class Real>
LocalElements<Real> local_elements(const LocalLaw& law, const Simplices& simplices,
                                   std::span<const Point> points);

/// Returns Σ Dᵀw²D on n vertices. O(elements · log degree).
template <class Real>
SparseMatrix stiffness_of(const LocalElements<Real>& elements, Index n);

/// Returns Σ U(D x) of all elements: see LocalSteps::energy. Runs on all threads, without batches, with the
/// same bits for any number of threads.
template <class Real>
double energy_of(LocalModel model, const LocalElements<Real>& elements, std::span<const Real> positions);

}  // namespace meshorder
