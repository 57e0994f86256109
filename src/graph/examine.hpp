// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/graph_arrays.hpp"

#include <cstdint>

namespace meshorder {

/// Counts of a graph's deviations from a clean graph, and a hash of the graph's asymmetry.
struct GraphFindings {
  Offset out_of_range = 0;  ///< neighbours outside 0 … n−1
  Offset bad_weights = 0;   ///< not positive or not finite
  Offset loops = 0;
  Offset unordered = 0;         ///< neighbours ≤ the neighbour before them in their row; includes repeats
  std::uint64_t asymmetry = 0;  ///< Σ hash(v, u) if v < u, −hash(v, u) if v > u, modulo 2⁶⁴; see `examine`

  [[nodiscard]] bool is_clean() const noexcept { return loops == 0 && unordered == 0; }
  GraphFindings& operator+=(const GraphFindings& other) noexcept;
};

/// Examines all entries in one pass.
///
/// The hash of an entry includes the weight. `asymmetry` is 0 for a symmetric graph whose repeats are
/// symmetric too; for a random asymmetric graph it is 0 with probability 2⁻⁶⁴.
///
/// @param symmetry  whether to compute `asymmetry`
/// @note O(n + entries), on all threads; the result does not depend on their number.
GraphFindings examine(const GraphArrays& graph, bool symmetry);

/// Throws InvalidArgument for the first entry with a neighbour out of range or a bad weight; returns if there
/// is none. The message quotes the caller's numbers in `view`. O(n + entries).
void refuse_faults(const GraphView& view, const GraphArrays& graph, const GraphFindings& findings);

/// Throws InvalidArgument for the first edge of a clean graph that is in one row only or has two weights;
/// returns if there is no such edge. Uses a cursor for each row: O(n + entries) time, 8 n bytes of memory.
///
/// @param base  number of the first vertex in messages
void refuse_asymmetry(std::span<const Offset> offsets, std::span<const Index> neighbours,
                      std::span<const double> weights, int base);

}  // namespace meshorder
