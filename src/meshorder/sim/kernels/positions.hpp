// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh/mesh.hpp>
#include <meshorder/sim/kernels/aligned.hpp>

#include <span>

namespace meshorder {

/// Doubles from one vertex to the next in the positions and forces of the element and spring kernels: x, y, z
/// and one that stays 0, so that a vertex never straddles a cache line and is read by aligned vector loads.
inline constexpr Index kPaddedStride = 4;

/// The points in that layout. O(n).
AlignedVector<double> padded_positions(std::span<const Point> points);

/// n vertices at zero in that layout. O(n).
AlignedVector<double> padded_zeros(Index n);

/// Throws InvalidArgument, naming `function`, unless positions and forces have the same size.
void check_same_size(std::span<const double> positions, std::span<const double> forces, const char* function);

}  // namespace meshorder
