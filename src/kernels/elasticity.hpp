// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/assembly.hpp"
#include "kernels/material.hpp"
#include "kernels/positions.hpp"

#include <span>

namespace meshorder {

/// Returns the elastic energy Σ V Ψ(F) of simplices in space; F is a simplex's 3×D deformation gradient.
/// Tetrahedra are solids. With the law stvk, triangles are membranes and lines bars, of thickness 1.
/// `positions` has the layout of padded_positions, here and below. Runs on all threads, with the same bits
/// for any number of threads. The result is infinite or NaN if a position is, or if the law's energy is
/// infinite. O(simplices).
///
/// Throws InvalidArgument, here and below, for a law or tangent that does not support such simplices, for the
/// approximate tangent unless the law is corotational, and if the sizes of two arrays disagree.
double elastic_energy(const RestShapes& rest, const Elasticity& elasticity,
                      std::span<const double> positions);

/// The destination of a stiffness matrix: matrix += scale · K.
struct Stiffness {
  const AssemblyMap& map;
  BlockCsr& matrix;
  double scale = 1.0;
};

/// Adds −∂E/∂x to `forces`, in the layout of padded_positions, unless `forces` is empty. Unless `stiffness`
/// is null, adds scale · K to its matrix; K is ∂²E/∂x² or the approximation that `elasticity.tangent` names.
/// K and its diagonal blocks are symmetric to the last bit. One pass over the simplices, in batches, by the
/// best vector instructions of the processor. The rounding of sums depends only on the number of lanes of
/// these instructions. O(simplices).
void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness);

/// Adds the contributions of one share of `owned_batches` (of rest.vertices), so that threads can divide the
/// work. `boundary`: owned_blocks of this share; unused without a stiffness. All shares together give the
/// same bits as one pass. Forces and matrix must have room for the spare vertices and blocks.
void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness, const OwnedBatches& share,
                    const OwnedBlocks& boundary);

/// Like the first `add_elasticity`, as a scalar reference: the same source, one simplex at a time, without
/// vector instructions.
void add_elasticity_scalar(const RestShapes& rest, const Elasticity& elasticity,
                           std::span<const double> positions, std::span<double> forces,
                           const Stiffness* stiffness);

}  // namespace meshorder
