// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/laplacian.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::test {

/// Whether this build has a sanitizer, which makes everything about ten times slower.
#ifdef MESHORDER_IS_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// The size of a large test: `n`, a tenth of it when sanitized.
constexpr Index large(Index n) { return kSanitized ? n / 10 : n; }

struct NamedGraph {
  std::string name;
  CsrGraph graph;
};

/// Returns the Laplacian of a graph whose edges all have weight 1.
Laplacian combinatorial_laplacian(const CsrGraph& graph);

CsrGraph path(Index n);
CsrGraph cycle(Index n);
/// Vertex 0 joined to all n−1 others.
CsrGraph star(Index n);
CsrGraph complete(Index n);
/// 0 … a−1 joined to a … a+b−1.
CsrGraph complete_bipartite(Index a, Index b);
/// a × b × c vertices joined along the axes; vertex (i, j, k) is (k b + j) a + i.
CsrGraph grid(Index a, Index b, Index c = 1);
/// 2^d vertices, joined where their numbers differ in one bit.
CsrGraph hypercube(int d);

/// A random tree and `extra` random edges, some of which may coincide.
CsrGraph random_connected(Index n, Index extra, std::uint64_t seed);
/// The union of d/2 random cycles through all vertices: an expander of degree d, except at the few edges that
/// coincide.
CsrGraph random_regular(Index n, Index d, std::uint64_t seed);
/// Each new vertex joined to m ends of random earlier edges (Barabási and Albert 1999).
CsrGraph preferential_attachment(Index n, Index m, std::uint64_t seed);

/// The graphs side by side, in their order.
CsrGraph disjoint_union(const std::vector<CsrGraph>& graphs);

/// Throws InvalidArgument unless the graph has the invariants of its type.
void check_graph(GraphRef graph);

}  // namespace meshorder::test
