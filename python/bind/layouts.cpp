// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Layouts of cells for graphics processors.
#include "cells.hpp"
#include "module.hpp"
#include "options.hpp"
#include <meshorder/error.hpp>
#include <meshorder/layouts.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace meshorder::python {

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
  module.def("gpu_cost", [](const GivenCells& cells, std::size_t n, const std::string& layout) {
    static constexpr std::array<std::pair<const char*, GpuLayout>, 3> kLayouts{
        {{"packed", GpuLayout::packed}, {"apart", GpuLayout::apart}, {"padded", GpuLayout::padded}}};
    const auto* const wanted = std::find_if(kLayouts.begin(), kLayouts.end(),
                                            [&](const auto& known) { return layout == known.first; });
    if (wanted == kLayouts.end())
      throw InvalidArgument("layout: expected 'packed', 'apart' or 'padded', not '" + layout + "'");
    const MeshView mesh = mesh_view({}, cells, n);
    const GpuCost cost = unlocked([&] { return gpu_cost(mesh.cells, n, wanted->second); });
    return nb::make_tuple(cost.requests, cost.sectors, cost.floor);
  });
  module.def("sort_corners", [](const GivenCells& cells, std::size_t n) {
    const MeshView mesh = mesh_view({}, cells, n);
    return nb::make_tuple(given(unlocked([&] { return sort_corners(mesh.cells, n); })), mesh.cells.size());
  });
}

}  // namespace meshorder::python
