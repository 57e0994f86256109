// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/point.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/first_touches.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/judgement.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// What a graph's coordinates say.
enum class Coordinates : std::uint8_t { none, lattice, general };

/// When a method is taken: the first rule that fits decides.
struct Rule {
  std::vector<Workload> workloads = {};         ///< none: any
  Index least_vertices = 0;                     ///< from so many on
  std::optional<Coordinates> coordinates = {};  ///< none: any
  std::string_view method;
  std::string_view reason;
};

// Evidence: plain kernels, as users write them, on one thread of a 2-core Zen 4 machine (32 KB L1, 1 MB L2,
// 32 MB L3); the tables are in docs/auto.md.
const std::array kVertexRules{
    Rule{.workloads = {Workload::bandwidth},
         .method = "rcm",
         .reason = "reverse Cuthill-McKee is made to keep the bandwidth small"},
#ifdef MESHORDER_HAS_METIS
    Rule{.workloads = {Workload::fill},
         .method = "metis-nd",
         .reason = "nested dissection is made to keep the factors of a direct solver sparse"},
#endif
    Rule{.coordinates = Coordinates::lattice,
         .method = "bfs",
         .reason = "on lattices no order measured is faster, and it is cheap"},
    Rule{.coordinates = Coordinates::general,
         .method = "hilbert-fronts",
         .reason =
             "within a few per cent of the best order measured, at the cost of a sort of the coordinates "
             "and a pass over the edges"},
    Rule{.workloads = {Workload::element, Workload::assembly},
         .least_vertices = 100'000,
         .method = "spectral-fronts",
         .reason = "the best order measured for elements that needs no coordinates, of which there are none"},
    Rule{.method = "bfs",
         .reason =
             "no order measured makes products faster without coordinates, of which there are none, and "
             "it is cheap"},
};

bool fits(const Rule& rule, Index vertices, Coordinates coordinates, Workload workload) {
  const auto& workloads = rule.workloads;
  return (workloads.empty() || std::ranges::find(workloads, workload) != workloads.end()) &&
         vertices >= rule.least_vertices && (!rule.coordinates || *rule.coordinates == coordinates);
}

/// Returns whether the points lie on a lattice along the axes, most places of which are taken. Looks at some
/// 65,536 of them. O(log n) each.
bool is_lattice(const PointsView& points, Index count) {
  constexpr Index kLookedAt = 65'536;
  constexpr double kPlacesForEach = 4;
  std::array<std::set<double>, 3> values;
  const Index step = std::max(1, count / kLookedAt);
  for (Offset p = 0; p < count; p += step) {
    const Point point = point_at(points, static_cast<Index>(p));
    double places = 1;
    for (std::size_t axis = 0; axis < values.size(); ++axis) {
      values[axis].insert(point[axis]);
      places *= static_cast<double>(values[axis].size());
    }
    if (places > kPlacesForEach * count) return false;
  }
  return true;
}

Coordinates coordinates_of(const VertexInput& input) {
  const Index n = input.graph.size();
  if (std::cmp_not_equal(input.points.size(), n) || n == 0) return Coordinates::none;
  const Point first = point_at(input.points, 0);
  Index v = 1;
  while (v < n && point_at(input.points, v) == first) ++v;
  if (v == n) return Coordinates::none;
  return is_lattice(input.points, n) ? Coordinates::lattice : Coordinates::general;
}

/// Whether the points are on a lattice whose vertices are numbered about as well as by `order`: a sweep reads
/// few lines out of order, and spans are at most half as long again.
bool is_well_numbered_lattice(const VertexInput& input, const Permutation& order) {
  constexpr double kFew = 0.1;
  constexpr double kAlike = 1.5;
  if (coordinates_of(input) != Coordinates::lattice) return false;
  const Permutation as_is = Permutation::identity(input.graph.size());
  return static_cast<double>(span_size(input.graph, as_is).sum) <=
             kAlike * static_cast<double>(span_size(input.graph, order).sum) &&
         sampled_jump_share(input.graph, as_is) < kFew;
}

}  // namespace

MethodChoice choose_vertex_method(const VertexInput& input, Workload workload) {
  const Coordinates coordinates = coordinates_of(input);
  const auto rule = std::find_if(kVertexRules.begin(), kVertexRules.end(), [&](const Rule& r) {
    return fits(r, input.graph.size(), coordinates, workload);
  });
  return {std::string(rule->method), std::string(rule->reason)};
}

MethodChoice choose_element_method(const ElementInput& /*input*/, Workload /*workload*/) {
  return {"lexmax",
          "one sort by the new numbers of their vertices, and no order measured computes faster on it"};
}

Order auto_vertices(const VertexInput& input, const OrderOptions& options) {
  MethodChoice choice = choose_vertex_method(input, options.workload);
  Order result = order_graph(choice.name, input, options);
  std::string reason =
      choice.name == "bfs" && is_well_numbered_lattice(input, result.permutation)
          ? "bfs is no better: the points are on a lattice, whose lines a sweep already reads forward"
          : reason_to_keep(input.graph, result.permutation, choice.name, options.workload);
  if (!reason.empty()) {
    choice = {"original", std::move(reason)};
    result.permutation = Permutation::identity(input.graph.size());
  }
  result.method = std::move(choice);
  return result;
}

Order auto_elements(const ElementInput& input, const OrderOptions& options) {
  MethodChoice choice = choose_element_method(input, options.workload);
  Order result = order_incidence(choice.name, input, options);
  const Permutation as_is = Permutation::identity(input.elements.size());
  if (std::string reason = reason_to_keep_elements(input.elements, as_is.new_to_old(),
                                                   result.permutation.new_to_old(), choice.name);
      !reason.empty()) {
    choice = {"original", std::move(reason)};
    result.permutation = as_is;
  }
  result.method = std::move(choice);
  return result;
}

}  // namespace meshorder
