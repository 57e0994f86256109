// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/grouped.hpp"

#include "base/point.hpp"
#include "ordering/method.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// The vertices sorted by group; within a group in their old order.
struct Sorted {
  std::vector<Index> vertices;
  std::vector<Index> starts;  ///< groups + 1
  std::vector<Index> places;  ///< the place of each vertex in `vertices`
};

Sorted sorted_into_groups(std::span<const Index> group_of, Index groups) {
  Sorted sorted;
  sorted.starts.assign(static_cast<std::size_t>(groups) + 1, 0);
  for (const Index group : group_of) ++sorted.starts[group + 1];
  std::partial_sum(sorted.starts.begin(), sorted.starts.end(), sorted.starts.begin());
  std::vector<Index> next(sorted.starts.begin(), sorted.starts.end() - 1);
  sorted.vertices.resize(group_of.size());
  sorted.places.resize(group_of.size());
  for (Index v = 0; v < index_size(group_of); ++v) {
    const Index place = next[group_of[v]]++;
    sorted.places[v] = place;
    sorted.vertices[place] = v;
  }
  return sorted;
}

/// The part of the input that belongs to one group.
struct GroupInput {
  CsrGraph graph;
  std::vector<double> weights;
  std::vector<Point> points;
  std::vector<double> start;  ///< for the eigensolver
};

/// Returns the subgraph of a group's vertices, with their weights, points and start. Unlike that of
/// induced_subgraph, the cost depends only on the size of the group: there may be as many groups as vertices.
GroupInput input_of_group(const VertexInput& input, RealView start, const Sorted& sorted, Index group) {
  const Index begin = sorted.starts[group];
  const Index end = sorted.starts[group + 1];
  GroupInput result;
  CsrGraph& graph = result.graph;
  for (Index place = begin; place < end; ++place) {
    const Index v = sorted.vertices[place];
    for (Offset k = input.graph.offsets[v]; k < input.graph.offsets[v + 1]; ++k) {
      const Index there = sorted.places[input.graph.neighbours[k]];
      if (there < begin || there >= end) continue;
      graph.neighbours.push_back(there - begin);
      if (!input.weights.empty()) result.weights.push_back(input.weights[k]);
    }
    graph.offsets.push_back(static_cast<Offset>(graph.neighbours.size()));
    if (!input.points.empty()) result.points.push_back(point_at(input.points, v));
    if (!start.empty()) result.start.push_back(start[static_cast<std::size_t>(v)]);
  }
  return result;
}

void check_groups(GraphRef graph, std::span<const Index> group_of, Index groups) {
  const bool known =
      std::all_of(group_of.begin(), group_of.end(), [&](Index g) { return g >= 0 && g < groups; });
  if (index_size(group_of) != graph.size() || !known) {
    throw InvalidArgument("groups: " + std::to_string(graph.size()) + " vertices need a group of 0 … " +
                          std::to_string(groups - 1) + " each");
  }
}

void check_start(RealView start, Index vertices) {
  if (!start.empty() && std::cmp_not_equal(start.size(), vertices)) {
    throw InvalidArgument("options: a start vector of " + std::to_string(start.size()) + " entries for " +
                          std::to_string(vertices) + " vertices");
  }
}

}  // namespace

std::vector<Index> dense_groups(const IndexView& groups, Index size, const char* what, Index& count) {
  if (std::cmp_not_equal(groups.size(), size)) {
    throw InvalidArgument("groups: " + std::to_string(groups.size()) + " numbers for " +
                          std::to_string(size) + " " + what);
  }
  std::vector<std::int64_t> values(groups.size());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = groups[k];
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  count = index_size(values);
  std::vector<Index> result(groups.size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] =
        static_cast<Index>(std::lower_bound(values.begin(), values.end(), groups[k]) - values.begin());
  }
  return result;
}

Order order_graph_in_groups(std::string_view method, const VertexInput& input,
                            std::span<const Index> group_of, Index groups, const OrderOptions& options) {
  check_groups(input.graph, group_of, groups);
  check_start(options.start, input.graph.size());
  Order result;
  result.method = method == "auto" ? choose_vertex_method(input, options.workload)
                                   : MethodChoice{std::string(method), ""};
  const Sorted sorted = sorted_into_groups(group_of, groups);
  std::vector<Index> new_to_old;
  new_to_old.reserve(sorted.vertices.size());
  OrderOptions of_group = options;
  for (Index group = 0; group < groups; ++group) {
    const std::span<const Index> members(sorted.vertices.data() + sorted.starts[group],
                                         sorted.vertices.data() + sorted.starts[group + 1]);
    const GroupInput part = input_of_group(input, options.start, sorted, group);
    of_group.start = part.start;
    const Order ordering =
        order_graph(result.method.name, {part.graph, PointsView(part.points), part.weights}, of_group);
    for (const Index k : ordering.permutation.new_to_old()) new_to_old.push_back(members[k]);
    result.fiedler.insert(result.fiedler.end(), ordering.fiedler.begin(), ordering.fiedler.end());
    if (!ordering.vector.empty()) {
      result.vector.resize(sorted.vertices.size());
      for (std::size_t k = 0; k < members.size(); ++k) result.vector[members[k]] = ordering.vector[k];
    }
    result.complete = result.complete && ordering.complete;
  }
  result.permutation = Permutation::from_new_to_old(std::move(new_to_old));
  return result;
}

Order order_vertices_by_options(std::string_view method, const VertexInput& input,
                                const OrderOptions& options) {
  if (options.groups.empty()) return order_graph(method, input, options);
  Index count = 0;
  const std::vector<Index> group_of = dense_groups(options.groups, input.graph.size(), "vertices", count);
  OrderOptions of_group = options;
  of_group.groups = {};
  return order_graph_in_groups(method, input, group_of, count, of_group);
}

}  // namespace meshorder
