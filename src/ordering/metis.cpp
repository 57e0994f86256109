// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Karypis, Kumar: A Fast and High Quality Multilevel Scheme for Partitioning Irregular Graphs (1998).
#include "base/run_scope.hpp"
#include "ordering/all_methods.hpp"
#include <meshorder/error.hpp>

#include <metis.h>

#include <array>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// A graph in METIS's own arrays, and options that make METIS reproducible.
struct MetisGraph {
  idx_t size = 0;
  std::vector<idx_t> offsets;
  std::vector<idx_t> neighbours;
  idx_t options[METIS_NOPTIONS] = {};

  /// Throws TooLarge for a graph with more entries than METIS's integers can count.
  MetisGraph(GraphRef graph, std::uint64_t seed);
};

MetisGraph::MetisGraph(GraphRef graph, std::uint64_t seed) : size(graph.size()) {
  if (graph.offsets.back() > std::numeric_limits<idx_t>::max()) {
    throw TooLarge("METIS here counts with " + std::to_string(8 * sizeof(idx_t)) + " bits; this graph has " +
                   std::to_string(graph.offsets.back()) + " entries");
  }
  offsets.assign(graph.offsets.begin(), graph.offsets.end());
  neighbours.assign(graph.neighbours.begin(), graph.neighbours.end());
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = static_cast<idx_t>(seed % 1000000007U);
  options[METIS_OPTION_NUMBERING] = 0;
}

/// Throws InternalError, naming the call, unless METIS reports success.
void check_metis(int status, const char* call) {
  if (status != METIS_OK) throw InternalError(std::string(call) + " failed with " + std::to_string(status));
}

constexpr Index kLeaf = 8;  // smaller leaves cost METIS more and no longer shorten spans

/// Returns the half, 0 or 1, of each vertex.
std::vector<idx_t> halves(GraphRef graph, std::uint64_t seed) {
  report("metis");
  MetisGraph metis(graph, seed);
  idx_t constraints = 1;
  idx_t parts = 2;
  idx_t cut = 0;
  std::vector<idx_t> half_of(graph.size());
  check_metis(METIS_PartGraphRecursive(&metis.size, &constraints, metis.offsets.data(),
                                       metis.neighbours.data(), nullptr, nullptr, nullptr, &parts, nullptr,
                                       nullptr, metis.options, &cut, half_of.data()),
              "METIS_PartGraphRecursive");
  return half_of;
}

/// Appends `vertices`, half after half. Vertex k of `graph` is `vertices[k]`.
void append_bisected(GraphRef graph, const std::vector<Index>& vertices, std::uint64_t seed,
                     std::vector<Index>& order) {
  std::array<std::vector<Index>, 2> sides;
  if (graph.size() > kLeaf && !graph.neighbours.empty()) {
    const std::vector<idx_t> half_of = halves(graph, seed);
    for (Index v = 0; v < graph.size(); ++v) sides[half_of[v]].push_back(v);
  }
  if (sides[0].empty() || sides[1].empty()) {
    order.insert(order.end(), vertices.begin(), vertices.end());
    return;
  }
  for (const std::vector<Index>& side : sides) {
    std::vector<Index> names;
    names.reserve(side.size());
    for (const Index v : side) names.push_back(vertices[v]);
    append_bisected(induced_subgraph(graph, side), names, seed, order);
  }
}

}  // namespace

Order metis_nd_vertices(const VertexInput& input, const OrderOptions& options) {
  if (input.graph.neighbours.empty()) return {Permutation::identity(input.graph.size()), {}};
  report("metis");
  MetisGraph graph(input.graph, options.seed);
  std::vector<idx_t> new_to_old(input.graph.size());
  std::vector<idx_t> old_to_new(input.graph.size());
  check_metis(METIS_NodeND(&graph.size, graph.offsets.data(), graph.neighbours.data(), nullptr, graph.options,
                           new_to_old.data(), old_to_new.data()),
              "METIS_NodeND");
  return {Permutation::from_new_to_old({new_to_old.begin(), new_to_old.end()}), {}};
}

// One half of the mesh comes before the other, and so on within each half. METIS's own recursion into many
// parts prints to stdout and fails if a part becomes empty, so each call requests only one bisection.
Order metis_rb_vertices(const VertexInput& input, const OrderOptions& options) {
  std::vector<Index> all(input.graph.size());
  std::iota(all.begin(), all.end(), Index{0});
  std::vector<Index> new_to_old;
  new_to_old.reserve(all.size());
  append_bisected(input.graph, all, options.seed, new_to_old);
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace meshorder
