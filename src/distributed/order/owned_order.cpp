// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/owned_order.hpp"

#include "distributed/comm/halo.hpp"
#include "distributed/order/cell_order.hpp"
#include "distributed/order/curve.hpp"
#include "distributed/order/global_graph.hpp"
#include "distributed/order/local_orders.hpp"
#include "ordering/method.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace meshorder::distributed {
namespace {

/// Returns the cells with their vertices renumbered; `new_numbers` has the new numbers of this rank's
/// vertices.
Rows renumbered(const Communicator& communicator, const Layout& vertices, const Rows& cells,
                const std::vector<GlobalIndex>& new_numbers) {
  const Halo halo(communicator, vertices, cells.entries);
  const std::vector<GlobalIndex> numbers = halo.fetch(new_numbers);
  return communicator.together([&] {
    Rows result = cells;
    for (GlobalIndex& vertex : result.entries) vertex = numbers[halo.position(vertex)];
    return result;
  });
}

/// Returns whether any rank has coordinates. Throws SharedError if so and a rank has more or fewer points
/// than vertices.
bool has_points(const Communicator& communicator, const OwnedMesh& mesh) {
  const auto own_count = static_cast<std::size_t>(mesh.vertices.size(communicator.rank()));
  const std::vector<char> given = communicator.gathered(static_cast<char>(mesh.points.empty() ? 0 : 1));
  const bool any = std::find(given.begin(), given.end(), 1) != given.end();
  communicator.together([&] {
    if (any && mesh.points.size() != own_count)
      throw InvalidArgument("points: some ranks have coordinates and others have none");
  });
  return any;
}

}  // namespace

OwnedOrder order_owned(const Communicator& communicator, const OwnedMesh& mesh,
                       const DistributedOptions& options) {
  communicator.together([&] { check_options(options); });
  const bool is_placed = has_points(communicator, mesh);
  communicator.together([&] {
    if (!is_placed && needs_points(vertex_methods(), options.vertices))
      throw InvalidArgument("the order '" + options.vertices + "' needs coordinates, and there are none");
  });
  const int rank = communicator.rank();
  const GlobalGraph graph =
      global_graph(communicator, mesh.vertices, communicator.together([&] { return mesh.cells; }));
  const auto own_count = static_cast<std::size_t>(mesh.vertices.size(rank));
  Curve in_place;
  std::vector<Index> owners;
  communicator.together([&] {
    in_place.layout = mesh.vertices;
    in_place.points = is_placed ? mesh.points : std::vector<Point>(own_count, Point{});
    owners.assign(own_count, static_cast<Index>(rank));
  });
  const Halo halo(communicator, graph.layout, communicator.together([&] { return ghosts(graph, rank); }));
  OwnedOrder order;
  order.new_numbers =
      ordered_in_parts(communicator, graph, in_place,
                       HaloValues<Index>(halo, graph.layout.begin(rank), std::move(owners)),
                       communicator.size(), options.vertices, options.interface_place, options.order)
          .new_numbers;
  const Rows cells = renumbered(communicator, mesh.vertices, mesh.cells, order.new_numbers);
  order.cells = communicator.together([&] { return own_cells_by_lexmax(cells); });
  return order;
}

OwnedParts order_parts_of_owned(const Communicator& communicator, OwnedMesh mesh,
                                const DistributedOptions& options) {
  if (!has_points(communicator, mesh)) {
    communicator.together([&] {
      if (mesh.vertices.size() > 0)
        throw InvalidArgument("points: parts need coordinates, and there are none");
    });
  }
  MeshSlice slice;
  slice.vertices = mesh.vertices;
  const std::vector<GlobalIndex> counts = communicator.gathered(mesh.cells.size());
  communicator.together([&] {
    std::vector<GlobalIndex> starts{0};
    for (const GlobalIndex count : counts) starts.push_back(starts.back() + count);
    slice.cells = Layout(std::move(starts));
    slice.points = std::move(mesh.points);
    slice.cell_vertices = mesh.cells;
    // one shape for all cells, so that all count as elements; its dimension does not matter
    slice.shapes.assign(static_cast<std::size_t>(mesh.cells.size()), Shape::tetrahedron);
  });
  DistributedOrder order = order_slices(communicator, std::move(slice), options);
  OwnedParts parts;
  parts.new_numbers = std::move(order.new_vertices);
  parts.starts = std::move(order.report.part_starts);
  const Rows cells = renumbered(communicator, mesh.vertices, mesh.cells, parts.new_numbers);
  communicator.together([&] {
    const Layout ranges(parts.starts);
    for (Offset c = 0; c < cells.size(); ++c)
      parts.cells.push_back(ranges.owner(*std::max_element(cells[c].begin(), cells[c].end())));
  });
  return parts;
}

}  // namespace meshorder::distributed
