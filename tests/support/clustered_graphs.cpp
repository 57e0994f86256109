// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/clustered_graphs.hpp"

#include "base/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace meshorder::test {
namespace {

/// Collects the edges of a graph that is made of clusters.
class Builder {
 public:
  explicit Builder(Random& random) : random_(random) {}

  Index below(Index bound) { return static_cast<Index>(random_.below(static_cast<std::uint64_t>(bound))); }
  Index between(Index least, Index most) { return least + below(most - least + 1); }
  template <std::size_t N>
  double one_of(const double (&values)[N]) {
    return values[random_.below(N)];
  }
  bool chance(double probability) { return random_.unit() < probability; }

  void join(Index a, Index b) { edges_.push_back({a, b}); }

  /// Adds vertices of a new cluster, without edges; returns the first.
  Index add(Index size) {
    const Index first = size_;
    starts_.push_back(first);
    size_ += size;
    return first;
  }

  /// Adds a cluster in which two vertices are joined with that probability.
  void add_cluster(Index size, double density) {
    const Index first = add(size);
    for (Index a = first; a < size_; ++a) {
      for (Index b = first; b < a; ++b) {
        if (density >= 1 || chance(density)) join(a, b);
      }
    }
  }

  [[nodiscard]] Index size() const { return size_; }
  [[nodiscard]] Index cluster_count() const { return index_size(starts_); }
  [[nodiscard]] Index first_of(Index cluster) const { return starts_[cluster]; }
  [[nodiscard]] Index size_of(Index cluster) const {
    return (cluster + 1 < cluster_count() ? starts_[cluster + 1] : size_) - starts_[cluster];
  }
  Index any_of(Index cluster) { return first_of(cluster) + below(size_of(cluster)); }

  /// Joins two vertices by a path of that many edges.
  void bridge(Index a, Index b, Index length) {
    for (; length > 1; --length) {
      const Index next = add(1);
      join(a, next);
      a = next;
    }
    join(a, b);
  }

  /// Returns the graph, after joining all other components to the component of vertex 0 by edges.
  ClusteredGraph graph(std::string name) {
    std::vector<Index> root(size_);
    std::iota(root.begin(), root.end(), Index{0});
    const auto find = [&](Index v) {
      while (root[v] != v) v = root[v] = root[root[v]];
      return v;
    };
    for (const Edge& edge : edges_) root[find(edge.a)] = find(edge.b);
    for (Index v = 1; v < size_; ++v) {
      if (find(v) == find(0)) continue;
      const Index other = below(v);
      join(v, find(other) == find(0) ? other : 0);
      root[find(v)] = find(0);
    }
    ClusteredGraph result{std::move(name), graph_from_edges(size_, edges_), std::vector<Index>(size_), {}};
    for (Index c = 0; c < cluster_count(); ++c) {
      std::fill_n(result.cluster_of.begin() + first_of(c), size_of(c), c);
    }
    return result;
  }

