// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/order.hpp"

#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "cells/vertex_joins.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/bisection.hpp"
#include "distributed/order/cell_order.hpp"
#include "distributed/order/curve.hpp"
#include "distributed/order/fiedler.hpp"
#include "distributed/order/local_orders.hpp"
#include "distributed/order/partition.hpp"
#include <meshorder/error.hpp>
#include <meshorder/registry.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace meshorder::distributed {
namespace {

/// Methods that make no sense for a single part: they choose by the whole mesh or depend on the order in the
/// file.
constexpr std::array<std::string_view, 3> kNotInParts{"auto", "original", "scrambled"};

/// Records the time of each stage; a stage begins when the previous stage ends.
class Stages {
 public:
  explicit Stages(DistributedReport& report) : report_(report) {}
  void end(std::string_view stage) {
    report_.seconds.emplace_back(stage, stopwatch_.seconds());
    stopwatch_ = {};
  }

 private:
  DistributedReport& report_;
  Stopwatch stopwatch_;
};

/// Returns the elements of a slice; an element may be divided into pieces, whose vertices become neighbours.
Rows elements_of(const Communicator& communicator, const MeshSlice& slice) {
  const std::vector<char> is_element = are_elements(communicator, slice.shapes);
  return communicator.together([&] {
    Rows elements;
    elements.entries.reserve(slice.cell_vertices.entries.size());
    elements.offsets.reserve(slice.cell_vertices.offsets.size());
    for (Offset c = 0; c < slice.cell_vertices.size(); ++c) {
      if (is_element[static_cast<std::size_t>(c)] == 0) continue;
      for_each_piece(slice.shapes[static_cast<std::size_t>(c)], slice.cell_vertices[c],
                     [&](std::span<const GlobalIndex> piece) {
                       elements.entries.insert(elements.entries.end(), piece.begin(), piece.end());
                       elements.end_row();
                     });
    }
    return elements;
  });
}

/// Replaces each vertex in the rows by its value; `values` has the value of each of the halo's numbers.
void renumber(Rows& rows, const Halo& halo, const std::vector<GlobalIndex>& values) {
  for (GlobalIndex& vertex : rows.entries) vertex = values[halo.position(vertex)];
}

/// Returns 1 for each vertex of this rank that elements use, else 0. `halo` is the elements' halo: it
/// requests exactly the used vertices.
std::vector<char> used_vertices(const Communicator& communicator, const Layout& vertices, const Halo& halo) {
  return communicator.together([&] {
    std::vector<char> used(static_cast<std::size_t>(vertices.size(communicator.rank())), 0);
    for (const GlobalIndex vertex : halo.asked_of_this_rank())
      used[static_cast<std::size_t>(vertex - vertices.begin(communicator.rank()))] = 1;
    return used;
  });
}

/// Returns the new numbers of the vertices of a slice. Unused vertices keep their numbers on the curve.
std::vector<GlobalIndex> numbers_in_file(const Communicator& communicator, const MeshSlice& slice,
                                         const Curve& curve, std::span<const GlobalIndex> new_numbers) {
  constexpr GlobalIndex kNone = -1;
  std::vector<GlobalIndex> numbers =
      delivered<GlobalIndex>(communicator, slice.vertices, curve.number_in_file, new_numbers, kNone);
  for (std::size_t v = 0; v < numbers.size(); ++v) {
    if (numbers[v] == kNone) numbers[v] = curve.number_of[v];
  }
  return numbers;
}

/// Cuts the graph, and orders each part.
PartOrders in_parts(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                    const Curve& curve, const std::vector<GlobalIndex>& weights,
                    const DistributedOptions& options, DistributedReport& report, Stages& stages) {
  const GlobalIndex first = graph.layout.begin(communicator.rank());
  Partition partition{{}, Partitioner::rsb, {}};
  if (options.partitioner == Partitioner::rsb) {
    partition.part_of =
        bisected(communicator, graph, halo, curve.number_in_file, report.parts, weights, options.order);
  } else {
    partition = partitioned(communicator, graph, report.parts, options.partitioner, weights);
  }
  report.imbalance = imbalance_of(communicator, partition.part_of, weights, report.parts);
  report.partitioner = partition.by;
  report.partition_reason = std::move(partition.reason);
  stages.end("partition");

  std::vector<Index> places = std::move(partition.part_of);
  {
    const HaloValues<Index> part_of(halo, first, communicator.together([&] { return places; }));
    const Quotient quotient = order_of_parts(communicator, graph, part_of, report.parts);
    report.cut = quotient.cut;
    for (Index& part : places) part = quotient.place_of[static_cast<std::size_t>(part)];
  }
  return ordered_in_parts(communicator, graph, curve, HaloValues<Index>(halo, first, std::move(places)),
                          report.parts, options.vertices, options.interface_place, options.order);
}

/// Orders all vertices by the Fiedler vector, and divides that order into parts.
PartOrders in_one_order(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                        const std::vector<GlobalIndex>& number_in_file, const DistributedOptions& options,
                        DistributedReport& report) {
  SharedFiedlerOrder order = fiedler_order(communicator, graph, halo, number_in_file, options.order);
  RangesOfOrder ranges = ranges_of(communicator, graph, halo, std::move(order.new_numbers), report.parts);
  report.partitioner = Partitioner::order;
  report.imbalance = ranges.imbalance;
  report.cut = ranges.cut;
  report.fiedler = std::move(order.components);
  return std::move(ranges.parts);
}

/// Throws InvalidArgument for options that do not apply to ranges of one order.
void check_one_order(const DistributedOptions& options) {
  const std::string remedy = "; the partitions ptscotch, hilbert and rsb order each part";
  if (options.vertices != "fiedler")
    throw InvalidArgument("the partition 'order' is only for `fiedler`, not for '" + options.vertices + "'" +
                          remedy);
  if (options.balance != Balance::vertices)
    throw InvalidArgument("the partition 'order' balances vertices, not cells" + remedy);
  if (options.interface_place != InterfacePlace::mixed)
    throw InvalidArgument("the partition 'order' leaves interfaces at their places in the order" + remedy);
}

/// Throws InvalidArgument for more than a million parts if there are fewer vertices than parts: tables of
/// parts take memory.
void check_parts(Index parts, GlobalIndex vertices) {
  constexpr Index kOfAnyMesh = 1'000'000;
  if (parts <= kOfAnyMesh || parts <= vertices) return;
  throw InvalidArgument("parts: the mesh has " + std::to_string(vertices) + " vertices, too few for " +
                        std::to_string(parts) + " parts");
}

}  // namespace

