// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/point.hpp"
#include "base/text.hpp"
#include "metrics/edge_span.hpp"
#include "metrics/measures.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/judgement.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

template <>
struct EnumNames<Workload> {
  static constexpr std::string_view kind = "workload";
  static constexpr std::array names{
      std::pair{Workload::all, "all"},         std::pair{Workload::element, "element"},
      std::pair{Workload::spmv, "spmv"},       std::pair{Workload::assembly, "assembly"},
      std::pair{Workload::springs, "springs"}, std::pair{Workload::bandwidth, "bandwidth"},
      std::pair{Workload::fill, "fill"},       std::pair{Workload::gpu, "gpu"},
  };
};

inline namespace v0_3 {

std::string_view to_string(Workload workload) { return to_string<Workload>(workload); }
Workload parse_workload(std::string_view name) { return parse<Workload>(name); }

}  // namespace v0_3

namespace {

/// The kind of a graph. lattice: a lattice, cut into cells of any shape. placed: another graph, with
/// coordinates that are not all equal. bare: any other graph.
enum class Kind : std::uint8_t { lattice, placed, bare };

/// A method and the condition under which it is chosen; the first rule that fits decides.
struct Rule {
  std::span<const Workload> workloads = {};  ///< empty: any
  Index least_vertices = 0;                  ///< smallest number of vertices
  std::optional<Kind> kind = {};             ///< none: any
  std::string_view method;
  std::string_view reason;
};

constexpr std::array kForBandwidth{Workload::bandwidth};
#ifdef MESHORDER_HAS_METIS
constexpr std::array kForFill{Workload::fill};
#endif
constexpr std::array kForGpu{Workload::gpu};
constexpr std::array kForElements{Workload::element, Workload::assembly};

// Evidence: plain kernels, as users write them, on one thread of 2-core Zen 4 and Zen 3 machines, and kernels
// in CUDA on an H100; the tables are in docs/auto.md and docs/gpu.md.
constexpr std::array kVertexRules{
    Rule{.workloads = kForBandwidth,
         .method = "rcm",
         .reason = "reverse Cuthill-McKee is made to keep the bandwidth small"},
#ifdef MESHORDER_HAS_METIS
    Rule{.workloads = kForFill,
         .method = "metis-nd",
         .reason = "nested dissection is made to keep the factors of a direct solver sparse"},
#endif
    Rule{.workloads = kForGpu,
         .method = "rcm",
         .reason = "about as fast as the best orders measured on a graphics processor, and cheap"},
    Rule{.kind = Kind::lattice,
         .method = "bfs",
         .reason = "no order measured is faster on lattices, and it is cheap"},
    Rule{.kind = Kind::placed,
         .method = "hilbert-fronts",
         .reason =
             "within a few per cent of the best order measured, for one sort of the coordinates and one pass "
             "over the edges"},
    Rule{
        .workloads = kForElements,
        .least_vertices = 100'000,
        .method = "spectral-fronts",
        .reason = "this graph has no coordinates, and no order measured without them is better for elements"},
    Rule{.method = "bfs",
         .reason =
             "this graph has no coordinates, no order measured without them makes products faster, and it is "
             "cheap"},
};

bool fits(const Rule& rule, Index vertices, Kind kind, Workload workload) {
  const std::span<const Workload> workloads = rule.workloads;
  return (workloads.empty() || std::ranges::find(workloads, workload) != workloads.end()) &&
         vertices >= rule.least_vertices && (!rule.kind || *rule.kind == kind);
}

/// Returns whether most vertices have the same number of neighbours, as inside a lattice: 14 if the lattice's
/// cubes are cut into tetrahedra, 26 if the cubes are the cells. The most frequent number occurs at no more
/// than a sixth of the vertices in meshes by TetGen, and at half in good triangulations of surfaces. O(n).
bool is_lattice(const GraphRef& graph) {
  constexpr double kMost = 0.6;
  std::vector<Index> with_degree;
  Index most = 0;
  Index used = 0;
  for (Index v = 0; v < graph.size(); ++v) {
    if (graph.degree(v) == 0) continue;
    ++used;
    const auto degree = static_cast<std::size_t>(graph.degree(v));
    if (degree >= with_degree.size()) with_degree.resize(degree + 1);
    most = std::max(most, ++with_degree[degree]);
  }
  return used > 0 && most > kMost * used;
}

bool has_places(const PointsView& points, Index count) {
  if (std::cmp_not_equal(points.size(), count) || count == 0) return false;
  const Point first = point_at(points, 0);
  for (Index v = 1; v < count; ++v) {
    if (point_at(points, v) != first) return true;
  }
  return false;
}

Kind kind_of(const VertexInput& input) {
  if (is_lattice(input.graph)) return Kind::lattice;
  return has_places(input.points, input.graph.size()) ? Kind::placed : Kind::bare;
}

/// Returns whether the graph is a lattice whose vertices are numbered about as well as by `order`: a sweep
/// reads few lines out of order, and the mean span is at most 1.5 times that of `order`.
bool is_well_numbered_lattice(const VertexInput& input, const Permutation& order) {
  constexpr double kFew = 0.1;
  constexpr double kAlike = 1.5;
  if (!is_lattice(input.graph)) return false;
  return sampled_edge_span(input.graph, {}).mean <=
             kAlike * sampled_edge_span(input.graph, order.old_to_new()).mean &&
         sampled_jump_share(input.graph, Permutation::identity(input.graph.size())) < kFew;
}

}  // namespace

MethodChoice choose_vertex_method(const VertexInput& input, Workload workload) {
  const Kind kind = kind_of(input);
  const auto rule = std::find_if(kVertexRules.begin(), kVertexRules.end(),
                                 [&](const Rule& r) { return fits(r, input.graph.size(), kind, workload); });
  return {std::string(rule->method), std::string(rule->reason)};
}

MethodChoice choose_element_method(const ElementInput& /*input*/, Workload workload) {
  if (workload == Workload::gpu) {
    return {"lexmax",
            "one sort by the new numbers of the vertices; the threads of a warp then add to places near each "
            "other"};
  }
  return {
      "lexmax",
      "one sort by the new numbers of the vertices, and kernels run no faster in any other order measured"};
}

Order auto_vertices(const VertexInput& input, const OrderOptions& options) {
  MethodChoice choice = choose_vertex_method(input, options.workload);
  Order result = order_graph(choice.name, input, options);
  std::string reason = choice.name == "bfs" && is_well_numbered_lattice(input, result.permutation)
                           ? "bfs is no better: this is a lattice, and its lines are already read forward"
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
  const std::span<const Index> new_to_old = result.permutation.new_to_old();
  std::string reason = options.workload == Workload::gpu
                           ? reason_to_keep_on_gpu(input.elements, input.vertices, new_to_old, choice.name)
                           : reason_to_keep_elements(input.elements, {}, new_to_old, choice.name);
  if (!reason.empty()) {
    choice = {"original", std::move(reason)};
    result.permutation = Permutation::identity(input.elements.size());
  }
  result.method = std::move(choice);
  return result;
}

}  // namespace meshorder
