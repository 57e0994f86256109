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
/// number of them. Infinite or NaN where a state or position is. O(simplices).
///
/// Throws InvalidArgument, here and below, for a law or tangent that is not for such simplices, an
/// approximate tangent of another law than the corotational one, and for arrays of wrong sizes.
double elastic_energy(const RestShapes& rest, const Elasticity& elasticity,
                      std::span<const double> positions);

/// Where a stiffness matrix goes: matrix += scale · K.
struct Stiffness {
  const AssemblyMap& map;
  BlockCsr& matrix;
  double scale = 1.0;
};

/// forces += −∂E/∂x, in the layout of padded_positions, where `forces` is not empty; and, where `stiffness`
/// is given, its matrix += scale · K with K = ∂²E/∂x² or what `elasticity.tangent` puts in its place: K and
/// each of its blocks on the diagonal symmetric to the last bit. One pass over the simplices, in batches by
/// the best vector instructions of the processor; the sums' rounding depends on how many lanes those have,
/// the result on nothing else. O(simplices).
void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness);

/// What one share of `owned_batches` (of rest.vertices) adds, with owned_blocks of the same share where there
/// is a stiffness, for threads to share the work: over all shares the same bits. Forces and matrix must have
/// room for spare vertices and blocks.
void add_elasticity(const RestShapes& rest, const Elasticity& elasticity, std::span<const double> positions,
                    std::span<double> forces, const Stiffness* stiffness, const OwnedBatches& share,
                    const OwnedBlocks& boundary);

/// The same from the same source, one simplex at a time and without vector instructions: the reference.
void add_elasticity_scalar(const RestShapes& rest, const Elasticity& elasticity,
                           std::span<const double> positions, std::span<double> forces,
                           const Stiffness* stiffness);

}  // namespace meshorder
