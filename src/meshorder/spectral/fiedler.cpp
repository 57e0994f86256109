// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/random.hpp>
#include <meshorder/graph/breadth_first.hpp>
#include <meshorder/graph/components.hpp>
#include <meshorder/spectral/fiedler.hpp>
#include <meshorder/spectral/hierarchy.hpp>
#include <meshorder/spectral/lobpcg.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

// Two columns on all graphs but the finest keep λ₂ and λ₃ apart where they are close.
constexpr int kCoarseColumns = 2;
constexpr double kCoarseTolerance = 0.1;
constexpr int kCoarseIterations = 30;

/// The Laplacian of one component, its vertices numbered breadth first, and that numbering.
struct LocalLaplacian {
  Laplacian laplacian;
  std::vector<Index> vertices;  ///< in the graph's numbers
};

LocalLaplacian local_laplacian(const CsrGraph& graph, Index start, std::vector<Index>& marks, Index mark) {
  LocalLaplacian local;
  local.vertices = breadth_first(graph, start, marks, mark).order;
  const Index n = index_size(local.vertices);
  std::vector<Index>& number = marks;  // from here on the new number of each vertex of the component
  Offset entries = 0;
  for (Index k = 0; k < n; ++k) {
    number[local.vertices[k]] = k;
    entries += graph.degree(local.vertices[k]);
  }
  Laplacian& laplacian = local.laplacian;
  laplacian.offsets.reserve(Offset{n} + 1);
  laplacian.diagonal.reserve(n);
  laplacian.neighbours.reserve(entries);
  for (const Index v : local.vertices) {
    for (const Index u : graph[v]) laplacian.neighbours.push_back(number[u]);
    laplacian.offsets.push_back(static_cast<Offset>(laplacian.neighbours.size()));
    laplacian.diagonal.push_back(graph.degree(v));
  }
  return local;
}

template <int M>
void fill_with_noise(VectorBlock<M>& x, int first_column, std::uint64_t seed) {
  Random random(seed);
  for (auto& row : x) {
    for (int m = first_column; m < M; ++m) row[m] = random.unit() - 0.5;
  }
}

/// The start vector on the finest graph: exact on the coarsest, improved on every graph between.
VectorBlock<1> nested_start(const Hierarchy& hierarchy, std::uint64_t seed) {
  const auto& levels = hierarchy.levels();
  const int last = static_cast<int>(levels.size()) - 1;
  VectorBlock<1> start(levels.front().laplacian.size(), std::array<double, 1>{});
  if (last == 0 || !hierarchy.has_exact_coarsest()) {
    fill_with_noise<1>(start, 0, seed);
    return start;
  }
  VectorBlock<kCoarseColumns> x = hierarchy.coarsest_eigenvectors<kCoarseColumns>();
  const int known = std::min(kCoarseColumns, static_cast<int>(x.size()) - 1);
  for (int level = last - 1; level >= 1; --level) {
    VectorBlock<kCoarseColumns> finer(levels[level].laplacian.size(), std::array<double, kCoarseColumns>{});
    hierarchy.add_prolonged<kCoarseColumns>(level, x, finer);
    x = std::move(finer);
    if (level == last - 1 && known < kCoarseColumns) fill_with_noise<kCoarseColumns>(x, known, seed);
    lobpcg<kCoarseColumns>(hierarchy, level, {kCoarseTolerance, kCoarseIterations}, x);
  }
  if (last == 1 && known < 1) {
    fill_with_noise<1>(start, 0, seed);
    return start;
  }
  VectorBlock<1> first(x.size());
  for (std::size_t v = 0; v < x.size(); ++v) first[v][0] = x[v][0];
  hierarchy.add_prolonged<1>(0, first, start);
  return start;
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
  for (const Index v : vertices) values[v] *= sign / std::sqrt(norm_squared);
}

FiedlerComponent solve_component(LocalLaplacian local, const FiedlerOptions& options,
                                 std::vector<double>& values) {
  FiedlerComponent report;
  report.size = index_size(local.vertices);
  const Hierarchy hierarchy(std::move(local.laplacian));
  VectorBlock<1> x;
  int max_iterations = options.max_iterations;
  if (hierarchy.levels().size() == 1 && hierarchy.has_exact_coarsest()) {
    x = hierarchy.coarsest_eigenvectors<1>();
    max_iterations = 0;
  } else {
    x = nested_start(hierarchy, options.seed);
  }
  const LobpcgResult solved = lobpcg<1>(hierarchy, 0, {options.tolerance, max_iterations}, x);
  report.lambda2 = solved.eigenvalue;
  report.residual = solved.residual;
  report.iterations = solved.iterations;
  report.converged = solved.converged;
  for (Index k = 0; k < report.size; ++k) values[local.vertices[k]] = x[k][0];
  return report;
}

}  // namespace

FiedlerResult fiedler_vector(const CsrGraph& graph, const FiedlerOptions& options) {
  FiedlerResult result;
  result.values.assign(graph.size(), 0);
  result.component_vertices = connected_components(graph);
  std::vector<Index> marks(graph.size(), -1);
  for (const std::vector<Index>& vertices : result.component_vertices) {
    if (vertices.size() == 1) {
      result.components.push_back({1, 0, 0, 0, true});
      continue;
    }
    // marks below n are numbers of an earlier component, whose vertices no search meets again
    LocalLaplacian local = local_laplacian(graph, vertices.front(), marks, kMaxIndex);
    result.components.push_back(solve_component(std::move(local), options, result.values));
    normalise(result.values, vertices);
  }
  return result;
}

}  // namespace meshorder
