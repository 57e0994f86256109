// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/fiedler.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "spectral/component_numbering.hpp"
#include "spectral/hierarchy.hpp"
#include "spectral/lobpcg.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace meshorder {
namespace {

// Two columns keep λ₂ and λ₃ apart where they are close.
constexpr int kColumns = 2;
// The start on the next finer graph is no better than prolongation makes it.
constexpr double kCoarseTolerance = 1;
constexpr int kCoarseIterations = 30;

using Block = VectorBlock<kColumns>;

void fill_with_noise(Block& x, int first_column, std::uint64_t seed) {
  Random random(seed);
  for (auto& row : x) {
    for (int m = first_column; m < kColumns; ++m) row[m] = random.unit() - 0.5;
  }
}

/// The start vectors on the finest graph: exact on the coarsest, improved on every graph between.
Block nested_start(const Hierarchy& hierarchy, std::uint64_t seed) {
  const auto& levels = hierarchy.levels();
  int level = static_cast<int>(levels.size()) - 1;
  Block x;
  int known = 0;  // columns
  if (hierarchy.has_exact_coarsest()) {
    x = hierarchy.coarsest_eigenvectors<kColumns>();
    known = std::min(kColumns, static_cast<int>(x.size()) - 1);
    --level;
  } else {
    level = 0;
  }
  for (; level >= 0; --level) {
    Block finer(levels[level].laplacian.size(), std::array<double, kColumns>{});
    if (known > 0) hierarchy.add_prolonged<kColumns>(level, 1, x, finer);
    x = std::move(finer);
    if (known == kColumns) {
      hierarchy.smooth<kColumns>(level, x);
    } else {
      fill_with_noise(x, known, seed);
      known = kColumns;
    }
    if (level > 0) lobpcg<kColumns>(hierarchy, level, {kCoarseTolerance, kCoarseIterations}, x);
  }
  return x;
}

VectorBlock<1> column(const Block& x, int m) {
  VectorBlock<1> result(x.size());
  for (std::size_t v = 0; v < x.size(); ++v) result[v][0] = x[v][m];
  return result;
}

/// The Fiedler vector of a component with that Laplacian into the entries `vertices` of `values`.
FiedlerComponent solve_component(Laplacian laplacian, std::span<const Index> vertices,
                                 const FiedlerOptions& options, std::vector<double>& values) {
  const Hierarchy hierarchy(std::move(laplacian));
  VectorBlock<1> x;
  LobpcgResult solved;
  if (hierarchy.levels().size() == 1 && hierarchy.has_exact_coarsest()) {
    x = hierarchy.coarsest_eigenvectors<1>();
    solved = lobpcg<1>(hierarchy, 0, {options.tolerance, 0}, x);
  } else {
    VectorBlock<1> companion;
    {
      const Block start = nested_start(hierarchy, options.seed);
      x = column(start, 0);
      companion = column(start, 1);
    }
    solved = lobpcg<1, 1>(hierarchy, 0, {options.tolerance, options.max_iterations}, x, std::move(companion));
  }
  for (std::size_t k = 0; k < x.size(); ++k) values[vertices[k]] = x[k][0];
  return {index_size(x), solved.eigenvalue, solved.residual, solved.iterations, solved.converged};
}

/// Norm 1, sum 0, and the sign that FiedlerResult promises. `vertices` are the component's, rising.
void normalise(std::vector<double>& values, const std::vector<Index>& vertices) {
  double norm_squared = 0;
  double largest = 0;
  for (const Index v : vertices) {
    norm_squared += values[v] * values[v];
    largest = std::max(largest, std::abs(values[v]));
  }
  if (!(largest > 0)) {  // no vector was found; sorting needs numbers
    for (const Index v : vertices) values[v] = 0;
    return;
  }
  const auto first = std::find_if(vertices.begin(), vertices.end(),
                                  [&](Index v) { return std::abs(values[v]) >= 0.5 * largest; });
  const double sign = values[*first] > 0 ? -1 : 1;
  const double scale = sign / std::sqrt(norm_squared);
  for (const Index v : vertices) values[v] *= scale;
}

/// The components by falling size, ties in the order in which they are numbered.
std::vector<Index> largest_first(const ComponentNumbering& numbering) {
  std::vector<Index> result(numbering.component_count());
  std::iota(result.begin(), result.end(), Index{0});
  std::stable_sort(result.begin(), result.end(), [&](Index a, Index b) {
    return numbering.component(a).size() > numbering.component(b).size();
  });
  return result;
}

/// The vertices of each of those components, rising.
std::vector<std::vector<Index>> rising_vertices(const ComponentNumbering& numbering,
                                                const std::vector<Index>& components) {
  std::vector<std::vector<Index>> result(components.size());
  std::vector<Index> rank_of(numbering.order.size());  // of each vertex's component
  for (std::size_t rank = 0; rank < components.size(); ++rank) {
    const auto vertices = numbering.component(components[rank]);
    result[rank].reserve(vertices.size());
    for (const Index v : vertices) rank_of[v] = static_cast<Index>(rank);
  }
  for (Index v = 0; v < index_size(rank_of); ++v) result[rank_of[v]].push_back(v);
  return result;
}

void check_weights(GraphRef graph, std::span<const double> weights) {
  if (weights.size() != graph.neighbours.size()) {
    throw InvalidArgument("fiedler_vector: " + std::to_string(weights.size()) + " weights for " +
                          std::to_string(graph.neighbours.size()) + " neighbours");
  }
  const auto bad =
      std::find_if(weights.begin(), weights.end(), [](double w) { return !(w > 0 && std::isfinite(w)); });
  if (bad != weights.end()) {
    throw InvalidArgument("fiedler_vector: weight " + std::to_string(bad - weights.begin()) + " is " +
                          std::to_string(*bad) + "; weights must be positive");
  }
}

FiedlerResult solve(GraphRef graph, std::span<const double> weights, const FiedlerOptions& options) {
  const ComponentNumbering numbering = number_components(graph);
  const std::vector<Index> components = largest_first(numbering);
  FiedlerResult result;
  result.values.assign(graph.size(), 0);
  result.component_vertices = rising_vertices(numbering, components);
  result.components.resize(components.size());
  for_each_chunk(index_size(components), 1, [&](Index rank, Index, Index) {
    const auto vertices = numbering.component(components[rank]);
    if (vertices.size() == 1) {
      result.components[rank] = {1, 0, 0, 0, true};
      return;
    }
    result.components[rank] = solve_component(
        component_laplacian(graph, weights, numbering, components[rank]), vertices, options, result.values);
    normalise(result.values, result.component_vertices[rank]);
  });
  return result;
}

}  // namespace

FiedlerResult fiedler_vector(GraphRef graph, const FiedlerOptions& options) {
  return solve(graph, {}, options);
}

FiedlerResult fiedler_vector(GraphRef graph, std::span<const double> weights, const FiedlerOptions& options) {
  check_weights(graph, weights);
  return solve(graph, weights, options);
}

}  // namespace meshorder
