// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/incidence.hpp"

#include <array>
#include <span>

namespace meshorder {

/// Numbers of consecutive elements for which working sets are counted: powers of two, ascending.
inline constexpr std::array<Index, 3> kElementsAtOnce{64, 512, 4096};

/// Returns for each of `kElementsAtOnce` the mean number of distinct vertices that so many consecutive
/// elements use in that order (Denning 1968: The working set model for program behavior). The data of these
/// vertices, and of pairs of them, pass through the caches in this time.
///
/// Counted at up to 15 places, evenly spread. O(vertices + 61,440 elements).
///
/// @param new_to_old  the order of all elements; empty: as they are numbered
std::array<double, kElementsAtOnce.size()> working_sets(IncidenceRef elements,
                                                        std::span<const Index> new_to_old);

}  // namespace meshorder
