// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/material.hpp"
#include "kernels/owned_batches.hpp"

namespace meshorder {

/// What a pass over the simplices reads and adds to, checked: for elasticity.cpp and the laws' kernels alone.
struct ElasticPass {
  const RestShapes& rest;
  Tangent tangent = Tangent::exact;
  /// Lamé's parameters of batch b from mu[lame_stride · b] on: of each simplex, or one batch of equal ones
  /// for all, which spares the kernels a question.
  const double* mu = nullptr;
  const double* lambda = nullptr;
  Offset lame_stride = 0;
  const double* positions = nullptr;
  double* forces = nullptr;  ///< none where only the stiffness is asked for
  /// The matrix's; none where only forces are asked for.
  double* values = nullptr;
  double scale = 1.0;             ///< of the stiffness
  const Index* blocks = nullptr;  ///< of AssemblyMap
  /// One share of the batches, where it is not all of them, with OwnedBlocks::blocks.
  const OwnedBatches* share = nullptr;
  const Index* boundary_blocks = nullptr;
};

/// One law's kernels.
struct ElasticKernels {
  void (*add)(const ElasticPass& pass);
  void (*add_one_by_one)(const ElasticPass& pass);
  /// Of the batches begin … end − 1.
  double (*energy)(const ElasticPass& pass, Index begin, Index end);
};

ElasticKernels stvk_kernels();
ElasticKernels corotational_kernels();
ElasticKernels neo_hookean_kernels();

}  // namespace meshorder
