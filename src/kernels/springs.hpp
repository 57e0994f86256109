// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "kernels/owned_batches.hpp"

#include <span>

namespace meshorder {

/// A spring on every edge of a mesh, in batches of kBatch: end a of spring s is
/// `ends[(2 (s / kBatch) + a) · kBatch + s % kBatch]`, its rest length `rest_lengths[s]`. The last batch is
/// padded with springs from a vertex to itself, which have no force.
struct Springs {
  Offset count = 0;
  AlignedVector<Index> ends;
  AlignedVector<double> rest_lengths;
};

/// Returns a spring for every edge of the graph, from its smaller to its larger end, at rest at the given
/// points. Springs are sorted by the larger end and then the smaller end, as `lexmax` sorts elements. Larger
/// ends are then first visited in the order of memory. O(n + edges).
Springs springs_on_edges(const CsrGraph& graph, std::span<const Point> points);

/// Returns the energy Σ ½ k (‖d‖ − ℓ₀)² of springs of stiffness k, d = x_b − x_a. O(springs).
double spring_energy(const Springs& springs, double stiffness, std::span<const double> positions);

/// Adds −∂/∂x of that energy to `forces`: k (‖d‖ − ℓ₀) d/‖d‖ on end a and its opposite on end b. A spring
/// whose ends coincide has no force. Positions and forces have the layout of padded_positions. Throws
/// InvalidArgument if the sizes differ. Works in batches, as add_elasticity does. O(springs).
void add_spring_forces(const Springs& springs, double stiffness, std::span<const double> positions,
                       std::span<double> forces);

/// Adds the forces of one share of `owned_batches` (of springs.ends); see add_elasticity.
void add_spring_forces(const Springs& springs, double stiffness, std::span<const double> positions,
                       std::span<double> forces, const OwnedBatches& share);

/// Like the first `add_spring_forces`, as a scalar reference: the same source, one spring at a time, without
/// vector instructions.
void add_spring_forces_scalar(const Springs& springs, double stiffness, std::span<const double> positions,
                              std::span<double> forces);

}  // namespace meshorder
