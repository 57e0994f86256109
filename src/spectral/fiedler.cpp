// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/fiedler.hpp"

#include "base/run_scope.hpp"
#include "spectral/component_numbering.hpp"
#include "spectral/hierarchy.hpp"
#include "spectral/lobpcg.hpp"
#include "spectral/lowest.hpp"
#include "spectral/nested_start.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// Returns the caller's start vector on a component; empty if there is none or it is constant there.
VectorBlock<1> given_start(RealView start, std::span<const Index> vertices) {
  VectorBlock<1> x;
  if (start.empty()) return x;
  x.resize(vertices.size());
  bool constant = true;
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k][0] = start[static_cast<std::size_t>(vertices[k])];
    constant = constant && x[k][0] == x[0][0];
  }
  if (constant) x.clear();
  return x;
}

/// Computes the Fiedler vector of a component from its Laplacian, and writes it to the entries `vertices` of
/// `values`.
FiedlerComponent solve_component(Laplacian laplacian, std::span<const Index> vertices,
                                 const FiedlerOptions& options, TimeLimit limit,
                                 std::vector<double>& values) {
  const Hierarchy hierarchy(std::move(laplacian));
  VectorBlock<1> x;
  LobpcgResult solved;
  if (hierarchy.levels().size() == 1 && hierarchy.has_exact_coarsest()) {
    x = hierarchy.coarsest_eigenvectors<1>();
    solved = lobpcg<1>(hierarchy, 0, {options.tolerance, 0, limit}, x);
  } else {
    VectorBlock<1> companion;
    x = given_start(options.start, vertices);
    {
      const StartBlock start = nested_start(hierarchy, options.seed, limit);
      companion = column(start, x.empty() ? 1 : 0);
      if (x.empty()) x = column(start, 0);
    }
    LevelProblem problem(hierarchy, 0);
    solved = lowest_eigenvector(problem, {options.tolerance, options.max_iterations, limit}, options.seed, x,
                                std::move(companion));
  }
  for (std::size_t k = 0; k < x.size(); ++k) values[vertices[k]] = x[k][0];
  return {index_size(x), solved.eigenvalue, solved.residual, solved.iterations, solved.converged};
}

/// Scales the vector of a component to norm 1, with the sign that FiedlerVectors promises. `vertices` are the
/// vertices of the component, ascending.
void normalise(std::vector<double>& values, const std::vector<Index>& vertices) {
  double norm_squared = 0;
  double largest = 0;
  for (const Index v : vertices) {
    norm_squared += values[v] * values[v];
    largest = std::max(largest, std::abs(values[v]));
  }
  if (!(norm_squared > 0) || !std::isfinite(norm_squared)) {  // no vector was found; NaN cannot be sorted
    for (const Index v : vertices) values[v] = 0;
    return;
  }
  const auto first = std::find_if(vertices.begin(), vertices.end(),
                                  [&](Index v) { return std::abs(values[v]) >= 0.5 * largest; });
  const double sign = values[*first] > 0 ? -1 : 1;
  const double scale = sign / std::sqrt(norm_squared);
  for (const Index v : vertices) values[v] *= scale;
}

/// Returns the components, largest first, ties in the order of their numbers.
std::vector<Index> largest_first(const ComponentNumbering& numbering) {
  std::vector<Index> result(numbering.component_count());
  std::iota(result.begin(), result.end(), Index{0});
  std::stable_sort(result.begin(), result.end(), [&](Index a, Index b) {
    return numbering.component(a).size() > numbering.component(b).size();
  });
  return result;
}

/// Returns the vertices of each of these components, ascending.
std::vector<std::vector<Index>> ascending_vertices(const ComponentNumbering& numbering,
                                                   const std::vector<Index>& components) {
  std::vector<std::vector<Index>> result(components.size());
  std::vector<Index> rank_of(numbering.order.size());  // the rank of each vertex's component
  for (std::size_t rank = 0; rank < components.size(); ++rank) {
    const auto vertices = numbering.component(components[rank]);
    result[rank].reserve(vertices.size());
    for (const Index v : vertices) rank_of[v] = static_cast<Index>(rank);
  }
  for (Index v = 0; v < index_size(rank_of); ++v) result[rank_of[v]].push_back(v);
  return result;
}

