// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <metis.h>

#include <cstdint>
#include <vector>

namespace meshorder {

/// A graph in METIS's own arrays, and options that make METIS reproducible.
struct MetisGraph {
  idx_t size = 0;
  std::vector<idx_t> offsets;
  std::vector<idx_t> neighbours;
  idx_t options[METIS_NOPTIONS] = {};

  /// Throws InvalidArgument for a graph with more entries than METIS's integers count.
  MetisGraph(const CsrGraph& graph, std::uint64_t seed);
};

/// Throws std::runtime_error, naming the call, unless METIS reports success.
void check_metis(int status, const char* call);

}  // namespace meshorder
