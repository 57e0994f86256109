// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/fluid/fluid_order.hpp"

#include "ordering/method.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <tuple>
#include <utility>

namespace meshorder {
namespace {

FluidOrdering checked(FluidOrdering ordering) {
  ordering.options.check = Check::none;  // the mesh is the program's own
  // `max` pays off at once; `lexmax` takes three times as long to sort and makes steps no faster
  if (ordering.elements == "auto") ordering.elements = "max";
  for (const auto& [method, known, what] : {std::tuple(&ordering.vertices, vertex_methods(), "vertices"),
                                            std::tuple(&ordering.elements, element_methods(), "elements")}) {
    if (*method != "auto" && !method_named(known, *method))
      throw InvalidArgument(fmt::format("unknown method for {} '{}'; see meshorder methods", what, *method));
  }
  return ordering;
}

}  // namespace

FluidOrder::FluidOrder(FluidOrdering ordering)
    : ordering_(checked(std::move(ordering))),
      reorderer_({.method = ordering_.stays() ? "auto" : ordering_.vertices, .order = ordering_.options}) {}

std::optional<Permutation> FluidOrder::particles(Index step, const FluidMesh& mesh,
                                                 std::span<const Point> points) {
  if (ordering_.stays() && (step > 0 || ordering_.vertices == "original")) return std::nullopt;
  if (ordering_.every == 0 && !ordering_.stays()) {
    Update update = reorderer_.update(MeshView{.points = points, .cells = mesh.view()});
    fresh_ += update.repair == Repair::warm || update.repair == Repair::fresh ? 1 : 0;
    if (update.repair == Repair::none) return std::nullopt;
    return std::move(update.permutation);
  }
  if (!ordering_.stays() && step % ordering_.every != 0) return std::nullopt;
  ++fresh_;
  const Graph graph = vertex_graph(mesh.view(), points.size());
  return order_vertices(graph, ordering_.vertices, ordering_.options, points).permutation;
}

void FluidOrder::sort(FluidMesh& mesh, std::span<const Point> points) const {
  if (ordering_.elements == "original" || mesh.corners.empty()) return;
  const Order order = order_elements(mesh.view(), Permutation::identity(static_cast<Index>(points.size())),
                                     ordering_.elements, ordering_.options, points);
  std::vector<Index> sorted(mesh.corners.size());
  order.permutation.move(mesh.corners, sorted, 4);
  mesh.corners = std::move(sorted);
}

}  // namespace meshorder
