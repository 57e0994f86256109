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
/// Movable, not copyable: the spans of a copy would refer to the converted arrays of the original.
struct GraphArrays {
  GraphArrays() = default;
  GraphArrays(GraphArrays&&) = default;
  GraphArrays& operator=(GraphArrays&&) = default;
  GraphArrays(const GraphArrays&) = delete;
  GraphArrays& operator=(const GraphArrays&) = delete;
  ~GraphArrays() = default;

  std::span<const Offset> offsets;    ///< n + 1, ascending from 0 to the number of neighbours
  std::span<const Index> neighbours;  ///< unchecked; in a converted copy, −1 replaces numbers out of range
  std::span<const double> weights;    ///< unchecked; one for each neighbour, or none
  std::vector<Offset> own_offsets;
  std::vector<Index> own_neighbours;
  std::vector<double> own_weights;
  std::vector<std::string> notes;  ///< "indices narrowed"

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

/// Converts a view. Checks its base, sizes and, unless `trusted`, offsets; not neighbours and weights.
///
/// @throws InvalidArgument for sizes that do not match, offsets that descend or do not begin at the base, a
///         base other than 0 and 1
/// @throws TooLarge for more than 2,147,483,647 vertices
/// @note O(n) if neighbours and weights are not copied, else O(n + entries); neighbours on all threads.
GraphArrays graph_arrays(const GraphView& graph, bool trusted = false);

}  // namespace meshorder
