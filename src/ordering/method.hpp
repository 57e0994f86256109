// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include <meshorder/order.hpp>
#include <meshorder/registry.hpp>

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace meshorder {

/// Input of a vertex method inside the library: a clean graph.
struct VertexInput {
  GraphRef graph;
  PointsView points = {};                ///< one for each vertex, or none
  std::span<const double> weights = {};  ///< one for each neighbour, or none
  /// If the graph is a part of a larger one: for each vertex, the number of its neighbours in earlier parts
  /// minus the number in later parts. Otherwise empty. Only `spectral` uses the pull: to choose the direction
  /// of its cuts.
  std::span<const float> pull = {};
};

/// Input of an element method inside the library.
struct ElementInput {
  IncidenceRef elements;                  ///< every element has a vertex
  const Permutation& vertices;            ///< the order of the vertices, which most element orders follow
  PointsView points;                      ///< points of the vertices in their old order, or none
  std::function<CsrGraph()> facet_graph;  ///< joins elements that share a facet
};

/// Orders vertices by the method of that name, built in or registered. Built-in methods other than `original`
/// (also as the choice of `auto`) put vertices without neighbours last, in their old order. Calls `poll`.
///
/// @throws InvalidArgument for an unknown name (the message lists the known ones), for a geometric method
///         without coordinates of all vertices, and for a registered method that returns an order of
///         another size
/// @throws Unavailable for a method that this build lacks
Order order_graph(std::string_view method, const VertexInput& input, const OrderOptions& options = {});

/// Orders elements by the method of that name; throws as `order_graph`.
Order order_incidence(std::string_view method, const ElementInput& input, const OrderOptions& options = {});

/// Returns whether the reverse of the method's orders is as good; false for registered methods.
bool is_reversible(std::string_view method);

/// Returns the workload by which to judge a vertex method that was requested by name.
Workload made_for(std::string_view method);

/// Returns the vertex method that measurements favour for this graph and workload: never `auto` itself, and a
/// method that needs coordinates only if coordinates distinguish the vertices. docs/auto.md has the evidence.
/// O(n).
MethodChoice choose_vertex_method(const VertexInput& input, Workload workload);

/// Returns the element method that measurements favour for that workload. O(1).
MethodChoice choose_element_method(const ElementInput& input, Workload workload);

/// Returns the registered method of that name; an empty function if there is none. Thread-safe.
VertexMethod registered_vertex_method(std::string_view name);
ElementMethod registered_element_method(std::string_view name);

/// Returns the method of that name in a list, which is `vertex_methods()` or `element_methods()`; nothing if
/// there is none.
inline std::optional<MethodInfo> method_named(const std::vector<MethodInfo>& methods, std::string_view name) {
  const auto found =
      std::ranges::find_if(methods, [&](const MethodInfo& method) { return method.name == name; });
  return found == methods.end() ? std::nullopt : std::optional(*found);
}

/// Returns whether the method of that name in the list needs coordinates.
inline bool needs_points(const std::vector<MethodInfo>& methods, std::string_view name) {
  const std::optional<MethodInfo> method = method_named(methods, name);
  return method && method->needs_points;
}

}  // namespace meshorder
