// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Recursive spectral bisection (Pothen, Simon, Liou: Partitioning Sparse Matrices with Eigenvectors of
// Graphs, 1990) as a linear order. Either half of a cut can come first; the choice brings vertices near their
// neighbours outside the piece (terminal propagation: Dunlop and Kernighan 1985).
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "graph/traversal.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"
#include "spectral/fiedler.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kSmall = 4000;    // smaller pieces: smoothed distances cut as well as Fiedler vectors, faster
constexpr double kTolerance = 1;  // a rough vector suffices for the place of a cut
constexpr int kMaxIterations = 30;
constexpr double kThickness = 0.8;  // least thickness of slabs, see `cut`: less saves time, lengthens spans

/// A part of a component that is ordered by itself.
struct Piece {
  CsrGraph graph;
  std::vector<Index> names;  ///< the number of each of its vertices in the whole graph
  std::vector<float> pull;   ///< by vertex: neighbours in earlier pieces minus neighbours in later pieces
};

/// Returns a component of the graph as a piece. `component` lists its vertices, ascending. `number` has an
/// entry for each vertex of the graph; the entries of the component's vertices are changed. O(component).
Piece whole_component(const VertexInput& input, std::vector<Index> component, std::vector<Index>& number) {
  Piece piece;
  for (Index k = 0; k < index_size(component); ++k) number[component[k]] = k;
  piece.graph.offsets.reserve(component.size() + 1);
  for (const Index v : component) {
    poll_in_loop(v);
    for (const Index u : input.graph[v]) piece.graph.neighbours.push_back(number[u]);
    piece.graph.offsets.push_back(static_cast<Offset>(piece.graph.neighbours.size()));
  }
  piece.pull.assign(component.size(), 0);
  if (!input.pull.empty()) {
    for (Index k = 0; k < index_size(component); ++k) piece.pull[k] = input.pull[component[k]];
  }
  piece.names = std::move(component);
  return piece;
}

/// Returns the piece's vertices along its Fiedler vector. If the piece is not connected, they are ordered
/// component by component, the one with the largest mean pull first.
std::vector<Index> along_fiedler_vector(const Piece& piece, std::uint64_t seed) {
  const FiedlerVectors fiedler =
      fiedler_vectors(piece.graph, {.tolerance = kTolerance, .max_iterations = kMaxIterations, .seed = seed});
  std::vector<std::pair<double, Index>> components;
  for (Index c = 0; c < index_size(fiedler.components); ++c) {
    double pull = 0;
    for (const Index v : fiedler.component_vertices[c]) pull += piece.pull[v];
    components.emplace_back(-pull / fiedler.components[c].size, c);
  }
  std::sort(components.begin(), components.end());
  std::vector<Index> sequence;
  sequence.reserve(piece.names.size());
  std::vector<std::pair<double, Index>> sorted;
  for (const auto& component : components) {
    const std::vector<Index>& vertices = fiedler.component_vertices[component.second];
    double along = 0;
    for (const Index v : vertices) along += piece.pull[v] * fiedler.values[v];
    const double sign = along > 0 ? -1 : 1;
    sorted.clear();
    for (const Index v : vertices) sorted.emplace_back(sign * fiedler.values[v], v);
    sort_distinct(sorted);
    for (const auto& entry : sorted) sequence.push_back(entry.second);
  }
  return sequence;
}

/// Returns the mean front over all places of the sequence: the number of vertices before a place with
/// neighbours after that place. This is the size of the piece's cross-section. At least 1.
double mean_front(GraphRef graph, const std::vector<Index>& sequence) {
  std::vector<Index> place(sequence.size());
  for (Index k = 0; k < graph.size(); ++k) place[sequence[k]] = k;
  double sum = 0;
  for (Index v = 0; v < graph.size(); ++v) {
    poll_in_loop(v);
    Index last = place[v];
    for (const Index u : graph[v]) last = std::max(last, place[u]);
    sum += last - place[v];
  }
  return std::max(1.0, sum / graph.size());
}

/// A sequence cut into slabs whose sizes differ by at most one vertex.
struct Slabs {
  std::vector<Index> sequence;
  Index count = 2;
  std::vector<Index> slab_of;  ///< the slab of each vertex

