// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include <meshorder/order.hpp>
#include <meshorder/registry.hpp>

#include <functional>
#include <span>
#include <string_view>

namespace meshorder {

/// Input of a vertex method inside the library: a clean graph.
struct VertexInput {
  GraphRef graph;
  PointsView points = {};                ///< one for each vertex, or none
  std::span<const double> weights = {};  ///< one for each neighbour, or none
  /// Where the graph is a part of a larger one: how many neighbours each vertex has in parts that come before
  /// this one, less those in parts that come after; or none. `spectral` turns its cuts by it, the other
  /// methods ignore it.
  std::span<const float> pull = {};
};

/// Input of an element method inside the library.
struct ElementInput {
  IncidenceRef elements;                  ///< every element has a vertex
  const Permutation& vertices;            ///< the order of the vertices, which most element orders follow
  PointsView points;                      ///< of the vertices in their old order, or none
  std::function<CsrGraph()> facet_graph;  ///< joins elements that share a facet
};

/// Orders vertices by the method of that name, built in or registered. Vertices without neighbours come last,
/// in their old order (but stay where they are under `original`). Polls the call's progress.
///
/// @throws InvalidArgument for an unknown name, which lists the known ones, and for a geometric method
/// without
///         coordinates
/// @throws Unavailable for a method that this build lacks
Order order_graph(std::string_view method, const VertexInput& input, const OrderOptions& options = {});

/// Orders the vertices group after group, each group by the method on the graph of its own vertices, so that
/// neighbours within a group stay neighbours in memory. `auto` chooses once, for the whole graph; reports of
/// eigensolvers follow each other as the groups do. O(n + edges) and what the method costs.
///
/// @param group_of  for each vertex the number of its group, 0 … groups − 1
/// @throws as `order_graph`, and InvalidArgument if `group_of` does not fit
Order order_graph_in_groups(std::string_view method, const VertexInput& input,
                            std::span<const Index> group_of, Index groups, const OrderOptions& options = {});

/// Orders vertices by the method and the groups of `options`, whose values may be any integers.
///
/// @throws as `order_graph`, and InvalidArgument for another number of groups
Order order_vertices_by_options(std::string_view method, const VertexInput& input,
                                const OrderOptions& options);

/// Orders elements by the method of that name; throws as `order_graph`.
Order order_incidence(std::string_view method, const ElementInput& input, const OrderOptions& options = {});

/// Returns the vertex method that measurements favour for that graph and workload: never `auto` itself, and
/// none that needs coordinates where there are none that tell vertices apart. The rules stand in auto.cpp
/// with their evidence. O(n).
MethodChoice choose_vertex_method(const VertexInput& input, Workload workload);

/// Returns the element method that measurements favour for that workload. O(1).
MethodChoice choose_element_method(const ElementInput& input, Workload workload);

/// Returns a registered method of that name, empty if there is none. Thread-safe.
VertexMethod registered_vertex_method(std::string_view name);
ElementMethod registered_element_method(std::string_view name);

}  // namespace meshorder