void check_options(const DistributedOptions& options) {
  std::vector<MethodInfo> methods = vertex_methods();
  methods.erase(std::remove_if(methods.begin(), methods.end(),
                               [](const MethodInfo& method) {
                                 return std::find(kNotInParts.begin(), kNotInParts.end(), method.name) !=
                                        kNotInParts.end();
                               }),
                methods.end());
  if (std::none_of(methods.begin(), methods.end(),
                   [&](const MethodInfo& method) { return method.name == options.vertices; })) {
    throw InvalidArgument("there is no vertex order '" + options.vertices + "' within parts; known: " +
                          join(
                              methods, [](const MethodInfo& method) -> const auto& { return method.name; }));
  }
  if (options.parts < 0) {
    throw InvalidArgument("parts: expected 0 or more, not " + std::to_string(options.parts));
  }
}

DistributedOrder order_slices(const Communicator& communicator, MeshSlice slice,
                              const DistributedOptions& options) {
  communicator.together([&] {
    check_options(options);
    check_parts(options.parts, slice.vertices.size());
    if (options.partitioner == Partitioner::order) check_one_order(options);
  });
  DistributedOrder order;
  DistributedReport& report = order.report;
  report.parts = options.parts > 0 ? options.parts : communicator.size();
  Stages stages(report);
  const int rank = communicator.rank();

  // number the vertices along the curve, and build the graph in these numbers
  Rows elements = elements_of(communicator, slice);
  std::optional<Curve> curve;
  {
    const Halo halo(communicator, slice.vertices, elements.entries);
    const std::vector<char> used = used_vertices(communicator, slice.vertices, halo);
    curve = along_hilbert_curve(communicator, slice.vertices, slice.points, used);
    renumber(elements, halo, halo.fetch(curve->number_of));
  }
  stages.end("distribute");
  slice.points = {};
  std::vector<GlobalIndex> weights;
  if (options.balance == Balance::cells) weights = shares_in_elements(communicator, curve->layout, elements);
  const GlobalGraph graph = global_graph(communicator, curve->layout, std::move(elements));
  report.edges = communicator.sum(static_cast<GlobalIndex>(graph.rows.entries.size())) / 2;
  const Halo halo(communicator, graph.layout, communicator.together([&] { return ghosts(graph, rank); }));
  const GlobalIndex first = graph.layout.begin(rank);
  stages.end("graph");

  PartOrders parts = options.partitioner == Partitioner::order
                         ? in_one_order(communicator, graph, halo, curve->number_in_file, options, report)
                         : in_parts(communicator, graph, halo, *curve, weights, options, report, stages);
  report.ghosts = parts.ghosts;
  report.part_starts = parts.starts;
  report.interfaces = parts.interfaces;
  stages.end("order");

  order.new_vertices = numbers_in_file(communicator, slice, *curve, parts.new_numbers);
  report.before =
      edge_span(communicator, graph, HaloValues<GlobalIndex>(halo, first, std::move(curve->number_in_file)));
  report.after =
      edge_span(communicator, graph, HaloValues<GlobalIndex>(halo, first, std::move(parts.new_numbers)));
  {
    const Halo of_cells(communicator, slice.vertices, slice.cell_vertices.entries);
    renumber(slice.cell_vertices, of_cells, of_cells.fetch(order.new_vertices));
  }
  order.cells = cells_by_lexmax(communicator, slice.cells, std::move(slice.cell_vertices), slice.vertices);
  stages.end("cells");
  return order;
}

}  // namespace meshorder::distributed