void check_input(GraphRef graph, std::span<const double> weights, RealView start) {
  if (!weights.empty() && weights.size() != graph.neighbours.size()) {
    throw InvalidArgument("fiedler_vector: " + std::to_string(weights.size()) + " weights for " +
                          std::to_string(graph.neighbours.size()) + " neighbours");
  }
  const auto bad =
      std::find_if(weights.begin(), weights.end(), [](double w) { return !(w > 0 && std::isfinite(w)); });
  if (bad != weights.end()) {
    throw InvalidArgument("fiedler_vector: weight " + std::to_string(bad - weights.begin()) + " is " +
                          std::to_string(*bad) + "; weights must be positive and finite");
  }
  if (!weights.empty()) {
    constexpr double kLargestRatio = 1e100;
    const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
    if (*most * (1 / kLargestRatio) > *least) {
      throw InvalidArgument(
          "fiedler_vector: the largest weight is more than 1e100 times the smallest one; double precision "
          "cannot distinguish such weights from 0");
    }
  }
  if (!start.empty() && std::cmp_not_equal(start.size(), graph.size())) {
    throw InvalidArgument("fiedler_vector: a start vector of " + std::to_string(start.size()) +
                          " entries for " + std::to_string(graph.size()) + " vertices");
  }
  for (std::size_t v = 0; v < start.size(); ++v) {
    if (!std::isfinite(start[v])) {
      throw InvalidArgument("fiedler_vector: entry " + std::to_string(v) +
                            " of the start vector is not finite");
    }
  }
}

/// Returns the exponent of the power of two by which weights are multiplied, so that no sum or square of
/// weights leaves the range of doubles; 0 if the largest weight is far from the ends of that range.
int exponent_of_scale(std::span<const double> weights) {
  constexpr int kOrdinary = 300;
  if (weights.empty()) return 0;
  const int exponent = std::ilogb(*std::max_element(weights.begin(), weights.end()));
  return std::abs(exponent) <= kOrdinary ? 0 : -exponent;
}

/// Returns the weights times a power of two; weights that would be too small become the smallest normal
/// number.
std::vector<double> scaled(std::span<const double> weights, int exponent) {
  std::vector<double> result(weights.size());
  std::transform(weights.begin(), weights.end(), result.begin(), [&](double weight) {
    return std::max(std::ldexp(weight, exponent), std::numeric_limits<double>::min());
  });
  return result;
}

/// Converts a result for scaled weights to the result for the given weights; if this overflows, returns the
/// largest double.
double scaled_back(double figure, int exponent) {
  return std::min(std::ldexp(figure, -exponent), std::numeric_limits<double>::max());
}

}  // namespace

FiedlerOptions solver_options(const OrderOptions& options) {
  if (!(options.tolerance > 0) || !std::isfinite(options.tolerance)) {
    throw InvalidArgument("options: the tolerance must be positive and finite");
  }
  if (options.max_iterations < 1) throw InvalidArgument("options: max_iterations must be at least 1");
  return {.tolerance = options.tolerance,
          .max_iterations = options.max_iterations,
          .seed = options.seed,
          .start = options.start};
}

FiedlerVectors fiedler_vectors(GraphRef graph, std::span<const double> weights,
                               const FiedlerOptions& options) {
  check_input(graph, weights, options.start);
  if (const int exponent = exponent_of_scale(weights); exponent != 0) {
    FiedlerVectors result = fiedler_vectors(graph, scaled(weights, exponent), options);
    for (FiedlerComponent& component : result.components) {
      component.lambda2 = scaled_back(component.lambda2, exponent);
      component.residual = scaled_back(component.residual, exponent);
    }
    return result;
  }
  report("coarsen");
  const TimeLimit limit;
  const ComponentNumbering numbering = number_components(graph);
  const std::vector<Index> components = largest_first(numbering);
  FiedlerVectors result;
  result.values.assign(graph.size(), 0);
  result.component_vertices = ascending_vertices(numbering, components);
  result.components.resize(components.size());
  for_each_chunk(index_size(components), 1, [&](Index rank, Index, Index) {
    const auto vertices = numbering.component(components[rank]);
    if (vertices.size() == 1) {
      result.components[rank] = {1, 0, 0, 0, true};
      return;
    }
    result.components[rank] =
        solve_component(component_laplacian(graph, weights, numbering, components[rank]), vertices, options,
                        limit, result.values);
    normalise(result.values, result.component_vertices[rank]);
  });
  const bool converged = std::all_of(result.components.begin(), result.components.end(),
                                     [](const FiedlerComponent& component) { return component.converged; });
  result.complete = converged || !limit.is_over();
  return result;
}

}  // namespace meshorder