  [[nodiscard]] Index begin_of(Index slab) const {
    return static_cast<Index>(Offset{index_size(sequence)} * slab / count);
  }
};

/// Cuts the sequence into two halves; into more slabs if each is then at least about 0.7 times as thick as it
/// is wide. One vector then replaces several successive cuts.
Slabs cut(GraphRef graph, std::vector<Index> sequence) {
  Slabs slabs;
  const double least = std::pow(kThickness * mean_front(graph, sequence), 1.5);
  slabs.count = std::max(Index{2}, static_cast<Index>(graph.size() / std::max<double>(kSmall, least)));
  slabs.sequence = std::move(sequence);
  slabs.slab_of.resize(slabs.sequence.size());
  for (Index s = 0; s < slabs.count; ++s) {
    for (Index k = slabs.begin_of(s); k < slabs.begin_of(s + 1); ++k) slabs.slab_of[slabs.sequence[k]] = s;
  }
  return slabs;
}

/// Returns a slab as a piece of its own. Its vertices are numbered along the sequence, so that neighbours are
/// near each other.
Piece piece_of(const Piece& whole, const Slabs& slabs, Index slab) {
  const std::span<const Index> vertices(slabs.sequence.data() + slabs.begin_of(slab),
                                        slabs.sequence.data() + slabs.begin_of(slab + 1));
  Piece piece;
  piece.names.reserve(vertices.size());
  piece.pull.reserve(vertices.size());
  for (const Index v : vertices) {
    poll_in_loop(piece.names.size());
    Index pull = 0;
    for (const Index u : whole.graph[v]) {
      if (slabs.slab_of[u] < slab) ++pull;
      if (slabs.slab_of[u] > slab) --pull;
    }
    piece.names.push_back(whole.names[v]);
    piece.pull.push_back(whole.pull[v] + static_cast<float>(pull));
  }
  piece.graph = induced_subgraph(whole.graph, vertices);
  return piece;
}

/// Writes the names of the piece's vertices in their new order to `out`. After the time limit, pieces
/// stay in the order that earlier cuts gave them.
void write_in_order(Piece piece, std::uint64_t seed, TimeLimit limit, Index* out) {
  poll();
  if (piece.graph.neighbours.empty() || limit.is_over()) {
    std::copy(piece.names.begin(), piece.names.end(), out);
    return;
  }
  if (piece.graph.size() <= kSmall) {
    for (const Index v : smoothed_bisection(std::move(piece.graph), std::move(piece.pull))) {
      *out++ = piece.names[v];
    }
    return;
  }
  const Slabs slabs = cut(piece.graph, along_fiedler_vector(piece, seed));
  for_each_chunk(slabs.count, 1, [&](Index slab, Index, Index) {
    write_in_order(piece_of(piece, slabs, slab), seed, limit, out + slabs.begin_of(slab));
  });
}

/// Returns the components of the graph; if the graph is a part of a larger one, sorted by mean pull, the
/// largest first.
std::vector<std::vector<Index>> components_in_order(const VertexInput& input) {
  std::vector<std::vector<Index>> components = connected_components(input.graph);
  if (input.pull.empty() || components.size() < 2) return components;
  std::vector<std::pair<double, std::size_t>> places;
  for (std::size_t c = 0; c < components.size(); ++c) {
    double pull = 0;
    for (const Index v : components[c]) pull += input.pull[v];
    places.emplace_back(-pull / index_size(components[c]), c);
  }
  std::sort(places.begin(), places.end());
  std::vector<std::vector<Index>> sorted;
  sorted.reserve(components.size());
  for (const auto& place : places) sorted.push_back(std::move(components[place.second]));
  return sorted;
}

}  // namespace

Order spectral_vertices(const VertexInput& input, const OrderOptions& options) {
  std::vector<Index> new_to_old(input.graph.size());
  std::vector<Index> number(input.graph.size());
  const TimeLimit limit;
  Index* out = new_to_old.data();
  for (std::vector<Index>& component : components_in_order(input)) {
    const Index size = index_size(component);
    write_in_order(whole_component(input, std::move(component), number), options.seed, limit, out);
    out += size;
  }
  return {.permutation = Permutation::from_new_to_old(std::move(new_to_old)), .complete = !limit.is_over()};
}

}  // namespace meshorder
