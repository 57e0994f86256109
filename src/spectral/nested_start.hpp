// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/run_scope.hpp"
#include "spectral/hierarchy.hpp"
#include "spectral/lobpcg.hpp"

#include <cstdint>

namespace meshorder {

/// Vectors from graph to finer graph: two columns keep λ₂ and λ₃ apart where they are close.
constexpr int kStartColumns = 2;
using StartBlock = VectorBlock<kStartColumns>;

/// How far vectors on a coarse graph are improved: the start on the next finer one is no better than
/// prolongation makes it.
[[nodiscard]] LobpcgOptions coarse_search(TimeLimit limit);

/// Returns start vectors on the finest graph: exact on the coarsest, improved on every graph between.
/// O(graph).
[[nodiscard]] StartBlock nested_start(const Hierarchy& hierarchy, std::uint64_t seed, TimeLimit limit);

/// Sets random entries between −1/2 and 1/2 in the columns from `first_column` on of a block.
void fill_with_noise(StartBlock& x, int first_column, std::uint64_t seed);

/// Returns a column of start vectors. O(n).
[[nodiscard]] VectorBlock<1> column(const StartBlock& x, int m);

}  // namespace meshorder
