// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/plain_bench.hpp"

#include "base/parallel.hpp"
#include "base/point.hpp"
#include "kernels/owned_batches.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>

namespace meshorder {
namespace {

/// A kernel that runs in stretches computes one in `kEvery` elements.
constexpr std::size_t kEvery = 8;

/// Calls `run(elements)` for all elements; if `in_stretches`, for 16 stretches that start at equal distances.
/// A stretch is long, so what it finds in the caches at its start does not matter.
template <class Run>
void for_stretches(std::span<const Index> elements, std::size_t corners, bool in_stretches, Run run) {
  constexpr std::size_t kStretches = 16;
  if (!in_stretches) return run(elements);
  const std::size_t count = elements.size() / corners;
  for (std::size_t i = 0; i < kStretches; ++i) {
    run(elements.subspan(corners * (i * count / kStretches), corners * (count / (kStretches * kEvery))));
  }
}

/// Calls `keep(first)` for each group of `size` vertices that has an owned vertex; `first` is the place of
/// the group's first vertex.
template <class Keep>
void for_each_owned(std::span<const Index> vertices, std::size_t size, const plain::VertexRange& owned,
                    Keep keep) {
  for (std::size_t first = 0; first + size <= vertices.size(); first += size) {
    const auto group = vertices.subspan(first, size);
    if (std::any_of(group.begin(), group.end(), [&](Index v) { return owned.has(v); })) keep(first);
  }
}

std::vector<double> coordinates(std::span<const Point> points) {
  std::vector<double> result;
  result.reserve(3 * points.size());
  for (const Point& point : points) result.insert(result.end(), point.begin(), point.end());
  return result;
}

}  // namespace

PlainBench::PlainBench(const KernelInput& input) : corners_(input.simplices().dimension + 1) {
  const std::array prepare{&PlainBench::prepare_matrix, &PlainBench::prepare_edges,
                           &PlainBench::prepare_vertices};
  take_turns(index_size(prepare), [&](Index turn) { (this->*prepare[turn])(input); });
}

void PlainBench::prepare_matrix(const KernelInput& input) {
  const CsrGraph& graph = input.graph();
  starts_.reserve(static_cast<std::size_t>(graph.size()) + 1);
  columns_.reserve(graph.neighbours.size() + static_cast<std::size_t>(graph.size()));
  starts_.push_back(0);
  for (Index v = 0; v < graph.size(); ++v) {
    const std::span<const Index> row = graph[v];
    const auto larger = std::upper_bound(row.begin(), row.end(), v);
    columns_.insert(columns_.end(), row.begin(), larger);
    columns_.push_back(v);
    columns_.insert(columns_.end(), larger, row.end());
    starts_.push_back(static_cast<Offset>(columns_.size()));
  }
  values_.resize(columns_.size());
}

void PlainBench::prepare_edges(const KernelInput& input) {
  const CsrGraph& graph = input.graph();
  const std::span<const Point> points = input.points();
  all_.ends.reserve(graph.neighbours.size());
  all_.lengths.reserve(graph.neighbours.size() / 2);
  for (Index v = 0; v < graph.size(); ++v) {
    const std::span<const Index> row = graph[v];
    for (auto u = std::upper_bound(row.begin(), row.end(), v); u != row.end(); ++u) {
      all_.ends.insert(all_.ends.end(), {v, *u});
      all_.lengths.push_back(norm(minus(points[*u], points[v])));
    }
  }
}

void PlainBench::prepare_vertices(const KernelInput& input) {
  const std::span<const Point> points = input.points();
  const std::span<const Index> simplices = input.simplices().vertices;
  all_.owned = {0, index_size(points)};
  if (corners_ > 1) all_.simplices.assign(simplices.begin(), simplices.end());
  positions_ = coordinates(displaced(points));
  forces_.resize(positions_.size());
  x_.reserve(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) x_.push_back(positions_[3 * v] - points[v][0]);
  y_.resize(x_.size());
}

void PlainBench::share(int threads) {
  shares_.clear();
  if (threads < 2) return;
  const std::vector<Index> bounds = balanced_ranges(starts_, threads);
  shares_.resize(static_cast<std::size_t>(threads));
  for_each_chunk(threads, 1, [&](Index part, Index /*begin*/, Index /*end*/) {
    Share& share = shares_[part];
    share.owned = {bounds[part], bounds[part + 1]};
    for_each_owned(all_.simplices, static_cast<std::size_t>(corners_), share.owned, [&](std::size_t first) {
      const auto simplex = all_.simplices.begin() + static_cast<std::ptrdiff_t>(first);
      share.simplices.insert(share.simplices.end(), simplex, simplex + corners_);
    });
    for_each_owned(all_.ends, 2, share.owned, [&](std::size_t first) {
      share.ends.insert(share.ends.end(), {all_.ends[first], all_.ends[first + 1]});
      share.lengths.push_back(all_.lengths[first / 2]);
    });
  });
}

template <class Owned>
void PlainBench::run_part(Kernel kernel, const Owned& owned, const Share& share, bool in_stretches) {
  const auto begin = static_cast<std::size_t>(share.owned.begin);
  const auto count = static_cast<std::size_t>(share.owned.end) - begin;
  const plain::Matrix<double, Index, Offset> matrix{starts_, columns_, values_};
  const auto clear = [&](std::vector<double>& values, Offset first, Offset last) {
    const Offset size = in_stretches ? (last - first) / static_cast<Offset>(kEvery) : last - first;
    std::fill_n(values.begin() + first, size, 0.0);
  };
  // calls `call` with the number of corners of a simplex as a compile-time constant, and with elements
  const auto by_corners = [&](auto call) {
    for_stretches(share.simplices, static_cast<std::size_t>(corners_), in_stretches,
                  [&](std::span<const Index> elements) {
                    if (corners_ == 4) call(std::integral_constant<int, 4>{}, elements);
                    if (corners_ == 3) call(std::integral_constant<int, 3>{}, elements);
                    if (corners_ == 2) call(std::integral_constant<int, 2>{}, elements);
                  });
  };
  switch (kernel) {
    case Kernel::spmv:
      plain::multiply(plain::Matrix<double, Index, Offset>{matrix.starts.subspan(begin), columns_, values_},
                      std::span<const double>(x_), std::span(y_).subspan(begin, count));
      return;
    case Kernel::element:
      clear(forces_, Offset{3} * share.owned.begin, Offset{3} * share.owned.end);
      by_corners([&](auto corners, std::span<const Index> elements) {
        plain::press<corners>(elements, positions_, forces_, owned);
      });
      return;
    case Kernel::assembly:
      clear(values_, starts_[begin], starts_[begin + count]);
      by_corners([&](auto corners, std::span<const Index> elements) {
        plain::assemble<corners>(elements, positions_, matrix, owned);
      });
      return;
    case Kernel::springs:
      clear(forces_, Offset{3} * share.owned.begin, Offset{3} * share.owned.end);
      plain::springs(share.ends, std::span<const double>(share.lengths), std::span<const double>(positions_),
                     std::span(forces_), owned);
      return;
  }
}

void PlainBench::run_parts(Kernel kernel, bool in_stretches) {
  if (shares_.empty()) return run_part(kernel, plain::AllVertices{}, all_, in_stretches);
  for_each_part(index_size(shares_),
                [&](Index part) { run_part(kernel, shares_[part].owned, shares_[part], in_stretches); });
}

void PlainBench::compute(Kernel kernel) { run_parts(kernel, false); }

double PlainBench::compute_stretches(Kernel kernel) {
  constexpr std::size_t kFewest = 1'000'000;  // elements whose data are far more than the caches hold
  const bool has_elements = kernel == Kernel::element || kernel == Kernel::assembly;
  if (!has_elements || all_.simplices.size() < kFewest * static_cast<std::size_t>(corners_)) return 0;
  run_parts(kernel, true);
  return 1.0 / kEvery;
}

std::span<const double> PlainBench::result(Kernel kernel) const {
  if (kernel == Kernel::spmv) return y_;
  if (kernel == Kernel::assembly) return values_;
  return forces_;
}

double PlainBench::redundancy() const {
  if (shares_.empty() || all_.simplices.empty()) return 0.0;
  std::size_t computed = 0;
  for (const Share& share : shares_) computed += share.simplices.size();
  return static_cast<double>(computed) / static_cast<double>(all_.simplices.size()) - 1;
}

double PlainBench::streamed_bytes(Kernel kernel) const {
  // arrays that are cleared and then added to are written, read and written again
  const std::size_t vertices = bytes_of(positions_) + 3 * bytes_of(forces_);
  std::size_t bytes = 0;
  switch (kernel) {
    case Kernel::spmv:
      bytes = bytes_of(values_) + bytes_of(columns_) + bytes_of(starts_) + bytes_of(x_) + bytes_of(y_);
      break;
    case Kernel::element:
      bytes = bytes_of(all_.simplices) + vertices;
      break;
    case Kernel::assembly:
      bytes = bytes_of(all_.simplices) + bytes_of(positions_) + bytes_of(columns_) + bytes_of(starts_) +
              3 * bytes_of(values_);
      break;
    case Kernel::springs:
      bytes = bytes_of(all_.ends) + bytes_of(all_.lengths) + vertices;
      break;
  }
  return static_cast<double>(bytes);
}

std::size_t PlainBench::bytes() const {
  std::size_t of_shares = bytes_of(all_.simplices) + bytes_of(all_.ends) + bytes_of(all_.lengths);
  for (const Share& share : shares_)
    of_shares += bytes_of(share.simplices) + bytes_of(share.ends) + bytes_of(share.lengths);
  return of_shares + bytes_of(starts_) + bytes_of(columns_) + bytes_of(values_) + bytes_of(positions_) +
         bytes_of(forces_) + bytes_of(x_) + bytes_of(y_);
}

}  // namespace meshorder
