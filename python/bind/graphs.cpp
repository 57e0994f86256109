// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Bindings for orders, Fiedler vectors and quality of graphs.
#include "module.hpp"
#include "options.hpp"
#include "results.hpp"
#include <meshorder/fiedler.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>

namespace meshorder::python {
namespace {

using Weights = std::optional<Array>;
using Points = std::optional<nb::ndarray<nb::ro, nb::device::cpu>>;

GraphView graph_view(const Array& offsets, const Array& neighbours, const Weights& weights) {
  return {.offsets = index_view(offsets),
          .neighbours = index_view(neighbours),
          .weights = weights ? real_view(*weights) : RealView()};
}

nb::dict order_graph(const Array& offsets, const Array& neighbours, const Weights& weights,
                     const Points& points, const std::string& method, const nb::dict& options) {
  const Options given_options(options);
  const GraphView graph = graph_view(offsets, neighbours, weights);
  const PointsView coordinates = points ? points_view(*points) : PointsView();
  return described(
      unlocked([&] { return order_vertices(graph, method, given_options.order(), coordinates); }));
}

nb::dict fiedler_of_graph(const Array& offsets, const Array& neighbours, const Weights& weights,
                          const nb::dict& options) {
  const Options given_options(options);
  const GraphView graph = graph_view(offsets, neighbours, weights);
  Fiedler fiedler = unlocked([&] { return fiedler_vector(graph, given_options.order()); });
  nb::dict result;
  result["values"] = given(std::move(fiedler.values));
  result["component_of"] = given(std::move(fiedler.component_of));
  result["components"] = described(fiedler.components);
  result["complete"] = fiedler.complete;
  result["notes"] = fiedler.notes;
  return result;
}

nb::dict quality_of_graph(const Array& offsets, const Array& neighbours, const Permutation* order,
                          const nb::dict& options) {
  const Options given_options(options);
  const GraphView graph = graph_view(offsets, neighbours, {});
  return described(unlocked([&] {
    return order == nullptr ? quality(graph, given_options.run(), Symmetry::mirror)
                            : quality(graph, *order, given_options.run(), Symmetry::mirror);
  }));
}

nb::object pattern_of_graph(const Array& offsets, const Array& neighbours, const Permutation& order,
                            int side) {
  const GraphView graph = graph_view(offsets, neighbours, {});
  return described(unlocked([&] { return sparsity_pattern(graph, order, side, {}, Symmetry::mirror); }));
}

}  // namespace

void add_graphs(nb::module_& module) {
  module.def("order", &order_graph, nb::arg(), nb::arg(), nb::arg().none(), nb::arg().none(), nb::arg(),
             nb::arg());
  module.def("fiedler", &fiedler_of_graph, nb::arg(), nb::arg(), nb::arg().none(), nb::arg());
  module.def("quality", &quality_of_graph, nb::arg(), nb::arg(), nb::arg().none(), nb::arg());
  module.def("sparsity_pattern", &pattern_of_graph);
}

}  // namespace meshorder::python
