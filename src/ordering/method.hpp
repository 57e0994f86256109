// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include "ordering/permutation.hpp"
#include "ordering/use.hpp"
#include "spectral/fiedler.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

struct OrderingOptions {
  std::uint64_t seed = 0;        ///< of `scrambled`, of METIS and of eigensolvers' start vectors
  double tolerance = 0.1;        ///< of Fiedler vectors, relative to λ₂
  Workload use = Workload::all;  ///< what `auto` chooses a method for
};

/// Which method made an order.
struct MethodChoice {
  std::string name;
  std::string reason;  ///< why `auto` took it; empty where it was asked for by its name

  bool operator==(const MethodChoice&) const = default;
};

/// An order, and how the eigensolver fared where there was one (a report for each connected component).
struct Ordering {
  Permutation permutation;
  std::vector<FiedlerComponent> fiedler;
  MethodChoice method = {};  ///< filled in by order_vertices and order_elements
};

/// What a vertex method may look at.
struct VertexProblem {
  GraphRef graph;
  std::span<const Point> points;  ///< one for each vertex, or none where there are no coordinates
};

/// What an element method may look at.
struct ElementProblem {
  const Incidence& elements;
  const Permutation& vertices;            ///< the order of the vertices, which most element orders follow
  std::span<const Point> points;          ///< of the vertices in their old order, or none
  std::function<CsrGraph()> facet_graph;  ///< joins elements that share a facet
};

/// A method is a name with a function behind it.
struct VertexMethod {
  std::string_view name;
  std::string_view sentence;  ///< for a list of methods
  Ordering (*order)(const VertexProblem&, const OrderingOptions&);
};

struct ElementMethod {
  std::string_view name;
  std::string_view sentence;
  Ordering (*order)(const ElementProblem&, const OrderingOptions&);
};

/// All methods, in the order in which help lists them.
std::span<const VertexMethod> vertex_methods();
std::span<const ElementMethod> element_methods();

/// Orders the vertices by the method of that name. Vertices without neighbours come last, in their old order
/// (but stay where they are under `original`). Throws InvalidArgument for an unknown name, which lists the
/// known ones, and for a geometric method without coordinates. `auto` chooses one of the others, and the
/// result says which.
Ordering order_vertices(std::string_view method, const VertexProblem& problem,
                        const OrderingOptions& options = {});

/// Orders the elements by the method of that name. Throws InvalidArgument like `order_vertices`.
Ordering order_elements(std::string_view method, const ElementProblem& problem,
                        const OrderingOptions& options = {});

}  // namespace meshorder
