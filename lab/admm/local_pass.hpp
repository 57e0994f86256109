// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/owned_batches.hpp"

namespace meshorder {

/// Number of elements that local steps process at a time: as many as an AVX-512 register has numbers.
template <class Real>
inline constexpr Index kLocalBatch = 64 / sizeof(Real);

/// How many numbers a tetrahedron has in LocalElements::rest: Dₘ⁻¹ row by row in the world's frame, and w².
inline constexpr Index kTetrahedronNumbers = 10;

/// Input and output of a pass over one share of the batches, already checked. Internal to local_steps.cpp and
/// the kernels. Quantity q of the element in lane l of a batch is entry `q · kLocalBatch + l` of the batch.
template <class Real>
struct LocalPass {
  const OwnedBatches& share;
  const Index* vertices = nullptr;   ///< corners of each batch
  const Real* rest = nullptr;        ///< kTetrahedronNumbers quantities; springs: the rest length
  const Real* directions = nullptr;  ///< springs: directions of the rest edges, 3 quantities
  /// Hyperelastic models: μ / bulk modulus; the numbers of batch b begin at softness[softness_stride · b].
  const Real* softness = nullptr;
  Offset softness_stride = 0;
  Real stiffness = 0;  ///< of springs
  Real scale = 0;
  const Real* positions = nullptr;
  Real* right_hand_side = nullptr;
  // for the batches of the share, one after another
  Real* duals = nullptr;        ///< 9 quantities of tetrahedra, 3 of springs
  double* residuals = nullptr;  ///< primal and magnitude of each batch
};

// The kernels of each law.
void pass_springs(const LocalPass<double>& pass);
void pass_springs(const LocalPass<float>& pass);
void pass_strain(const LocalPass<double>& pass);
void pass_strain(const LocalPass<float>& pass);
void pass_stvk(const LocalPass<double>& pass);
void pass_stvk(const LocalPass<float>& pass);
void pass_neo_hookean(const LocalPass<double>& pass);
void pass_neo_hookean(const LocalPass<float>& pass);
void pass_log_neo_hookean(const LocalPass<double>& pass);
void pass_log_neo_hookean(const LocalPass<float>& pass);

}  // namespace meshorder

/// Defines both functions pass_<law> by the kernels <law>_doubles and <law>_floats of all instruction sets.
/// Use it in namespace meshorder, if HWY_ONCE.
#define MESHORDER_EXPORT_LOCAL_PASS(law)                                                  \
  MESHORDER_SIMD_VERSIONS(law##_doubles);                                                 \
  MESHORDER_SIMD_VERSIONS(law##_floats);                                                  \
  void pass_##law(const LocalPass<double>& pass) { MESHORDER_SIMD(law##_doubles)(pass); } \
  void pass_##law(const LocalPass<float>& pass) { MESHORDER_SIMD(law##_floats)(pass); }
