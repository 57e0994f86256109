// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Barnard, Pothen, Simon: A Spectral Algorithm for Envelope Reduction of Sparse Matrices (1993); the paper,
// sections 3 and 4.1.
#include "spectral/fiedler.hpp"

#include "base/run_scope.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {

/// Appends the vertices of a component sorted by their values, ties by number. `component` ascends.
void append_sorted(const std::vector<Index>& component, const std::vector<double>& values,
                   std::vector<Index>& new_to_old) {
  const Index n = index_size(component);
  if (n == 1) return new_to_old.push_back(component[0]);  // there may be millions of such components
  const auto value = [&](Index k) { return values[component[k]]; };
  double low = 0;  // values sum to 0, so 0 lies between low and high
  double high = 0;
  for (const Index v : component) {
    low = std::min(low, values[v]);
    high = std::max(high, values[v]);
  }
  const double places = high > low ? (n - 1) / (high - low) : 0;
  const auto place = [&](double x) { return std::min(static_cast<Index>((x - low) * places), n - 1); };
  for (const Index k : sorted_by(n, value, n, place).new_to_old()) new_to_old.push_back(component[k]);
}

/// Returns the order of the vertices: component after component, largest first; within a component by
/// ascending Fiedler value, ties by old number.
Order by_fiedler_vector(GraphRef graph, std::span<const double> weights, const OrderOptions& options) {
  FiedlerVectors fiedler = fiedler_vectors(graph, weights, solver_options(options));
  report("sort");
  std::vector<Index> new_to_old;
  new_to_old.reserve(graph.size());
  for (const std::vector<Index>& component : fiedler.component_vertices) {
    poll();
    append_sorted(component, fiedler.values, new_to_old);
  }
  return {.permutation = Permutation::from_new_to_old(std::move(new_to_old)),
          .fiedler = std::move(fiedler.components),
          .vector = std::move(fiedler.values),
          .complete = fiedler.complete};
}

/// Returns the options for the dual graph, without the start vector, which belongs to the vertices.
OrderOptions without_start(OrderOptions options) {
  options.start = {};
  return options;
}

}  // namespace

Order fiedler_vertices(const VertexInput& input, const OrderOptions& options) {
  return by_fiedler_vector(input.graph, input.weights, options);
}

Order fiedler_elements(const ElementInput& input, const OrderOptions& options) {
  return by_fiedler_vector(joined_by_vertex(input.elements), {}, without_start(options));
}

Order fiedler_facet_elements(const ElementInput& input, const OrderOptions& options) {
  return by_fiedler_vector(input.facet_graph(), {}, without_start(options));
}

}  // namespace meshorder
