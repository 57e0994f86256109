// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Bindings for layouts of cells for graphics processors.
#include "cells.hpp"
#include "module.hpp"
#include "options.hpp"
#include <meshorder/layouts.hpp>

#include <utility>

namespace meshorder::python {
namespace {

nb::tuple as_tuple(const GpuCost& cost) {
  return nb::make_tuple(cost.requests, cost.sectors, cost.floor, cost.dram_bytes, cost.dram_floor);
}

}  // namespace

void add_layouts(nb::module_& module) {
  module.def("patches", [](const GivenCells& cells, std::size_t n, int size) {
    const MeshView mesh = mesh_view({}, cells, n);
    Patches cut = unlocked([&] { return patches(mesh.cells, n, size); });
    return nb::make_tuple(given(std::move(cut.cells)), given(std::move(cut.offsets)),
                          given(std::move(cut.vertices)), given(std::move(cut.local)));
  });
  module.def("gather_lists", [](const GivenCells& cells, std::size_t n) {
    const MeshView mesh = mesh_view({}, cells, n);
    GatherLists lists = unlocked([&] { return gather_lists(mesh.cells, n); });
    return nb::make_tuple(given(std::move(lists.offsets)), given(std::move(lists.cells)),
                          given(std::move(lists.corners)));
  });
  module.def("colours", [](const GivenCells& cells, std::size_t n) {
    const MeshView mesh = mesh_view({}, cells, n);
    Colours found = unlocked([&] { return colours(mesh.cells, n); });
    return nb::make_tuple(given(std::move(found.starts)), given(std::move(found.cells)));
  });
  module.def("gpu_cost", [](const GivenCells& cells, std::size_t n, int layout, std::size_t cache_bytes) {
    const MeshView mesh = mesh_view({}, cells, n);
    return as_tuple(
        unlocked([&] { return gpu_cost(mesh.cells, n, static_cast<GpuLayout>(layout), cache_bytes); }));
  });
  module.def("gpu_product_cost",
             [](const Array& offsets, const Array& neighbours, int lanes, std::size_t cache_bytes) {
               const GraphView graph{.offsets = index_view(offsets), .neighbours = index_view(neighbours)};
               return as_tuple(unlocked([&] { return gpu_product_cost(graph, lanes, cache_bytes); }));
             });
  module.def("sort_corners", [](const GivenCells& cells, std::size_t n) {
    const MeshView mesh = mesh_view({}, cells, n);
    return given(unlocked([&] { return sort_corners(mesh.cells, n); }));
  });
}

}  // namespace meshorder::python
