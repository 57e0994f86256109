// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::test {

/// A connected graph whose vertices fall into clusters.
struct ClusteredGraph {
  std::string name;
  CsrGraph graph;
  std::vector<Index> cluster_of;  ///< of each vertex
  std::vector<double> weights;    ///< as `fiedler_vectors` takes them
};

/// How large the graphs of `clustered_graph` are, roughly, in vertices.
struct ClusteredSizes {
  Index least = 61;
  Index most = 160;
};

/// Random graphs on which simple criteria take another eigenvector for the Fiedler vector: stochastic blocks,
/// cliques joined along paths, cycles, stars and trees, lollipops, hubs, joined bipartite graphs and
/// expanders, and grids as a control. A third of them have weights, half of them are renumbered at random.
///
/// @param seed  each graph has one of its own; 13 seeds in a row go through all families
ClusteredGraph clustered_graph(std::uint64_t seed, ClusteredSizes sizes = {});

}  // namespace meshorder::test