 private:
  Random& random_;
  std::vector<Edge> edges_;
  std::vector<Index> starts_;
  Index size_ = 0;
};

/// Sizes of clusters that add up to n, equal or random.
std::vector<Index> cluster_sizes(Builder& b, Index n, Index clusters) {
  std::vector<double> shares(clusters, 1);
  const double spread = b.one_of({0, 0, 0.5, 1.5});
  for (double& share : shares) share = std::exp(spread * (b.below(1000) / 500.0 - 1));
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  std::vector<Index> sizes;
  for (const double share : shares) sizes.push_back(std::max(Index{2}, static_cast<Index>(n * share / sum)));
  return sizes;
}

ClusteredGraph stochastic_blocks(Builder& b, Index n) {
  const Index blocks = b.between(2, 10);
  const double inside = b.one_of({0.05, 0.15, 0.3, 0.6, 0.9});
  const double between = inside * b.one_of({0.001, 0.01, 0.05, 0.2, 0.6});
  for (const Index size : cluster_sizes(b, n, blocks)) b.add_cluster(size, inside);
  for (Index c = 0; c < blocks; ++c) {
    for (Index v = b.first_of(c); v < b.first_of(c) + b.size_of(c); ++v) {
      for (Index u = 0; u < b.first_of(c); ++u) {
        if (b.chance(between)) b.join(u, v);
      }
    }
  }
  return b.graph("stochastic blocks");
}

/// Clusters joined along the edges of a small graph, by paths between their first or random vertices.
ClusteredGraph joined(Builder& b, Index n, Index clusters, const std::vector<Edge>& edges, std::string name) {
  const double density = b.one_of({1, 1, 1, 0.5});
  for (const Index size : cluster_sizes(b, n, clusters)) b.add_cluster(size, density);
  const Index length = static_cast<Index>(b.one_of({1, 1, 1, 2, 5, 20}));
  const Index width = static_cast<Index>(b.one_of({1, 1, 1, 2, 4}));
  const bool first = b.chance(0.4);
  for (const auto& [x, y] : edges) {
    for (Index k = 0; k < width; ++k)
      b.bridge(first ? b.first_of(x) : b.any_of(x), first ? b.first_of(y) : b.any_of(y), length);
  }
  return b.graph(std::move(name));
}

ClusteredGraph barbell(Builder& b, Index n) { return joined(b, n, 2, {{0, 1}}, "barbell"); }

ClusteredGraph cliques_on_path(Builder& b, Index n) {
  const Index clusters = b.between(3, 12);
  std::vector<Edge> edges;
  for (Index c = 1; c < clusters; ++c) edges.push_back({c - 1, c});
  return joined(b, n, clusters, edges, "cliques on a path");
}

ClusteredGraph caves(Builder& b, Index n) {
  const Index clusters = b.between(3, 12);
  std::vector<Edge> edges;
  for (Index c = 0; c < clusters; ++c) edges.push_back({c, (c + 1) % clusters});
  return joined(b, n, clusters, edges, "caves");
}

ClusteredGraph cliques_on_star(Builder& b, Index n) {
  const Index clusters = b.between(3, 20);
  std::vector<Edge> edges;
  for (Index c = 1; c < clusters; ++c) edges.push_back({0, c});
  return joined(b, n, clusters, edges, "cliques on a star");
}

/// Two stars of equal clusters, joined: many equal eigenvalues above the smallest.
ClusteredGraph cliques_on_two_stars(Builder& b, Index n) {
  const Index clusters = 2 * b.between(3, 12);
  std::vector<Edge> edges{{0, clusters / 2}};
  for (Index c = 1; c < clusters / 2; ++c)
    edges.insert(edges.end(), {{0, c}, {clusters / 2, clusters / 2 + c}});
  return joined(b, n, clusters, edges, "cliques on two stars");
}

/// A random tree whose leaves are cliques.
ClusteredGraph tree_of_cliques(Builder& b, Index n) {
  const Index inner = b.between(2, 20);
  const Index leaves = b.between(2, 12);
  for (Index v = 0; v < inner; ++v) {
    b.add(1);
    if (v > 0) b.join(v, b.below(v));
  }
  for (const Index size : cluster_sizes(b, n, leaves)) {
    const Index first = b.size();
    b.add_cluster(size, 1);
    b.join(b.below(inner), first);
  }
  return b.graph("tree of cliques");
}

ClusteredGraph lollipop(Builder& b, Index n) {
  const Index head = b.between(n / 4, n);
  b.add_cluster(head, b.one_of({1, 0.5}));
  Index last = b.any_of(0);
  for (Index tails = b.between(1, 3); tails > 0; --tails) {
    const Index next = b.add(1);
    b.bridge(tails == 1 ? last : b.any_of(0), next, b.between(1, std::max(Index{1}, n - head)));
  }
  return b.graph("lollipop");
}

/// Hubs that are joined to all or some of the other vertices.
ClusteredGraph hubs(Builder& b, Index n) {
  const Index count = b.between(1, 5);
  b.add(n);
  const double share = b.one_of({1, 0.8, 0.3});
  for (Index hub = 0; hub < count; ++hub) {
    for (Index v = count; v < n; ++v) {
      if (b.chance(share)) b.join(hub, v);
    }
  }
  const Index more = b.chance(0.5) ? n / 2 : 0;
  for (Index k = 0; k < more; ++k) b.join(b.below(n), b.below(n));
  return b.graph("hubs");
}

/// Cliques that have a vertex in common.
ClusteredGraph windmill(Builder& b, Index n) {
  const Index sails = b.between(2, 30);
  b.add(1);
  for (const Index size : cluster_sizes(b, n, sails)) {
    const Index first = b.size();
    b.add_cluster(size, 1);
    for (Index v = first; v < b.size(); ++v) b.join(0, v);
  }
  return b.graph("windmill");
}

/// Complete bipartite graphs, one or several joined by edges.
ClusteredGraph bipartite(Builder& b, Index n) {
  const Index parts = b.between(1, 4);
  for (const Index size : cluster_sizes(b, n, parts)) {
    const Index first = b.add(size);
    const Index side = b.between(1, std::max(Index{1}, size - 1));
    for (Index u = first; u < first + side; ++u) {
      for (Index v = first + side; v < first + size; ++v) b.join(u, v);
    }
    if (first > 0) b.join(b.below(first), first + b.below(size));
  }
  return b.graph("bipartite");
}

/// Expanders: random cycles through all vertices of a cluster.
ClusteredGraph expanders(Builder& b, Index n) {
  const Index parts = b.between(1, 4);
  const Index cycles = static_cast<Index>(b.one_of({1, 2, 3, 8, 20}));
  for (const Index size : cluster_sizes(b, n, parts)) {
    const Index first = b.add(size);
    std::vector<Index> sequence(size);
    std::iota(sequence.begin(), sequence.end(), first);
    for (Index k = 0; k < cycles; ++k) {
      for (Index i = size; i > 1; --i) std::swap(sequence[i - 1], sequence[b.below(i)]);
      for (Index i = 0; i < size; ++i) b.join(sequence[i], sequence[(i + 1) % size]);
    }
    if (first > 0) b.join(b.below(first), first + b.below(size));
  }
  return b.graph("expanders");
}

ClusteredGraph grid(Builder& b, Index n) {
  const Index width = b.between(2, 10);
  const Index length = n / width + 1;
  b.add(width * length);
  for (Index v = 0; v < width * length; ++v) {
    if (v % width != 0) b.join(v - 1, v);
    if (v >= width) b.join(v - width, v);
  }
  return b.graph("grid");
}

constexpr std::array kFamilies = {stochastic_blocks,
                                  barbell,
                                  cliques_on_path,
                                  caves,
                                  cliques_on_star,
                                  cliques_on_two_stars,
                                  tree_of_cliques,
                                  lollipop,
                                  hubs,
                                  windmill,
                                  bipartite,
                                  expanders,
                                  grid};

void renumber(Builder& b, ClusteredGraph& graph) {
  const Index n = graph.graph.size();
  std::vector<Index> number(n);
  std::iota(number.begin(), number.end(), Index{0});
  for (Index i = n; i > 1; --i) std::swap(number[i - 1], number[b.below(i)]);
  std::vector<Index> cluster_of(n);
  for (Index v = 0; v < n; ++v) cluster_of[number[v]] = graph.cluster_of[v];
  graph.graph = renumbered(graph.graph, number);
  graph.cluster_of = std::move(cluster_of);
}

/// Weights that are lower or higher between clusters, and vary.
void weigh(Builder& b, ClusteredGraph& graph) {
  const double between = b.one_of({1, 0.01, 1e-4, 100});
  const double spread = b.one_of({0, 1, 3});
  const auto salt = static_cast<std::uint64_t>(b.below(1000));
  for (Index v = 0; v < graph.graph.size(); ++v) {
    for (const Index u : graph.graph[v]) {
      Random random(std::uint64_t{1'000'003} * std::min(u, v) + std::max(u, v) + 7919 * salt);
      const double varied = std::exp(spread * (random.unit() - 0.5));
      graph.weights.push_back(graph.cluster_of[u] == graph.cluster_of[v] ? varied : between * varied);
    }
  }
}

}  // namespace

ClusteredGraph clustered_graph(std::uint64_t seed, ClusteredSizes sizes) {
  Random random(seed);
  Builder b(random);
  const Index n = b.between(sizes.least, sizes.most);
  ClusteredGraph result = kFamilies[seed % kFamilies.size()](b, n);
  if (b.chance(0.5)) renumber(b, result);
  if (b.chance(0.33)) weigh(b, result);
  return result;
}

}  // namespace meshorder::test
