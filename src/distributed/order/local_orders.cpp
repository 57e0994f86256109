// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/local_orders.hpp"

#include "base/parallel.hpp"
#include "distributed/comm/rows.hpp"
#include "distributed/order/balance.hpp"
#include "ordering/method.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>
#include <utility>

namespace meshorder::distributed {
namespace {

// Entries of the row that sends a vertex to the rank of its part; the vertex's neighbours in the part follow.
enum Entry : std::size_t { kVertex, kPart, kPull, kIsInterface, kX, kY, kZ, kNeighbours };

/// The rows of this rank's vertices, and the ranks to send them to.
struct Departure {
  Rows rows;
  std::vector<Dispatch> dispatches;
  GlobalIndex ghosts = 0;  ///< number of other parts with neighbours of a vertex, summed over the vertices
};

Departure departing(const GlobalGraph& graph, const Curve& curve, const HaloValues<Index>& place_of,
                    const Layout& parts, int rank) {
  Departure departure;
  departure.rows.entries.reserve(graph.rows.entries.size() +
                                 kNeighbours * static_cast<std::size_t>(graph.rows.size()));
  std::vector<Index> other_parts;
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    const Index part = place_of.own(row);
    auto& entries = departure.rows.entries;
    const std::size_t begin = entries.size();
    const Point& point = curve.points[static_cast<std::size_t>(row)];
    entries.insert(entries.end(),
                   {graph.layout.begin(rank) + row, part, 0, 0, std::bit_cast<GlobalIndex>(point[0]),
                    std::bit_cast<GlobalIndex>(point[1]), std::bit_cast<GlobalIndex>(point[2])});
    other_parts.clear();
    for (const GlobalIndex neighbour : graph.rows[row]) {
      const Index other = place_of[neighbour];
      if (other == part) {
        entries.push_back(neighbour);
      } else {
        entries[begin + kPull] += other < part ? 1 : -1;
        other_parts.push_back(other);
      }
    }
    entries[begin + kIsInterface] = other_parts.empty() ? 0 : 1;
    departure.rows.end_row();
    departure.dispatches.push_back({parts.owner(part), row});
    std::sort(other_parts.begin(), other_parts.end());
    departure.ghosts += std::unique(other_parts.begin(), other_parts.end()) - other_parts.begin();
  }
  return departure;
}

/// A part in the form that serial methods take: its vertices are numbered 0, 1, … along the curve.
struct LocalPart {
  std::vector<GlobalIndex> names;  ///< numbers in the whole graph, ascending
  CsrGraph graph;
  std::vector<Point> points;
  std::vector<float> pull;
  std::vector<char> is_interface;  ///< for each vertex, whether it has neighbours in other parts
};

/// Returns the part whose vertices are the rows `members`, ascending.
LocalPart part_of_rows(const Rows& rows, std::span<const Offset> members) {
  LocalPart part;
  part.names.reserve(members.size());
  for (const Offset row : members) part.names.push_back(rows[row][kVertex]);
  for (const Offset row : members) {
    const auto entries = rows[row];
    part.points.push_back({std::bit_cast<double>(entries[kX]), std::bit_cast<double>(entries[kY]),
                           std::bit_cast<double>(entries[kZ])});
    part.pull.push_back(static_cast<float>(entries[kPull]));
    part.is_interface.push_back(static_cast<char>(entries[kIsInterface]));
    for (const GlobalIndex neighbour : entries.subspan(kNeighbours)) {
      const auto place =
          std::lower_bound(part.names.begin(), part.names.end(), neighbour) - part.names.begin();
      part.graph.neighbours.push_back(static_cast<Index>(place));
    }
    part.graph.offsets.push_back(static_cast<Offset>(part.graph.neighbours.size()));
  }
  return part;
}

/// Returns whether reversing an order brings vertices nearer to their neighbours in other parts.
bool is_the_wrong_way_round(std::span<const Index> places, const std::vector<float>& pull) {
  const double middle = 0.5 * (static_cast<double>(places.size()) - 1);
  double along = 0;
  for (std::size_t v = 0; v < pull.size(); ++v) along += pull[v] * (places[v] - middle);
  return along > 0;
}

/// Moves the vertices of the interface after the others; both groups keep their order.
void put_interface_last(std::vector<Index>& places, const std::vector<char>& is_interface) {
  std::vector<Index> vertex_at(places.size());
  for (Index v = 0; v < index_size(places); ++v) vertex_at[places[v]] = v;
  Index next = 0;
  for (const bool on_interface : {false, true}) {
    for (const Index vertex : vertex_at) {
      if ((is_interface[vertex] != 0) == on_interface) places[vertex] = next++;
    }
  }
}

/// Returns the position of each vertex of a part in the part's order.
std::vector<Index> places_in(const LocalPart& part, std::string_view method, InterfacePlace interface_place,
                             const OrderOptions& options) {
  const Order order = in_call(options.run, [&] {
    return order_graph(method, {.graph = part.graph, .points = part.points, .pull = part.pull}, options);
  });
  std::vector<Index> places(order.permutation.old_to_new().begin(), order.permutation.old_to_new().end());
  if (is_reversible(method) && is_the_wrong_way_round(places, part.pull)) {
    for (Index& place : places) place = index_size(places) - 1 - place;
  }
  if (interface_place == InterfacePlace::last) put_interface_last(places, part.is_interface);
  return places;
}

}  // namespace

