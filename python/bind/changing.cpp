// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Bindings for orders of meshes that change.
#include "cells.hpp"
#include "module.hpp"
#include "options.hpp"
#include "results.hpp"
#include <meshorder/changing.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::python {
namespace {

using python::described;

using Previous = std::optional<Array>;

IndexView view_of(const Previous& previous) { return previous ? index_view(*previous) : IndexView(); }

nb::dict described(Update update) {
  nb::dict result;
  result["permutation"] = nb::cast(std::move(update.permutation));
  result["repair"] = std::string(to_string(update.repair));
  result["reason"] = update.reason;
  result["span_log2"] = update.span_log2;
  result["fresh_span_log2"] = update.fresh_span_log2;
  result["added"] = update.added;
  result["removed"] = update.removed;
  result["seconds"] = update.seconds;
  result["complete"] = update.complete;
  result["notes"] = update.notes;
  return result;
}

void make(Reorderer* self, const std::string& method, double slack, double budget, const nb::dict& options) {
  const Options given(options);
  new (self) Reorderer({.method = method, .slack = slack, .budget_seconds = budget, .order = given.order()});
}

nb::dict update_graph(Reorderer& self, const Array& offsets, const Array& neighbours,
                      const GivenPoints& points, const Previous& previous) {
  const GraphView graph{.offsets = index_view(offsets), .neighbours = index_view(neighbours)};
  const PointsView coordinates = points ? points_view(*points) : PointsView();
  const IndexView places = view_of(previous);
  return described(unlocked([&] { return self.update(graph, coordinates, places); }));
}

nb::dict update_mesh(Reorderer& self, const GivenPoints& points, const GivenCells& cells,
                     std::size_t vertex_count, const Previous& previous) {
  const MeshView mesh = mesh_view(points, cells, vertex_count);
  const IndexView places = view_of(previous);
  return described(unlocked([&] { return self.update(mesh, places); }));
}

nb::dict update_points(Reorderer& self, const nb::ndarray<nb::ro, nb::device::cpu>& points,
                       const Previous& previous) {
  const PointsView coordinates = points_view(points);
  const IndexView places = view_of(previous);
  return described(unlocked([&] { return self.update(coordinates, places); }));
}

nb::bytes state_of(const Reorderer& self) {
  const std::vector<std::byte> state = self.state();
  return nb::bytes(state.data(), state.size());
}

void restore(Reorderer& self, const nb::bytes& state) {
  self.restore(std::span(static_cast<const std::byte*>(state.data()), state.size()));
}

}  // namespace

void add_changing(nb::module_& module) {
  nb::class_<Reorderer>(module, "Reorderer")
      .def("__init__", &make)
      .def("update_graph", &update_graph, nb::arg(), nb::arg(), nb::arg().none(), nb::arg().none())
      .def("update_mesh", &update_mesh, nb::arg().none(), nb::arg(), nb::arg(), nb::arg().none())
      .def("update_points", &update_points, nb::arg(), nb::arg().none())
      .def("observe", &Reorderer::observe)
      .def("state", &state_of)
      .def("restore", &restore);
}

}  // namespace meshorder::python
