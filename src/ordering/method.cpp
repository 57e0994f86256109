// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/method.hpp"

#include "base/run_scope.hpp"
#include "base/text.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/space_filling.hpp"
#include <meshorder/error.hpp>

#include <array>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// The properties of a method that other code needs.
struct Traits {
  bool needs_points = false;
  bool is_reversible = false;
  Workload made_for = Workload::all;
};
constexpr Traits kOfPoints{.needs_points = true};
constexpr Traits kReversible{.is_reversible = true};
constexpr Traits kAlongCurve{.needs_points = true, .is_reversible = true};

template <class Input>
struct BuiltInMethod {
  std::string_view name;
  std::string_view description;
  Order (*order)(const Input&, const OrderOptions&);
  Traits traits = {};
};
using BuiltInVertexMethod = BuiltInMethod<VertexInput>;
using BuiltInElementMethod = BuiltInMethod<ElementInput>;

/// Orders by a method, then renumbers the chunks of that order breadth first: see `in_fronts`.
template <Order (*Method)(const VertexInput&, const OrderOptions&)>
Order then_fronts(const VertexInput& input, const OrderOptions& options) {
  Order result = Method(input, options);
  result.permutation = in_fronts(input.graph, result.permutation);
  return result;
}

constexpr std::array kVertexMethods{
    BuiltInVertexMethod{"auto", "the one below that measurements favour for the mesh's size and use (--for)",
                        auto_vertices},
    BuiltInVertexMethod{"original", "the order of the file", original_vertices},
    BuiltInVertexMethod{"scrambled", "a seeded random order, the paper's point of reference",
                        scrambled_vertices},
    BuiltInVertexMethod{"fiedler", "sorted by the Fiedler vector of the vertex graph, the paper's order",
                        fiedler_vertices, kReversible},
    BuiltInVertexMethod{"minla", "the Fiedler order, improved towards the least sum of edge spans",
                        minla_vertices, kReversible},
    BuiltInVertexMethod{"spectral", "cut along Fiedler vectors again and again, down to a few vertices",
                        spectral_vertices},
    BuiltInVertexMethod{"rcm", "reverse Cuthill-McKee: breadth first, neighbours by degree, reversed",
                        rcm_vertices, Traits{.made_for = Workload::bandwidth}},
    BuiltInVertexMethod{"bfs", "breadth first from a vertex at the rim", bfs_vertices},
    BuiltInVertexMethod{"mdf", "from the rim, next the vertex that discards least fill: for IC(0) and ILU(0)",
                        mdf_vertices},
    BuiltInVertexMethod{"morton", "along Morton's Z curve through the coordinates", morton_vertices,
                        kAlongCurve},
    BuiltInVertexMethod{"hilbert", "along Hilbert's curve through the coordinates", hilbert_vertices,
                        kAlongCurve},
    BuiltInVertexMethod{"hilbert-fronts", "hilbert, then breadth first within each 2,048 vertices",
                        then_fronts<hilbert_vertices>, kOfPoints},
    BuiltInVertexMethod{"spectral-fronts", "spectral, then breadth first within each 2,048 vertices",
                        then_fronts<spectral_vertices>},
    BuiltInVertexMethod{"minla-fronts", "minla, then breadth first within each 2,048 vertices",
                        then_fronts<minla_vertices>},
    BuiltInVertexMethod{"fiedler-fronts", "fiedler, then breadth first within each 2,048 vertices",
                        then_fronts<fiedler_vertices>},
#ifdef MESHORDER_HAS_METIS
    BuiltInVertexMethod{"metis-nd", "METIS nested dissection, made for sparse factorisation",
                        metis_nd_vertices, Traits{.made_for = Workload::fill}},
    BuiltInVertexMethod{"metis-rb", "METIS recursive bisection down to a few vertices", metis_rb_vertices},
#endif
};

constexpr std::array kElementMethods{
    BuiltInElementMethod{"auto", "the one below that measurements favour: lexmax", auto_elements},
    BuiltInElementMethod{"original", "the order of the file", original_elements},
    BuiltInElementMethod{"scrambled", "a seeded random order, the paper's point of reference",
                         scrambled_elements},
    BuiltInElementMethod{
        "fiedler",
        "by the Fiedler vector of the graph that joins elements sharing a vertex, the paper's order",
        fiedler_elements},
    BuiltInElementMethod{"fiedler-facet",
                         "by the Fiedler vector of the graph that joins elements sharing a facet",
                         fiedler_facet_elements},
    BuiltInElementMethod{"mean", "by the mean rank of their vertices", mean_elements},
    BuiltInElementMethod{"min", "by the least rank of their vertices", min_elements},
    BuiltInElementMethod{"max", "by the largest rank of their vertices", max_elements},
    BuiltInElementMethod{"lexmax", "by the ranks of their vertices, largest first, compared like words",
                         lexmax_elements},
    BuiltInElementMethod{"hilbert", "along Hilbert's curve through their centroids", hilbert_elements,
                         kOfPoints},
};

