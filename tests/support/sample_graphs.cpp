// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/sample_graphs.hpp"

#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <random>
#include <string>

namespace meshorder::test {
namespace {

Index below(std::mt19937_64& random, Index bound) {
  return static_cast<Index>(random() % static_cast<std::uint64_t>(bound));
}

}  // namespace

Laplacian combinatorial_laplacian(const CsrGraph& graph) {
  Laplacian laplacian{graph.offsets, graph.neighbours, {}, std::vector<double>(graph.size())};
  for (Index v = 0; v < graph.size(); ++v) laplacian.diagonal[v] = graph.degree(v);
  return laplacian;
}

CsrGraph path(Index n) {
  std::vector<Edge> edges;
  for (Index v = 1; v < n; ++v) edges.push_back({v - 1, v});
  return graph_from_edges(n, edges);
}

CsrGraph cycle(Index n) {
  std::vector<Edge> edges;
  for (Index v = 0; v < n; ++v) edges.push_back({v, (v + 1) % n});
  return graph_from_edges(n, edges);
}

CsrGraph star(Index n) { return complete_bipartite(1, n - 1); }

CsrGraph complete(Index n) {
  std::vector<Edge> edges;
  for (Index a = 0; a < n; ++a) {
    for (Index b = 0; b < a; ++b) edges.push_back({a, b});
  }
  return graph_from_edges(n, edges);
}

CsrGraph complete_bipartite(Index a, Index b) {
  std::vector<Edge> edges;
  for (Index i = 0; i < a; ++i) {
    for (Index j = 0; j < b; ++j) edges.push_back({i, a + j});
  }
  return graph_from_edges(a + b, edges);
}

CsrGraph grid(Index a, Index b, Index c) {
  std::vector<Edge> edges;
  for (Index k = 0; k < c; ++k) {
    for (Index j = 0; j < b; ++j) {
      for (Index i = 0; i < a; ++i) {
        const Index v = (k * b + j) * a + i;
        if (i > 0) edges.push_back({v, v - 1});
        if (j > 0) edges.push_back({v, v - a});
        if (k > 0) edges.push_back({v, v - a * b});
      }
    }
  }
  return graph_from_edges(a * b * c, edges);
}

CsrGraph hypercube(int d) {
  const Index n = Index{1} << d;
  std::vector<Edge> edges;
  for (Index v = 0; v < n; ++v) {
    for (int bit = 0; bit < d; ++bit) edges.push_back({v, v ^ (Index{1} << bit)});
  }
  return graph_from_edges(n, edges);
}

CsrGraph random_connected(Index n, Index extra, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Edge> edges;
  for (Index v = 1; v < n; ++v) edges.push_back({v, below(random, v)});
  for (Index e = 0; e < extra; ++e) edges.push_back({below(random, n), below(random, n)});
  return graph_from_edges(n, edges);
}

CsrGraph random_regular(Index n, Index d, std::uint64_t seed) {
  std::vector<Edge> edges;
  for (Index c = 0; c < d / 2; ++c) {
    const auto around = shuffled(n, seed + static_cast<std::uint64_t>(c)).new_to_old();
    for (Index k = 0; k < n; ++k) edges.push_back({around[k], around[(k + 1) % n]});
  }
  return graph_from_edges(n, edges);
}

CsrGraph preferential_attachment(Index n, Index m, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Edge> edges{{0, 1}};
  for (Index v = 2; v < n; ++v) {
    const Index earlier = index_size(edges);
    for (Index k = 0; k < m; ++k) {
      const Edge& edge = edges[below(random, earlier)];
      edges.push_back({v, random() % 2 == 0 ? edge.a : edge.b});
    }
  }
  return graph_from_edges(n, edges);
}

CsrGraph disjoint_union(const std::vector<CsrGraph>& graphs) {
  CsrGraph result;
  for (const CsrGraph& graph : graphs) {
    const Index first = result.size();
    for (Index v = 0; v < graph.size(); ++v) {
      for (const Index u : graph[v]) result.neighbours.push_back(first + u);
      result.offsets.push_back(static_cast<Offset>(result.neighbours.size()));
    }
  }
  return result;
}

void check_graph(GraphRef graph) {
  if (graph.offsets.empty() || graph.offsets.front() != 0 ||
      graph.offsets.back() != static_cast<Offset>(graph.neighbours.size()) ||
      !std::is_sorted(graph.offsets.begin(), graph.offsets.end())) {
    throw InvalidArgument("graph: offsets do not fit the neighbours");
  }
  for (Index v = 0; v < graph.size(); ++v) {
    Index last = -1;
    for (const Index u : graph[v]) {
      if (u <= last || u >= graph.size() || u == v) {
        throw InvalidArgument("graph: the neighbours of " + std::to_string(v) +
                              " must rise within the graph and leave out " + std::to_string(v));
      }
      last = u;
    }
  }
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) {
      if (!std::binary_search(graph[u].begin(), graph[u].end(), v)) {
        throw InvalidArgument("graph: edge " + std::to_string(v) + "–" + std::to_string(u) +
                              " stands in one row only");
      }
    }
  }
}

}  // namespace meshorder::test
