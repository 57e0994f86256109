// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/method.hpp"

#include "base/error.hpp"
#include "ordering/all_methods.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace meshorder {
namespace {

constexpr std::array kVertexMethods{
    VertexMethod{"auto", "the one below that measurements favour for the mesh's size and use (--for)",
                 auto_vertices},
    VertexMethod{"original", "the order of the file", original_vertices},
    VertexMethod{"scrambled", "a seeded random order, the paper's point of reference", scrambled_vertices},
    VertexMethod{"fiedler", "sorted by the Fiedler vector of the vertex graph, the paper's order",
                 fiedler_vertices},
    VertexMethod{"minla", "the Fiedler order, improved towards the least sum of edge spans", minla_vertices},
    VertexMethod{"spectral", "cut along Fiedler vectors again and again, down to a few vertices",
                 spectral_vertices},
    VertexMethod{"rcm", "reverse Cuthill-McKee: breadth first, neighbours by degree, reversed", rcm_vertices},
    VertexMethod{"bfs", "breadth first from a vertex at the rim", bfs_vertices},
    VertexMethod{"morton", "along Morton's Z curve through the coordinates", morton_vertices},
    VertexMethod{"hilbert", "along Hilbert's curve through the coordinates", hilbert_vertices},
    VertexMethod{"metis-nd", "METIS nested dissection, made for sparse factorisation", metis_nd_vertices},
    VertexMethod{"metis-rb", "METIS recursive bisection down to a few vertices", metis_rb_vertices},
};

constexpr std::array kElementMethods{
    ElementMethod{"auto", "the one below that measurements favour: lexmax", auto_elements},
    ElementMethod{"original", "the order of the file", original_elements},
    ElementMethod{"scrambled", "a seeded random order, the paper's point of reference", scrambled_elements},
    ElementMethod{
        "fiedler",
        "by the Fiedler vector of the graph that joins elements sharing a vertex, the paper's order",
        fiedler_elements},
    ElementMethod{"fiedler-facet", "by the Fiedler vector of the graph that joins elements sharing a facet",
                  fiedler_facet_elements},
    ElementMethod{"mean", "by the mean rank of their vertices", mean_elements},
    ElementMethod{"min", "by the least rank of their vertices", min_elements},
    ElementMethod{"max", "by the largest rank of their vertices", max_elements},
    ElementMethod{"lexmax", "by the ranks of their vertices, largest first, compared like words",
                  lexmax_elements},
    ElementMethod{"hilbert", "along Hilbert's curve through their centroids", hilbert_elements},
};

template <class Methods>
const auto& find_method(const Methods& methods, std::string_view name, std::string_view what) {
  const auto found =
      std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == name; });
  if (found != methods.end()) return *found;
  std::string known;
  for (const auto& method : methods) known += (known.empty() ? "" : ", ") + std::string(method.name);
  throw InvalidArgument("unknown " + std::string(what) + " order '" + std::string(name) + "'; known are " +
                        known);
}

/// Moves what has no neighbours behind the rest, in old order.
Permutation with_isolated_last(const Permutation& order, GraphRef graph) {
  std::vector<Index> new_to_old;
  new_to_old.reserve(order.new_to_old().size());
  for (const Index v : order.new_to_old()) {
    if (graph.degree(v) > 0) new_to_old.push_back(v);
  }
  for (Index v = 0; v < graph.size(); ++v) {
    if (graph.degree(v) == 0) new_to_old.push_back(v);
  }
  return Permutation::from_new_to_old(std::move(new_to_old));
}

}  // namespace

std::span<const VertexMethod> vertex_methods() { return kVertexMethods; }
std::span<const ElementMethod> element_methods() { return kElementMethods; }

Ordering order_vertices(std::string_view method, const VertexProblem& problem,
                        const OrderingOptions& options) {
  const VertexMethod& found = find_method(kVertexMethods, method, "vertex");
  Ordering result = found.order(problem, options);
  if (found.order != original_vertices) {
    result.permutation = with_isolated_last(result.permutation, problem.graph);
  }
  if (result.method.name.empty()) result.method.name = method;
  return result;
}

Ordering order_elements(std::string_view method, const ElementProblem& problem,
                        const OrderingOptions& options) {
  Ordering result = find_method(kElementMethods, method, "element").order(problem, options);
  if (result.method.name.empty()) result.method.name = method;
  return result;
}

}  // namespace meshorder
