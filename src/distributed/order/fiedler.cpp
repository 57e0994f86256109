// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/fiedler.hpp"

#include "distributed/comm/rows.hpp"
#include "distributed/comm/sample_sort.hpp"
#include "distributed/order/components.hpp"
#include "distributed/order/shared_hierarchy.hpp"
#include "distributed/order/shared_problem.hpp"
#include "ordering/sorted.hpp"
#include "spectral/fiedler.hpp"
#include "spectral/lowest.hpp"
#include "spectral/nested_start.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

namespace meshorder::distributed {
namespace {

// Entries of the row that sends a vertex to the solver of its component; the vertex's neighbours follow.
enum VertexEntry : std::size_t { kNumber, kInFile, kPlace, kStart, kFirstNeighbour };

/// New numbers, found by this rank, of vertices of any rank; and reports on these vertices' components.
struct Places {
  struct Report {
    GlobalIndex place;
    FiedlerComponent component;
  };
  std::vector<GlobalIndex> vertices;
  std::vector<GlobalIndex> new_numbers;
  std::vector<Report> reports;
};

/// The vertex that decides the sign of a vector: the first in the file whose entry has at least half of the
/// largest magnitude.
struct Sign {
  GlobalIndex first = std::numeric_limits<GlobalIndex>::max();
  bool is_positive = false;

