// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/run_scope.hpp"
#include "spectral/hierarchy.hpp"
#include "spectral/lobpcg.hpp"

#include <cstdint>

namespace meshorder {

/// Number of start vectors: two columns separate λ₂ and λ₃ if they are close.
constexpr int kStartColumns = 2;
using StartBlock = VectorBlock<kStartColumns>;

/// Returns options with a low accuracy, for vectors on a coarse graph: prolongation to the next finer graph
/// limits the vectors' accuracy anyway.
[[nodiscard]] LobpcgOptions coarse_search(TimeLimit limit);

/// Returns start vectors on the finest graph. They begin as exact eigenvectors of the coarsest graph and are
/// improved on every graph in between. If the coarsest graph is too large for a dense solver, they are
/// random. O(graph).
[[nodiscard]] StartBlock nested_start(const Hierarchy& hierarchy, std::uint64_t seed, TimeLimit limit);

/// Sets the columns of a block from `first_column` on to random entries between −1/2 and 1/2.
void fill_with_noise(StartBlock& x, int first_column, std::uint64_t seed);

/// Returns a column of start vectors. O(n).
[[nodiscard]] VectorBlock<1> column(const StartBlock& x, int m);

}  // namespace meshorder
