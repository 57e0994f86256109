// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/sim/kernels/owned_batches.hpp>
#include <meshorder/sim/material/material.hpp>

#include <span>

namespace meshorder {

/// The elastic energy of simplices in space, by Saint Venant and Kirchhoff:
/// E = Σ V (μ E:E + ½ λ tr(E)²) with E = ½(FᵀF − I) and F the 3×D deformation gradient. Tetrahedra are
/// solids, triangles membranes and lines bars of thickness 1. `positions` has the layout of padded_positions.
/// O(simplices).
double stvk_energy(const RestShapes& rest, const Lame& lame, std::span<const double> positions);

/// forces += −∂E/∂x of that energy, both in the layout of padded_positions. Computed in batches by the best
/// vector instructions of the processor, simplex after simplex; the sums' rounding depends on how many lanes
/// those have, the result on nothing else. Throws InvalidArgument when the sizes differ. O(simplices).
void add_stvk_forces(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                     std::span<double> forces);

/// The forces on the vertices of one share of `owned_batches` (of rest.vertices), for threads to share the
/// work; over all shares the same bits. Throws InvalidArgument when `forces` has no room for share.room
/// vertices. O(simplices of the share).
void add_stvk_forces(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                     std::span<double> forces, const OwnedBatches& share);

/// The same from the same source, one simplex at a time and without vector instructions: the reference.
void add_stvk_forces_scalar(const RestShapes& rest, const Lame& lame, std::span<const double> positions,
                            std::span<double> forces);

}  // namespace meshorder