  void look_at(GlobalIndex in_file, double value, double largest) {
    if (std::abs(value) < 0.5 * largest || in_file > first) return;
    first = in_file;
    is_positive = value > 0;
  }
  void look_at(const Sign& other) {
    if (other.first < first) *this = other;
  }
};

/// Returns bits that ascend with the values; −0, NaN and infinities count as 0.
std::uint64_t ascending_bits(double value) {
  constexpr std::uint64_t kSignBit = std::uint64_t{1} << 63;
  const auto bits = std::bit_cast<std::uint64_t>(std::isfinite(value) ? value + 0.0 : 0.0);
  return (bits & kSignBit) != 0 ? ~bits : bits | kSignBit;
}

/// Sends vertices to the ranks that solve their components alone; returns the rows that this rank receives.
Rows rows_to_solvers(const Communicator& communicator, const GlobalGraph& graph, const Components& components,
                     const std::vector<GlobalIndex>& number_in_file) {
  Rows rows;
  std::vector<Dispatch> dispatches;
  communicator.together([&] {
    const ComponentNumbering& pieces = components.pieces;
    std::vector<Index> piece_of(pieces.order.size());
    for (Index piece = 0; piece < pieces.component_count(); ++piece) {
      for (const Index vertex : pieces.component(piece)) piece_of[static_cast<std::size_t>(vertex)] = piece;
    }
    const GlobalIndex first = graph.layout.begin(communicator.rank());
    for (std::size_t v = 0; v < piece_of.size(); ++v) {
      const Component& component = components.of_piece[static_cast<std::size_t>(piece_of[v])];
      if (component.solver == kAllRanks) continue;
      const auto neighbours = graph.rows[static_cast<Offset>(v)];
      rows.entries.insert(rows.entries.end(), {first + static_cast<GlobalIndex>(v), number_in_file[v],
                                               component.place, component.start});
      rows.entries.insert(rows.entries.end(), neighbours.begin(), neighbours.end());
      dispatches.push_back({component.solver, rows.size()});
      rows.end_row();
    }
  });
  return send_rows(communicator, std::move(rows), std::move(dispatches));
}

/// Returns the graph of the rows. Their vertices must ascend and include all neighbours.
CsrGraph graph_of_rows(const Rows& rows) {
  std::vector<GlobalIndex> numbers;
  numbers.reserve(static_cast<std::size_t>(rows.size()));
  for (Offset row = 0; row < rows.size(); ++row) numbers.push_back(rows[row][kNumber]);
  const NumberSet set(numbers);
  CsrGraph graph;
  for (Offset row = 0; row < rows.size(); ++row) {
    for (const GlobalIndex neighbour : rows[row].subspan(kFirstNeighbour))
      graph.neighbours.push_back(static_cast<Index>(set.position(neighbour)));
    graph.offsets.push_back(static_cast<Offset>(graph.neighbours.size()));
  }
  return graph;
}

/// Orders the components that this rank solves alone.
void order_alone(const Rows& rows, const FiedlerOptions& options, Places& places) {
  const FiedlerVectors fiedler = fiedler_vectors(graph_of_rows(rows), options);
  std::vector<std::pair<double, Index>> sorted;
  for (std::size_t c = 0; c < fiedler.components.size(); ++c) {
    const std::vector<Index>& vertices = fiedler.component_vertices[c];
    const auto value_of = [&](Index vertex) { return fiedler.values[static_cast<std::size_t>(vertex)]; };
    double largest = 0;
    for (const Index vertex : vertices) largest = std::max(largest, std::abs(value_of(vertex)));
    Sign sign;
    for (const Index vertex : vertices) sign.look_at(rows[vertex][kInFile], value_of(vertex), largest);
    sorted.clear();
    for (const Index vertex : vertices)
      sorted.emplace_back(sign.is_positive ? -value_of(vertex) : value_of(vertex), vertex);
    sort_distinct(sorted);
    GlobalIndex next = rows[vertices.front()][kStart];
    for (const auto& [value, vertex] : sorted) {
      places.vertices.push_back(rows[vertex][kNumber]);
      places.new_numbers.push_back(next++);
    }
    places.reports.push_back({rows[vertices.front()][kPlace], fiedler.components[c]});
  }
}

/// Returns this rank's vertices of a component that all ranks solve, in the sequence of the Laplacian's rows.
std::vector<Index> own_members(const Components& components, const Component& component) {
  std::vector<Index> members;
  for (Index piece = 0; piece < components.pieces.component_count(); ++piece) {
    if (components.of_piece[static_cast<std::size_t>(piece)].place != component.place) continue;
    const auto vertices = components.pieces.component(piece);
    members.insert(members.end(), vertices.begin(), vertices.end());
  }
  return members;
}

/// Returns the Laplacian of a component, its rows numbered rank by rank.
SharedLevel finest_level(const Communicator& communicator, const GlobalGraph& graph, const Halo& ghosts,
                         const std::vector<Index>& members) {
  const int rank = communicator.rank();
  const Layout layout = Layout::of_sizes(communicator.gathered(std::ssize(members)));
  std::vector<GlobalIndex> row_of = communicator.together(
      [&] { return std::vector<GlobalIndex>(static_cast<std::size_t>(graph.rows.size()), -1); });
  for (std::size_t k = 0; k < members.size(); ++k)
    row_of[static_cast<std::size_t>(members[k])] = layout.begin(rank) + static_cast<GlobalIndex>(k);
  const HaloValues<GlobalIndex> row_with_ghosts(ghosts, graph.layout.begin(rank), std::move(row_of));
  const auto is_own = [&](GlobalIndex row) { return row >= layout.begin(rank) && row < layout.end(rank); };
  std::vector<GlobalIndex> others;
  communicator.together([&] {
    for (const GlobalIndex ghost : ghosts.numbers()) {
      if (row_with_ghosts[ghost] >= 0) others.push_back(row_with_ghosts[ghost]);
    }
  });
  SharedLevel level{layout, Halo(communicator, layout, others), {}};
  communicator.together([&] {
    Laplacian& laplacian = level.laplacian;
    laplacian.offsets.reserve(members.size() + 1);
    laplacian.diagonal.reserve(members.size());
    for (const Index member : members) {
      const auto neighbours = graph.rows[member];
      for (const GlobalIndex neighbour : neighbours) {
        const GlobalIndex row = row_with_ghosts[neighbour];
        const auto column = is_own(row) ? static_cast<std::size_t>(row - layout.begin(rank))
                                        : members.size() + level.halo.position(row);
        laplacian.neighbours.push_back(static_cast<Index>(column));
      }
      laplacian.offsets.push_back(static_cast<Offset>(laplacian.neighbours.size()));
      laplacian.diagonal.push_back(static_cast<double>(neighbours.size()));
    }
  });
  return level;
}

/// Returns this rank's entries of the Fiedler vector of a connected graph.
std::vector<double> solve(const Communicator& communicator, SharedLevel finest, const FiedlerOptions& options,
                          GlobalIndex few, FiedlerComponent& report) {
  report.size = static_cast<Index>(finest.layout.size());
  SharedHierarchy hierarchy(communicator, std::move(finest), few);
  VectorBlock<1> x;
  VectorBlock<1> companion;
  {
    const StartBlock start = hierarchy.nested_start(options.seed);
    x = column(start, 0);
    companion = column(start, 1);
  }
  SharedProblem problem(hierarchy, 0);
  // use different random numbers on every rank
  const std::uint64_t seed =
      options.seed + static_cast<std::uint64_t>(communicator.rank()) * 0x9e3779b97f4a7c15U;
  const LobpcgResult solved = lowest_eigenvector(
      problem, {.tolerance = options.tolerance, .max_iterations = options.max_iterations, .limit = {}}, seed,
      x, std::move(companion));
  report.lambda2 = solved.eigenvalue;
  report.residual = solved.residual;
  report.iterations = solved.iterations;
  report.converged = solved.converged;
  std::vector<double> values;
  values.reserve(x.size());
  for (const auto& [value] : x) values.push_back(value);
  return values;
}

/// Gives a vector the sign for which the deciding entry (see Sign) is negative or 0.
void give_sign(const Communicator& communicator, const std::vector<GlobalIndex>& in_file,
               std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const std::vector<double> of_ranks = communicator.gathered(largest);
  largest = *std::max_element(of_ranks.begin(), of_ranks.end());
  Sign sign;
  for (std::size_t v = 0; v < values.size(); ++v) sign.look_at(in_file[v], values[v], largest);
  for (const Sign& other : communicator.gathered(sign)) sign.look_at(other);
  if (!sign.is_positive) return;
  for (double& value : values) value = -value;
}

/// Orders a component that all ranks solve.
void order_together(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                    const std::vector<GlobalIndex>& number_in_file, const Components& components,
                    const Component& component, const FiedlerOptions& options, GlobalIndex few,
                    Places& places) {
  const std::vector<Index> members =
      communicator.together([&] { return own_members(components, component); });
  FiedlerComponent report;
  std::vector<double> values =
      solve(communicator, finest_level(communicator, graph, halo, members), options, few, report);
  if (communicator.is_root()) places.reports.push_back({component.place, report});
  std::vector<GlobalIndex> in_file;
  communicator.together([&] {
    for (const Index member : members) in_file.push_back(number_in_file[static_cast<std::size_t>(member)]);
  });
  give_sign(communicator, in_file, values);
  std::vector<SortEntry> entries;
  communicator.together([&] {
    entries.reserve(members.size());
    for (std::size_t k = 0; k < members.size(); ++k)
      entries.push_back({ascending_bits(values[k]), graph.layout.begin(communicator.rank()) + members[k]});
  });
  entries = sample_sorted(communicator, std::move(entries));
  const Layout sorted = Layout::of_sizes(communicator.gathered(std::ssize(entries)));
  communicator.together([&] {
    GlobalIndex next = component.start + sorted.begin(communicator.rank());
    for (const SortEntry& entry : entries) {
      places.vertices.push_back(entry.number);
      places.new_numbers.push_back(next++);
    }
  });
}

}  // namespace

SharedFiedlerOrder fiedler_order(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                                 const std::vector<GlobalIndex>& number_in_file, const OrderOptions& options,
                                 SharedSizes sizes) {
  FiedlerOptions for_solver = communicator.together([&] { return solver_options(options); });
  for_solver.start = {};  // start vectors are supported only for a graph on one process
  const GlobalIndex few = std::max(sizes.few, graph.layout.size() / communicator.size());
  const Components components = components_of(communicator, graph, halo, sizes.alone);
  Places places;
  {
    const Rows rows = rows_to_solvers(communicator, graph, components, number_in_file);
    communicator.together([&] { order_alone(rows, for_solver, places); });
  }
  for (const Component& component : components.of_all_ranks)
    order_together(communicator, graph, halo, number_in_file, components, component, for_solver, few, places);
  SharedFiedlerOrder order;
  order.new_numbers =
      delivered<GlobalIndex>(communicator, graph.layout, places.vertices, places.new_numbers, 0);
  std::vector<Places::Report> reports = communicator.gathered_at_root(places.reports);
  communicator.at_root([&] {
    std::sort(reports.begin(), reports.end(),
              [](const Places::Report& a, const Places::Report& b) { return a.place < b.place; });
    for (const Places::Report& report : reports) order.components.push_back(report.component);
  });
  return order;
}

}  // namespace meshorder::distributed
