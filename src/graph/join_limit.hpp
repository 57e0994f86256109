// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "graph/incidence.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace meshorder {

/// A graph can join all members of each row. The memory limit on such graphs counts only rows with more
/// members than this.
inline constexpr std::size_t kManyJoined = 64;

/// Largest memory for ordering, in bytes for each entry of such a graph; includes the graph and its copies.
inline constexpr std::uint64_t kBytesToOrder = 24;

/// Limits the memory of each graph that this process makes from long rows, and of the data computed from it.
/// `memory_limit` also applies. Must not be called while other threads order.
///
/// @param bytes           for a graph and all that is computed from it
/// @param bytes_of_entry  estimated bytes for each entry of the graph
void limit_joins(std::uint64_t bytes, std::uint64_t bytes_of_entry = kBytesToOrder);

/// Words for messages about a graph that joins the members of each row.
struct JoinNames {
  const char* row = "cell";
  const char* members = "vertices";
  const char* remedy = "cut such cells";
  std::function<Index(Index)> number_of = {};  ///< returns the number of a row; empty: the row's place
};

/// As `joined_vertices`, with other words in the message of TooLarge.
CsrGraph joined_vertices(IncidenceRef elements, const JoinNames& names);

}  // namespace meshorder
