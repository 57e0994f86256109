// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/assembly.hpp"
#include "kernels/material.hpp"
#include "kernels/positions.hpp"

#include <span>

namespace meshorder {

/// The elastic energy Σ V Ψ(F) of simplices in space, F their 3×D deformation gradients: tetrahedra are
/// solids, and for Saint Venant–Kirchhoff triangles are membranes and lines bars of thickness 1. `positions`
/// has the layout of padded_positions, here and below. On all threads; the sum has the same bits for any
/// number of them. Infinite or NaN if a position is, or if the law's energy is infinite. O(simplices).
///
/// Throws InvalidArgument, here and below, for a law or tangent that does not support such simplices, an
/// approximate tangent of any law but the corotational one, and arrays of wrong sizes.
double elastic_energy(const RestShapes& rest, const Elasticity& elasticity,
                      std::span<const double> positions);

/// The destination of a stiffness matrix: matrix += scale · K.
struct Stiffness {
  const AssemblyMap& map;
  BlockCsr& matrix;
  double scale = 1.0;
};

/// forces += −∂E/∂x, in the layout of padded_positions, where `forces` is not empty; and, where `stiffness`
/// is given, its matrix += scale · K with K = ∂²E/∂x² or the approximation that `elasticity.tangent` names: K
/// and each of its blocks on the diagonal symmetric to the last bit. One pass over the simplices, in batches
/// by the best vector instructions of the processor; the sums' rounding depends on how many lanes those have,
/// the result on nothing else. O(simplices).
void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness);

/// Adds the contributions of one share of `owned_batches` (of rest.vertices), with owned_blocks of the same
/// share if there is a stiffness, so that threads can share the work. All shares together give the same bits
/// as one pass. Forces and matrix must have room for the spare vertices and blocks.
void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness, const OwnedBatches& share,
                    const OwnedBlocks& boundary);

/// The scalar reference: the same source, one simplex at a time and without vector instructions.
void add_elasticity_scalar(const RestShapes& rest, const Elasticity& elasticity,
                           std::span<const double> positions, std::span<double> forces,
                           const Stiffness* stiffness);

}  // namespace meshorder
