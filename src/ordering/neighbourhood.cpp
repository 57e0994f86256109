// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/neighbourhood.hpp"

#include "base/parallel.hpp"
#include "cells/vertex_joins.hpp"
#include "graph/row_access.hpp"
#include "metrics/measures.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/grouped.hpp"
#include "ordering/space_filling.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kOneOf = 16;
/// Smaller graphs and meshes are examined whole.
constexpr Index kAllOf = 4096;

/// Returns one of every 16 numbers below n, ascending; all numbers for n < `kAllOf`. A hash chooses each one,
/// so that the sample does not follow the period of a lattice.
std::vector<Index> sample_of(Index n) {
  std::vector<Index> sample(static_cast<std::size_t>(n < kAllOf ? n : chunk_count(n, kOneOf)));
  for (Index k = 0; k < index_size(sample); ++k) {
    if (n < kAllOf) {
      sample[static_cast<std::size_t>(k)] = k;
      continue;
    }
    const Offset begin = Offset{kOneOf} * k;
    const std::uint64_t hash = (static_cast<std::uint64_t>(begin) + 1) * 0x9e3779b97f4a7c15U >> 60U;
    sample[static_cast<std::size_t>(k)] =
        static_cast<Index>(std::min(begin + static_cast<Offset>(hash), Offset{n} - 1));
  }
  return sample;
}

/// The mean of ⌊log₂ span⌋.
class SpanMean {
 public:
  void add(Index a, Index b) {
    const auto span = static_cast<std::uint32_t>(std::abs(a - b));
    if (span == 0) return;  // a loop
    sum_ += std::bit_width(span) - 1;
    ++count_;
  }
  [[nodiscard]] double value() const {
    return count_ == 0 ? 0 : static_cast<double>(sum_) / static_cast<double>(count_);
  }

 private:
  Offset sum_ = 0;
  Offset count_ = 0;
};

Index place(std::span<const Index> place_of, Index v) {
  return place_of.empty() ? v : place_of[static_cast<std::size_t>(v)];
}

bool reads_forward(const GraphRef& graph) {
  constexpr double kFew = 0.1;  // with a smaller jump share, a sweep reads forward
  return sampled_jump_share(graph, Permutation::identity(graph.size())) < kFew;
}

NeighbourRows empty_rows(std::size_t count) {
  NeighbourRows rows;
  rows.offsets.resize(count + 1);
  return rows;
}

}  // namespace

double GraphNeighbourhood::span_log2(std::span<const Index> place_of) const {
  const GraphRef graph(graph_.offsets, graph_.neighbours);
  SpanMean mean;
  const std::vector<Index> sample = sample_of(graph.size());
  for (Index k = 0; k < index_size(sample); ++k) {
    prefetch_row(graph, sample, k);
    const Index v = sample[static_cast<std::size_t>(k)];
    for (const Index u : graph[v]) mean.add(place(place_of, v), place(place_of, u));
  }
  return mean.value();
}

NeighbourRows GraphNeighbourhood::rows_of(std::span<const Index> vertices) const {
  const GraphRef graph(graph_.offsets, graph_.neighbours);
  NeighbourRows rows;
  for (const Index v : vertices) {
    rows.neighbours.insert(rows.neighbours.end(), graph[v].begin(), graph[v].end());
    rows.offsets.push_back(static_cast<Offset>(rows.neighbours.size()));
  }
  return rows;
}

Order GraphNeighbourhood::order_by(std::string_view method, const OrderOptions& options) {
  return order_vertices_by_options(method, {{graph_.offsets, graph_.neighbours}, points_, graph_.weights},
                                   options);
}

bool GraphNeighbourhood::is_read_forward() { return reads_forward({graph_.offsets, graph_.neighbours}); }

Shape CellNeighbourhood::shape_of(Index cell) const {
  return cells_.shapes.empty() ? Shape::polyhedron : cells_.shapes[static_cast<std::size_t>(cell)];
}

double CellNeighbourhood::span_log2(std::span<const Index> place_of) const {
  const IncidenceRef cells = cells_.incidence();
  SpanMean mean;
  for (const Index c : sample_of(cells.size())) {
    for_each_piece(shape_of(c), cells[c], [&](std::span<const Index> piece) {
      for (std::size_t i = 1; i < piece.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) mean.add(place(place_of, piece[i]), place(place_of, piece[j]));
      }
    });
  }
  return mean.value();
}

