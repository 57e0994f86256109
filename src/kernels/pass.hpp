// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/material.hpp"
#include "kernels/owned_batches.hpp"

namespace meshorder {

/// Input and output of a pass over the simplices, already checked. Internal to elasticity.cpp and the laws'
/// kernels.
struct ElasticPass {
  const RestShapes& rest;
  Tangent tangent = Tangent::exact;
  /// Lamé's parameters of batch b begin at mu[lame_stride · b]. If all simplices have the same parameters,
  /// the stride is 0, so that all batches read the same values and kernels need no branch.
  const double* mu = nullptr;
  const double* lambda = nullptr;
  Offset lame_stride = 0;
  const double* positions = nullptr;
  double* forces = nullptr;  ///< null if only the stiffness is wanted
  /// The values of the matrix; null if only forces are wanted.
  double* values = nullptr;
  double scale = 1.0;             ///< multiplies the stiffness
  const Index* blocks = nullptr;  ///< AssemblyMap::blocks
  /// One share of the batches, whose OwnedBlocks::blocks are in `boundary_blocks`; null for all batches.
  const OwnedBatches* share = nullptr;
  const Index* boundary_blocks = nullptr;
};

/// The kernels of one law.
struct ElasticKernels {
  void (*add)(const ElasticPass& pass);
  void (*add_one_by_one)(const ElasticPass& pass);
  /// Returns the energy of the batches begin … end − 1.
  double (*energy)(const ElasticPass& pass, Index begin, Index end);
};

ElasticKernels stvk_kernels();
ElasticKernels corotational_kernels();
ElasticKernels neo_hookean_kernels();

}  // namespace meshorder
