// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/point.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/judgement.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// When a method is taken: the first rule that fits decides.
struct Rule {
  std::optional<Workload> workload = {};  ///< none: any
  Index least_vertices = 0;               ///< from so many on
  bool geometric = false;                 ///< only where there are coordinates
  std::string_view method;
  std::string_view reason;
};

// Evidence: `meshorder compare` on one thread of a 2-core Zen 5 machine (48 KB L1, 1 MB L2, 32 MB L3); the
// tables stand in docs/auto.md.
constexpr std::array kVertexRules{
    Rule{.workload = Workload::bandwidth,
         .method = "rcm",
         .reason = "reverse Cuthill-McKee is made to keep the bandwidth small"},
#ifdef MESHORDER_HAS_METIS
    Rule{.workload = Workload::fill,
         .method = "metis-nd",
         .reason = "nested dissection is made to keep the factors of a direct solver sparse"},
#endif
    Rule{.workload = Workload::springs,
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

bool fits(const Rule& rule, Index vertices, bool coordinates, Workload workload) {
  return (!rule.workload || *rule.workload == workload) && vertices >= rule.least_vertices &&
         (coordinates || !rule.geometric);
}

/// Returns whether there are coordinates and at least two vertices differ in them.
bool has_coordinates(const VertexInput& input) {
  if (std::cmp_not_equal(input.points.size(), input.graph.size()) || input.graph.size() == 0) return false;
  const Point first = point_at(input.points, 0);
  for (Index v = 1; v < input.graph.size(); ++v) {
    if (point_at(input.points, v) != first) return true;
  }
  return false;
}

}  // namespace

MethodChoice choose_vertex_method(const VertexInput& input, Workload workload) {
  const bool coordinates = has_coordinates(input);
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
  if (std::string reason = reason_to_keep(input.graph, result.permutation, choice.name, options.workload);
      !reason.empty()) {
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
