// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Recursive spectral bisection (Pothen, Simon, Liou: Partitioning Sparse Matrices with Eigenvectors of
// Graphs, 1990) made into a linear order. Of each piece's two directions the one is taken that suits its
// neighbours outside (terminal propagation, Dunlop and Kernighan 1985).
#include <meshorder/base/parallel.hpp>
#include <meshorder/graph/components.hpp>
#include <meshorder/ordering/all_methods.hpp>
#include <meshorder/ordering/smoothed_bisection.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kSmall = 1000;      // pieces for which smoothed distances serve as well as Fiedler's vector
constexpr double kTolerance = 1.0;  // of Fiedler's vectors: where to cut is known long before they converge
constexpr int kMaxIterations = 30;
constexpr double kThickness = 1.0;

/// A part of a component, to be ordered by itself.
struct Piece {
  CsrGraph graph;
  std::vector<Index> names;  ///< of its vertices in the whole graph
  std::vector<float> pull;   ///< neighbours of each in earlier pieces less those in later ones
};

/// The vertices along the Fiedler vectors of the components, the component that is pulled forward most first.
std::vector<Index> along_fiedler_vector(const Piece& piece, std::uint64_t seed) {
  const FiedlerResult fiedler =
      fiedler_vector(piece.graph, {.tolerance = kTolerance, .max_iterations = kMaxIterations, .seed = seed});
  std::vector<std::pair<double, Index>> components;
  for (Index c = 0; c < index_size(fiedler.components); ++c) {
    double pull = 0;
    for (const Index v : fiedler.component_vertices[c]) pull += piece.pull[v];
    components.emplace_back(-pull / fiedler.components[c].size, c);
  }
  std::sort(components.begin(), components.end());
  std::vector<Index> sequence;
  sequence.reserve(piece.graph.size());
  std::vector<std::pair<double, Index>> sorted;
  for (const auto& component : components) {
    const std::vector<Index>& vertices = fiedler.component_vertices[component.second];
    double along = 0;
    for (const Index v : vertices) along += piece.pull[v] * fiedler.values[v];
    sorted.clear();
    for (const Index v : vertices) sorted.emplace_back(along > 0 ? -fiedler.values[v] : fiedler.values[v], v);
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [value, v] : sorted) sequence.push_back(v);
  }
  return sequence;
}

/// Into how many slabs a piece is cut: so many that a slab is about as thick as it is wide and high.
Index slabs_of(const CsrGraph& graph, const std::vector<Index>& sequence) {
  const Index n = graph.size();
  std::vector<Index> place(n);
  for (Index k = 0; k < n; ++k) place[sequence[k]] = k;
  double reach = 0;
  for (Index v = 0; v < n; ++v) {
    Index last = place[v];
    for (const Index u : graph[v]) last = std::max(last, place[u]);
    reach += last - place[v];
  }
  // the mean number of vertices before a place that have neighbours behind it
  const double front = std::max(1.0, reach / n);
  const double slabs = n / std::max<double>(kSmall, std::pow(kThickness * front, 1.5));
  return std::max<Index>(2, static_cast<Index>(slabs));
}

/// The vertices [begin, end) of the sequence as a piece of their own.
Piece slab(const Piece& piece, const std::vector<Index>& sequence, const std::vector<Index>& slab_of,
           Index begin, Index end) {
  std::vector<Index> vertices(sequence.begin() + begin, sequence.begin() + end);
  std::sort(vertices.begin(), vertices.end());
  Piece result;
  result.names.reserve(vertices.size());
  result.pull.reserve(vertices.size());
  for (const Index v : vertices) {
    Index pull = 0;
    for (const Index u : piece.graph[v])
      pull += (slab_of[u] < slab_of[v] ? 1 : 0) - (slab_of[u] > slab_of[v] ? 1 : 0);
    result.names.push_back(piece.names[v]);
    result.pull.push_back(piece.pull[v] + static_cast<float>(pull));
  }
  result.graph = induced_subgraph(piece.graph, vertices);
  return result;
}

/// Writes the names of the piece's vertices in their new order.
void write_in_order(Piece piece, std::uint64_t seed, Index* out) {
  const Index n = piece.graph.size();
  if (n <= kSmall || piece.graph.neighbours.empty()) {
    for (const Index v : smoothed_bisection(std::move(piece.graph), std::move(piece.pull)))
      *out++ = piece.names[v];
    return;
  }
  const std::vector<Index> sequence = along_fiedler_vector(piece, seed);
  const Index slabs = slabs_of(piece.graph, sequence);
  const auto begin_of = [&](Index s) { return static_cast<Index>(Offset{n} * s / slabs); };
  std::vector<Index> slab_of(n);
  for (Index s = 0; s < slabs; ++s) {
    for (Index k = begin_of(s); k < begin_of(s + 1); ++k) slab_of[sequence[k]] = s;
  }
  for_each_chunk(slabs, 1, [&](Index s, Index, Index) {
    write_in_order(slab(piece, sequence, slab_of, begin_of(s), begin_of(s + 1)), seed, out + begin_of(s));
  });
}

}  // namespace

Ordering spectral_vertices(const VertexProblem& problem, const OrderingOptions& options) {
  const CsrGraph& graph = problem.graph;
  std::vector<Index> new_to_old(graph.size());
  std::vector<Index> number(graph.size());
  Index* out = new_to_old.data();
  for (std::vector<Index>& component : connected_components(graph)) {
    const Index n = index_size(component);
    Piece piece;
    piece.graph.offsets.reserve(component.size() + 1);
    for (Index k = 0; k < n; ++k) number[component[k]] = k;
    for (const Index v : component) {
      for (const Index u : graph[v]) piece.graph.neighbours.push_back(number[u]);
      piece.graph.offsets.push_back(static_cast<Offset>(piece.graph.neighbours.size()));
    }
    piece.names = std::move(component);
    piece.pull.assign(n, 0);
    write_in_order(std::move(piece), options.seed, out);
    out += n;
  }
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace meshorder
