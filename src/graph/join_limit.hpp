// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "graph/incidence.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace meshorder {

/// Rows of more members than this are long. Only long rows count for the memory limit on a graph that joins
/// all members of each row.
inline constexpr std::size_t kManyJoined = 64;

/// Most bytes that ordering takes for each entry of such a graph, including the graph and its copies.
inline constexpr std::uint64_t kBytesToOrder = 24;

/// Limits the memory of each graph that this process makes from long rows, including data computed from the
/// graph. `memory_limit` also applies. Must not be called while other threads order.
///
/// @param bytes           limit for a graph and all data computed from the graph
/// @param bytes_of_entry  estimated bytes for each entry of the graph
void limit_joins(std::uint64_t bytes, std::uint64_t bytes_of_entry = kBytesToOrder);

/// Words for messages about a graph that joins the members of each row.
struct JoinNames {
  const char* row = "cell";
  const char* members = "vertices";
  const char* remedy = "cut such cells";
  std::function<Index(Index)> number_of = {};  ///< returns a row's number; empty: use the row's place
};

/// Like `joined_vertices`, with other words in the message of TooLarge.
CsrGraph joined_vertices(IncidenceRef elements, const JoinNames& names);

}  // namespace meshorder