NeighbourRows CellNeighbourhood::rows_of(std::span<const Index> vertices) const {
  if (by_curve_) return empty_rows(vertices.size());
  std::vector<Index> number_of(static_cast<std::size_t>(size()), -1);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    number_of[static_cast<std::size_t>(vertices[k])] = static_cast<Index>(k);
  const IncidenceRef cells = cells_.incidence();
  const auto for_each_neighbour = [&](const auto& call) {
    for (Index c = 0; c < cells.size(); ++c) {
      const auto is_asked = [&](Index v) { return number_of[static_cast<std::size_t>(v)] >= 0; };
      if (std::ranges::none_of(cells[c], is_asked)) continue;
      for_each_piece(shape_of(c), cells[c], [&](std::span<const Index> piece) {
        for (const Index v : piece) {
          if (!is_asked(v)) continue;
          for (const Index u : piece) {
            if (u != v) call(number_of[static_cast<std::size_t>(v)], u);
          }
        }
      });
    }
  };
  NeighbourRows rows;
  rows.offsets.assign(vertices.size() + 1, 0);
  for_each_neighbour([&](Index k, Index /*u*/) { ++rows.offsets[static_cast<std::size_t>(k) + 1]; });
  for (std::size_t k = 0; k < vertices.size(); ++k) rows.offsets[k + 1] += rows.offsets[k];
  rows.neighbours.resize(static_cast<std::size_t>(rows.offsets.back()));
  std::vector<Offset> next(rows.offsets.begin(), rows.offsets.end() - 1);
  for_each_neighbour([&](Index k, Index u) {
    rows.neighbours[static_cast<std::size_t>(next[static_cast<std::size_t>(k)]++)] = u;
  });
  return rows;
}

const CsrGraph& CellNeighbourhood::graph() {
  if (!graph_) graph_ = vertex_graph(cells_);
  return *graph_;
}

Order CellNeighbourhood::order_by(std::string_view method, const OrderOptions& options) {
  if (!by_curve_) return order_vertices_by_options(method, {graph(), points_}, options);
  // of the graph, only which vertices have no neighbours matters: they come last
  std::vector<Offset> offsets(static_cast<std::size_t>(size()) + 1);
  const IncidenceRef cells = cells_.incidence();
  for (Index c = 0; c < cells.size(); ++c) {
    if (cells[c].size() < 2) continue;
    for (const Index v : cells[c]) offsets[static_cast<std::size_t>(v) + 1] = 1;
  }
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  return order_graph(method, {{offsets, {}}, points_}, options);
}

bool CellNeighbourhood::is_read_forward() { return reads_forward(graph()); }

double PointNeighbourhood::span_log2(std::span<const Index> place_of) const {
  struct Sampled {
    std::uint64_t key;
    Index place;
  };
  const Lattice lattice = lattice_of(points_);
  std::vector<Sampled> sample;
  for (const Index v : sample_of(size())) {
    const auto cell = lattice.cell_of(point_at(points_, v));
    sample.push_back({hilbert_key(cell, lattice.axes(), lattice.bits()), place(place_of, v)});
  }
  if (sample.empty()) return 0;
  std::ranges::sort(sample, {}, &Sampled::place);
  std::vector<std::pair<std::uint64_t, std::size_t>> by_key;
  by_key.reserve(sample.size());
  for (std::size_t k = 0; k < sample.size(); ++k) by_key.emplace_back(sample[k].key, k);
  std::ranges::sort(by_key);
  const double each = static_cast<double>(size()) / static_cast<double>(sample.size());
  double sum = 0;
  for (std::size_t k = 0; k < by_key.size(); ++k) {
    const double away = std::abs(static_cast<double>(k) - static_cast<double>(by_key[k].second));
    sum += std::log2(1 + each * away);
  }
  return sum / static_cast<double>(sample.size());
}

double PointNeighbourhood::most_span(double fresh, double slack) const {
  return fresh + slack * std::log2(1 + static_cast<double>(size()));
}

NeighbourRows PointNeighbourhood::rows_of(std::span<const Index> vertices) const {
  return empty_rows(vertices.size());
}

Order PointNeighbourhood::order_by(std::string_view method, const OrderOptions& options) {
  // calls the method directly: for order_graph, all points would be isolated vertices
  const std::vector<Offset> offsets(points_.size() + 1);
  const VertexInput input{{offsets, {}}, points_};
  const bool by_morton = method == "morton";
  Order order = by_morton ? morton_vertices(input, options) : hilbert_vertices(input, options);
  order.method.name = by_morton ? "morton" : "hilbert";
  return order;
}

}  // namespace meshorder
