// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/auto.hpp"

#include "ordering/all_methods.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// When a method is taken: the first rule that fits decides.
struct Rule {
  std::optional<Workload> use = {};  ///< none: any
  Index least_vertices = 0;          ///< from so many on
  bool geometric = false;            ///< only where there are coordinates
  std::string_view method;
  std::string_view reason;
};

// Evidence: `meshorder compare` on one thread of a 2-core Zen 5 machine (48 KB L1, 1 MB L2, 32 MB L3); the
// tables stand in docs/auto.md.
constexpr std::array kVertexRules{
    Rule{.use = Workload::springs,
         .least_vertices = 1'000'000,
         .method = "rcm",
         .reason = "springs of a mesh this large run fastest on the few forward streams of its levels"},
    Rule{.geometric = true,
         .method = "hilbert",
         .reason =
             "within a few per cent of the best order measured, at the cost of one sort of the coordinates"},
    Rule{.method = "spectral",
         .reason = "the best order measured that needs no coordinates, of which there are none"},
};

bool fits(const Rule& rule, Index vertices, bool coordinates, Workload use) {
  return (!rule.use || *rule.use == use) && vertices >= rule.least_vertices &&
         (coordinates || !rule.geometric);
}

/// Whether coordinates are given and tell any two vertices apart.
bool has_coordinates(const VertexProblem& problem) {
  return index_size(problem.points) == problem.graph.size() &&
         std::any_of(problem.points.begin(), problem.points.end(),
                     [&](const Point& point) { return point != problem.points.front(); });
}

}  // namespace

MethodChoice choose_vertex_method(const VertexProblem& problem, Workload use) {
  const bool coordinates = has_coordinates(problem);
  const auto rule = std::find_if(kVertexRules.begin(), kVertexRules.end(), [&](const Rule& r) {
    return fits(r, problem.graph.size(), coordinates, use);
  });
  return {std::string(rule->method), std::string(rule->reason)};
}

MethodChoice choose_element_method(const ElementProblem& /*problem*/, Workload /*use*/) {
  return {"lexmax",
          "one sort by the new numbers of their vertices, and no order measured computes faster on it"};
}

Ordering auto_vertices(const VertexProblem& problem, const OrderingOptions& options) {
  MethodChoice choice = choose_vertex_method(problem, options.use);
  Ordering result = order_vertices(choice.name, problem, options);
  result.method = std::move(choice);
  return result;
}

Ordering auto_elements(const ElementProblem& problem, const OrderingOptions& options) {
  MethodChoice choice = choose_element_method(problem, options.use);
  Ordering result = order_elements(choice.name, problem, options);
  result.method = std::move(choice);
  return result;
}

}  // namespace meshorder