/// Returns the built-in method of that name, or null.
template <class Methods>
const auto* find_method(const Methods& methods, std::string_view name) {
  const auto found =
      std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == name; });
  return found != methods.end() ? &*found : nullptr;
}

[[noreturn]] void refuse(std::string_view kind, std::string_view name, const std::vector<MethodInfo>& known) {
#ifndef MESHORDER_HAS_METIS
  if (name == "metis-nd" || name == "metis-rb") {
    throw Unavailable("the order '" + std::string(name) + "' needs a build with METIS (MESHORDER_METIS=ON)");
  }
#endif
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const MethodInfo& method : known) names.push_back(method.name);
  throw InvalidArgument(unknown_in_words(std::string(kind) + " order", std::string(name), names));
}

template <class Method>
MethodInfo info_of(const Method& method) {
  return {.name = std::string(method.name),
          .description = std::string(method.description),
          .needs_points = method.traits.needs_points};
}

/// Moves vertices without neighbours after the others, in their old order.
Permutation with_isolated_last(Permutation order, GraphRef graph) {
  const auto is_isolated = [&](Index v) { return graph.degree(v) == 0; };
  if (std::adjacent_find(graph.offsets.begin(), graph.offsets.end()) == graph.offsets.end()) return order;
  std::vector<Index> new_to_old(order.new_to_old().begin(), order.new_to_old().end());
  const auto isolated = std::stable_partition(new_to_old.begin(), new_to_old.end(), std::not_fn(is_isolated));
  std::sort(isolated, new_to_old.end());
  return Permutation::from_new_to_old(std::move(new_to_old));
}

/// Checks the permutation that a registered method returned.
Order result_of(Permutation permutation, Index size, std::string_view method) {
  if (permutation.size() != size) {
    throw InvalidArgument("the registered order '" + std::string(method) + "' returned " +
                          std::to_string(permutation.size()) + " places for " + std::to_string(size));
  }
  return {.permutation = std::move(permutation)};
}

}  // namespace

Order order_graph(std::string_view method, const VertexInput& input, const OrderOptions& options) {
  report("sort");
  Order result;
  if (const BuiltInVertexMethod* found = find_method(kVertexMethods, method)) {
    if (found->traits.needs_points)
      check_points(input.points, static_cast<std::size_t>(input.graph.size()), method);
    result = found->order(input, options);
    const bool stays = found->order == original_vertices || result.method.name == "original";  // by `auto`
    if (!stays) {
      result.permutation = with_isolated_last(std::move(result.permutation), input.graph);
    }
  } else if (const VertexMethod registered = registered_vertex_method(method)) {
    const VertexProblem problem{input.graph.offsets, input.graph.neighbours, input.weights, input.points};
    result = result_of(registered(problem, options), input.graph.size(), method);
  } else {
    refuse("vertex", method, vertex_methods());
  }
  if (result.method.name.empty()) result.method.name = method;
  return result;
}

Order order_incidence(std::string_view method, const ElementInput& input, const OrderOptions& options) {
  report("sort");
  Order result;
  if (const BuiltInElementMethod* found = find_method(kElementMethods, method)) {
    if (found->traits.needs_points)
      check_points(input.points, static_cast<std::size_t>(input.elements.vertex_count), method);
    result = found->order(input, options);
  } else if (const ElementMethod registered = registered_element_method(method)) {
    const ElementProblem problem{input.elements.offsets, input.elements.vertices, input.vertices.old_to_new(),
                                 input.points};
    result = result_of(registered(problem, options), input.elements.size(), method);
  } else {
    refuse("element", method, element_methods());
  }
  if (result.method.name.empty()) result.method.name = method;
  return result;
}

bool is_reversible(std::string_view method) {
  const BuiltInVertexMethod* const found = find_method(kVertexMethods, method);
  return found != nullptr && found->traits.is_reversible;
}

Workload made_for(std::string_view method) {
  const BuiltInVertexMethod* const found = find_method(kVertexMethods, method);
  return found != nullptr ? found->traits.made_for : Workload::all;
}

std::vector<MethodInfo> built_in_vertex_methods() {
  std::vector<MethodInfo> result;
  result.reserve(kVertexMethods.size());
  for (const auto& method : kVertexMethods) result.push_back(info_of(method));
  return result;
}

std::vector<MethodInfo> built_in_element_methods() {
  std::vector<MethodInfo> result;
  result.reserve(kElementMethods.size());
  for (const auto& method : kElementMethods) result.push_back(info_of(method));
  return result;
}

}  // namespace meshorder