PartOrders ordered_in_parts(const Communicator& communicator, const GlobalGraph& graph, const Curve& curve,
                            const HaloValues<Index>& place_of, Index parts, std::string_view method,
                            InterfacePlace interface_place, const OrderOptions& options) {
  PartOrders result;
  std::vector<GlobalIndex> sizes = communicator.together([&] {
    std::vector<GlobalIndex> own(static_cast<std::size_t>(parts), 0);
    for (const Index part : place_of.own()) ++own[static_cast<std::size_t>(part)];
    return own;
  });
  sizes = communicator.sums(std::move(sizes));
  if (*std::max_element(sizes.begin(), sizes.end()) > kMaxIndex) {
    throw SharedError(Code::too_large, "more than 2,147,483,647 vertices in a part; give more --parts");
  }
  result.starts.assign(1, 0);
  for (const GlobalIndex size : sizes) result.starts.push_back(result.starts.back() + size);

  // send vertices to the ranks of their parts
  const Layout ranks_of_parts = Layout::even(parts, communicator.size());
  Departure departure = communicator.together(
      [&] { return departing(graph, curve, place_of, ranks_of_parts, communicator.rank()); });
  result.ghosts = communicator.sum(departure.ghosts);
  const Rows rows = send_rows(communicator, std::move(departure.rows), std::move(departure.dispatches));

  // order part by part; rows arrived in rank order, so the vertices of a part ascend
  std::vector<GlobalIndex> names;
  std::vector<GlobalIndex> numbers;
  result.interfaces.assign(static_cast<std::size_t>(parts), 0);
  communicator.together([&] {
    const GlobalIndex first_part = ranks_of_parts.begin(communicator.rank());
    const auto part_count = static_cast<std::size_t>(ranks_of_parts.size(communicator.rank()));
    std::vector<std::vector<Offset>> members(part_count);
    for (Offset row = 0; row < rows.size(); ++row)
      members[static_cast<std::size_t>(rows[row][kPart] - first_part)].push_back(row);
    for (std::size_t k = 0; k < part_count; ++k) {
      const LocalPart part = part_of_rows(rows, members[k]);
      const std::vector<Index> places = places_in(part, method, interface_place, options);
      result.interfaces[static_cast<std::size_t>(first_part) + k] =
          std::count(part.is_interface.begin(), part.is_interface.end(), 1);
      const GlobalIndex first = result.starts[static_cast<std::size_t>(first_part) + k];
      for (std::size_t v = 0; v < places.size(); ++v) {
        names.push_back(part.names[v]);
        numbers.push_back(first + places[v]);
      }
    }
  });
  result.interfaces = communicator.sums(std::move(result.interfaces));
  result.new_numbers = delivered<GlobalIndex>(communicator, graph.layout, names, numbers, 0);
  return result;
}

RangesOfOrder ranges_of(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                        std::vector<GlobalIndex> new_numbers, Index parts) {
  const Layout ranges = Layout::even(graph.layout.size(), parts);
  RangesOfOrder result;
  result.parts.starts = ranges.starts();
  result.parts.new_numbers = std::move(new_numbers);
  std::vector<Index> own = communicator.together([&] {
    std::vector<Index> part_of;
    part_of.reserve(result.parts.new_numbers.size());
    for (const GlobalIndex number : result.parts.new_numbers) part_of.push_back(ranges.owner(number));
    return part_of;
  });
  result.imbalance = imbalance_of(communicator, own, {}, parts);
  const HaloValues<Index> part_of(halo, graph.layout.begin(communicator.rank()), std::move(own));
  communicator.together([&] {
    result.parts.interfaces.assign(static_cast<std::size_t>(parts), 0);
    std::vector<Index> others;
    for (Offset row = 0; row < graph.rows.size(); ++row) {
      const Index part = part_of.own(row);
      others.clear();
      for (const GlobalIndex neighbour : graph.rows[row]) {
        if (part_of[neighbour] != part) others.push_back(part_of[neighbour]);
      }
      if (others.empty()) continue;
      ++result.parts.interfaces[static_cast<std::size_t>(part)];
      result.cut += std::count_if(others.begin(), others.end(), [&](Index other) { return other > part; });
      std::sort(others.begin(), others.end());
      result.parts.ghosts += std::unique(others.begin(), others.end()) - others.begin();
    }
  });
  result.parts.interfaces = communicator.sums(std::move(result.parts.interfaces));
  result.cut = communicator.sum(result.cut);
  result.parts.ghosts = communicator.sum(result.parts.ghosts);
  return result;
}

}  // namespace meshorder::distributed
