// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/view.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// The arrays of a graph in the library's own types, numbered from 0. Refers to the caller's arrays that have
/// these types already (int64 or uint64 offsets, int32 or uint32 neighbours, double weights, base 0), and
/// holds converted copies of the caller's other arrays.
///
/// Movable, not copyable: the spans refer to the caller's arrays or to the own ones.
struct GraphArrays {
  GraphArrays() = default;
  GraphArrays(GraphArrays&&) = default;
  GraphArrays& operator=(GraphArrays&&) = default;
  GraphArrays(const GraphArrays&) = delete;
  GraphArrays& operator=(const GraphArrays&) = delete;
  ~GraphArrays() = default;

  std::span<const Offset> offsets;  ///< n + 1, ascending from 0 to the number of neighbours
  std::span<const Index>
      neighbours;  ///< unchecked in the caller's array; −1 in a copy for numbers out of range
  std::span<const double> weights;  ///< unchecked; one for each neighbour, or none
  std::vector<Offset> own_offsets;
  std::vector<Index> own_neighbours;
  std::vector<double> own_weights;
  std::vector<std::string> notes;  ///< "indices narrowed"

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

/// Converts a view. Checks sizes and, unless `trusted`, offsets. Does not check neighbours and weights.
///
/// @throws InvalidArgument for sizes that do not match, offsets that descend, a base that is neither 0 nor 1
/// @throws TooLarge for more than 2,147,483,647 vertices
/// @note O(n) without copies, else O(n + entries), on all threads.
GraphArrays graph_arrays(const GraphView& graph, bool trusted = false);

}  // namespace meshorder
