// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/sim/kernels/assembly.hpp>
#include <meshorder/sim/kernels/owned_batches.hpp>
#include <meshorder/sim/material/material.hpp>

#include <span>

namespace meshorder {

/// The elastic energy Σ V Ψ(F). `positions` has the layout of padded_positions, here and below. The sum has
/// the same bits for any number of threads. Infinite or NaN where a state or position is. O(simplices).
double elastic_energy(const RestShapes& rest, const Elasticity& elasticity,
                      std::span<const double> positions);

/// forces += −∂E/∂x, in the layout of padded_positions; and, where `stiffness` is given, its matrix +=
/// scale · K with K = ∂²E/∂x² or what `elasticity.tangent` puts in its place. One pass over the simplices.
struct Stiffness {
  const AssemblyMap& map;
  BlockCsr& matrix;
  double scale = 1.0;
};
void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness);

/// The part of one share, for threads to share the work (see owned_batches); over all shares the same bits.
void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness, const OwnedBatches& share,
                    const OwnedBlocks& boundary);

}  // namespace meshorder
