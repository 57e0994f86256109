// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells/warp_sectors.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

constexpr int kSectorBytes = 32;
constexpr int kNumberBytes = 4;
constexpr Index kWarpsInChunk = 512;

/// How the additions of a thread to a vertex lie in memory.
struct Additions {
  int record_bytes;  ///< distance from one vertex to the next
  int count;         ///< number of additions, one after another in the record
  int arrays;        ///< number of arrays that have these additions
};

Additions additions_of(GpuLayout layout) {
  switch (layout) {
    case GpuLayout::packed:
      return {3 * kNumberBytes, 3, 1};
    case GpuLayout::apart:
      return {kNumberBytes, 1, 3};
    default:
      return {4 * kNumberBytes, 1, 1};
  }
}

/// Returns the sectors of one addition to ascending vertices: per sector, the most threads at one vertex.
Offset sectors_of_addition(std::span<const Index> ascending, int record_bytes, int first_byte) {
  Offset sectors = 0;
  Offset sector = -1;
  Offset most = 0;
  for (std::size_t i = 0; i < ascending.size();) {
    std::size_t end = i;
    while (end < ascending.size() && ascending[end] == ascending[i]) ++end;
    const Offset at = (Offset{ascending[i]} * record_bytes + first_byte) / kSectorBytes;
    if (at != sector) {
      sectors += most;
      sector = at;
      most = 0;
    }
    most = std::max(most, static_cast<Offset>(end - i));
    i = end;
  }
  return sectors + most;
}

/// Returns the same for all additions to a vertex.
Offset sectors_of_additions(std::span<const Index> ascending, const Additions& additions) {
  Offset sectors = 0;
  for (int k = 0; k < additions.count; ++k) {
    sectors += additions.arrays * sectors_of_addition(ascending, additions.record_bytes, k * kNumberBytes);
  }
  return sectors;
}

/// The vertices or sectors that the threads of a warp touch at one step.
class Touched {
 public:
  void clear() { size_ = 0; }
  void add(Index vertex) { vertices_[size_++] = vertex; }
  [[nodiscard]] std::span<const Index> ascending() {
    const auto touched = std::span(vertices_).first(size_);
    std::ranges::sort(touched);
    return touched;
  }

 private:
  std::array<Index, kWarp> vertices_{};
  std::size_t size_ = 0;
};

/// Calls `count(begin, end)` for the places of every stride-th warp of `size` threads; returns the sum.
template <class Count>
Offset sum_over_warps(Index size, Index stride, const Count& count) {
  const Index looked_at = chunk_count(chunk_count(size, kWarp), stride);
  return sum_over_chunks<Offset>(looked_at, kWarpsInChunk, [&](Index first, Index last) {
    Offset part = 0;
    for (Index k = first; k < last; ++k) {
      const Offset begin = Offset{k} * stride * kWarp;
      part += count(static_cast<Index>(begin), static_cast<Index>(std::min<Offset>(begin + kWarp, size)));
    }
    return part;
  });
}

Index at(std::span<const Index> numbers, Index place) { return numbers.empty() ? place : numbers[place]; }

}  // namespace

Offset sectors_of_additions(const ElementOrder& order, GpuLayout layout, Index stride) {
  const Additions additions = additions_of(layout);
  return sum_over_warps(order.elements.size(), stride, [&](Index begin, Index end) {
    Offset sectors = 0;
    Touched touched;
    std::size_t most_corners = 1;
    for (std::size_t corner = 0; corner < most_corners; ++corner) {
      touched.clear();
      for (Index place = begin; place < end; ++place) {
        const std::span<const Index> corners = order.elements[at(order.new_to_old, place)];
        most_corners = std::max(most_corners, corners.size());
        if (corner < corners.size()) touched.add(at(order.vertex_old_to_new, corners[corner]));
      }
      sectors += sectors_of_additions(touched.ascending(), additions);
    }
    return sectors;
  });
}

GpuCost requests_and_floor(Index elements, int width, GpuLayout layout) {
  const Additions additions = additions_of(layout);
  std::array<Index, kWarp> side_by_side{};
  std::iota(side_by_side.begin(), side_by_side.end(), Index{0});
  const auto floor_of = [&](Index threads) {
    return sectors_of_additions(std::span(side_by_side).first(static_cast<std::size_t>(threads)), additions);
  };
  return {.requests = Offset{width} * additions.count * additions.arrays * chunk_count(elements, kWarp),
          .floor = width * (elements / kWarp * floor_of(kWarp) + floor_of(elements % kWarp))};
}

Offset sectors_of_product(GraphRef graph, const Permutation& order, Index stride) {
  return sum_over_warps(graph.size(), stride, [&](Index begin, Index end) {
    std::array<std::vector<Index>, kWarp> columns;  // of each row, ascending
    std::size_t longest = 0;
    for (Index place = begin; place < end; ++place) {
      std::vector<Index>& row = columns[place - begin];
      for (const Index u : graph[order.new_to_old()[place]]) row.push_back(order.old_to_new()[u]);
      std::ranges::sort(row);
      longest = std::max(longest, row.size());
    }
    Offset sectors = 0;
    Touched touched;
    for (std::size_t step = 0; step < longest; ++step) {
      touched.clear();
      for (const std::vector<Index>& row : columns) {
        if (step < row.size()) touched.add(row[step] / (kSectorBytes / kNumberBytes));
      }
      const std::span<const Index> ascending = touched.ascending();
      sectors += 1;
      for (std::size_t i = 1; i < ascending.size(); ++i) sectors += ascending[i] != ascending[i - 1] ? 1 : 0;
    }
    return sectors;
  });
}

}  // namespace meshorder
