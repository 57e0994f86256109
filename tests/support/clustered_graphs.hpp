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

/// The approximate range of sizes of `clustered_graph`, in vertices.
struct ClusteredSizes {
  Index least = 61;
  Index most = 160;
};

/// Returns one of the random graphs on which simple criteria mistake another eigenvector for the Fiedler
/// vector: stochastic blocks, cliques joined along paths, cycles, stars and trees, lollipops, hubs, joined
/// bipartite graphs and expanders, and grids as a control. A third of them have weights, half have random
/// numbering.
///
/// @param seed  selects the graph; 13 consecutive seeds go through all families
ClusteredGraph clustered_graph(std::uint64_t seed, ClusteredSizes sizes = {});

}  // namespace meshorder::test
