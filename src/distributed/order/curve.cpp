// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/curve.hpp"

#include "distributed/comm/halo.hpp"
#include "distributed/comm/sample_sort.hpp"
#include "ordering/space_filling.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>

namespace meshorder::distributed {
namespace {

/// Key of unused vertices, larger than the keys of used ones.
constexpr std::uint64_t kUnused = std::numeric_limits<std::uint64_t>::max();

/// Returns the lattice on the box around the used points of all ranks.
Lattice lattice_of(const Communicator& communicator, const std::vector<Point>& points,
                   const std::vector<char>& used) {
  Box box;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (used[v] != 0) box += Box{points[v], points[v]};
  }
  Box of_all;
  for (const Box& other : communicator.gathered(box)) of_all += other;
  return {of_all.low, of_all.high};
}

/// Returns the sum of a count over the ranks before this one.
GlobalIndex before_this_rank(const Communicator& communicator, std::size_t count) {
  const std::vector<std::size_t> counts = communicator.gathered(count);
  return std::accumulate(counts.begin(), counts.begin() + communicator.rank(), GlobalIndex{0},
                         [](GlobalIndex sum, std::size_t n) { return sum + static_cast<GlobalIndex>(n); });
}

}  // namespace

Curve along_hilbert_curve(const Communicator& communicator, const Layout& vertices,
                          const std::vector<Point>& points, const std::vector<char>& used) {
  const Lattice lattice = lattice_of(communicator, points, used);
  std::vector<SortEntry> entries = communicator.together([&] {
    std::vector<SortEntry> result;
    result.reserve(points.size());
    GlobalIndex vertex = vertices.begin(communicator.rank());
    for (std::size_t v = 0; v < points.size(); ++v, ++vertex) {
      const std::uint64_t key =
          used[v] != 0 ? hilbert_key(lattice.cell_of(points[v]), lattice.axes(), lattice.bits()) : kUnused;
      result.push_back({key, vertex});
    }
    return result;
  });
  entries = sample_sorted(communicator, std::move(entries));

  // a vertex's number is its position in the sorted sequence
  const GlobalIndex first = before_this_rank(communicator, entries.size());
  std::vector<GlobalIndex> in_file;
  std::vector<GlobalIndex> numbers;
  communicator.together([&] {
    numbers.resize(entries.size());
    std::iota(numbers.begin(), numbers.end(), first);
    in_file.reserve(entries.size());
    for (const SortEntry& entry : entries) in_file.push_back(entry.number);
  });
  Curve curve;
  curve.number_of = delivered<GlobalIndex>(communicator, vertices, in_file, numbers, 0);

  // send the used vertices to the owners of their numbers
  struct Vertex {
    GlobalIndex number_in_file;
    Point point;
  };
  std::vector<Vertex> records;
  communicator.together([&] {
    numbers.clear();
    GlobalIndex vertex = vertices.begin(communicator.rank());
    for (std::size_t v = 0; v < points.size(); ++v, ++vertex) {
      if (used[v] == 0) continue;
      numbers.push_back(curve.number_of[v]);
      records.push_back({vertex, points[v]});
    }
  });
  const auto own_count = static_cast<GlobalIndex>(records.size());
  curve.layout = Layout::even(communicator.sum(own_count), communicator.size());
  const std::vector<Vertex> own = delivered<Vertex>(communicator, curve.layout, numbers, records, Vertex{});
  communicator.together([&] {
    for (const Vertex& vertex : own) {
      curve.number_in_file.push_back(vertex.number_in_file);
      curve.points.push_back(vertex.point);
    }
  });
  return curve;
}

}  // namespace meshorder::distributed
