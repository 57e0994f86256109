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

/// The places in memory of a thread's additions to a vertex.
struct Additions {
  int record_bytes;  ///< bytes from the record of one vertex to the next
  int count;         ///< number of additions to adjacent numbers of the record
  int arrays;        ///< number of arrays with such additions
};

Additions additions_of(GpuLayout layout) {
  switch (layout) {
    case GpuLayout::apart:
      return {kNumberBytes, 1, 3};
    case GpuLayout::padded:
      return {4 * kNumberBytes, 1, 1};
    default:
      return {3 * kNumberBytes, 3, 1};
  }
}

/// Returns the number of sectors that a warp's threads touch when each adds one number to its vertex. A
/// sector counts t times, where t is the largest number of threads that add to the same vertex in it.
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

/// Returns the same number for all additions of a warp's threads.
Offset sectors_of_additions(std::span<const Index> ascending, const Additions& additions) {
  Offset sectors = 0;
  for (int k = 0; k < additions.count; ++k) {
    sectors += additions.arrays * sectors_of_addition(ascending, additions.record_bytes, k * kNumberBytes);
  }
  return sectors;
}

/// The vertices that the threads of a warp touch at one step.
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

/// Returns how many different numbers there are; sorts `numbers`.
Offset different(std::span<Offset> numbers) {
  if (!std::ranges::is_sorted(numbers)) std::ranges::sort(numbers);
  Offset count = numbers.empty() ? 0 : 1;
  for (std::size_t i = 1; i < numbers.size(); ++i) count += numbers[i] != numbers[i - 1] ? 1 : 0;
  return count;
}

/// Simulates the loop in which the threads of a warp read lists.
class WarpLoop {
 public:
  WarpLoop(const RecordLists& lists, int lanes) : lists_(lists), lanes_(lanes) {}

  /// Adds the `lanes` threads that read a list.
  void add(Index list) {
    const Offset begin = lists_.offsets[list];
    const Offset end = lists_.offsets[list + 1];
    for (int lane = 0; lane < lanes_; ++lane)
      threads_[size_++] = {begin + lane, std::max<Offset>(0, (end - begin - lane + lanes_ - 1) / lanes_)};
  }

  /// Runs the loop to its end, and forgets the threads.
  ListLoads run() {
    loads_ = {};
    for (Thread& thread : threads()) thread.first = thread.left % kUnrolled;
    for (Offset step = 0; step + 1 < kUnrolled; ++step)
      read(1, [step](const Thread& thread) { return thread.first > step; });
    while (read(4 * kUnrolled, [](const Thread& thread) { return thread.left > 3 * kUnrolled; })) {
    }
    read(2 * kUnrolled, [](const Thread& thread) { return thread.left > kUnrolled; });
    read(kUnrolled, [](const Thread& thread) { return thread.left > 0; });
    size_ = 0;
    return loads_;
  }

 private:
  static constexpr Offset kUnrolled = 4;

  struct Thread {
    Offset next = 0;   ///< index of the next entry
    Offset left = 0;   ///< number of entries not yet read
    Offset first = 0;  ///< number of entries to read one by one at the beginning
  };

  std::span<Thread> threads() { return std::span(threads_).first(size_); }

  /// Lets each thread for which `takes_part` is true read `steps` entries, one at a step. Returns whether
  /// there is such a thread.
  template <class TakesPart>
  bool read(Offset steps, TakesPart takes_part) {
    std::array<Thread*, kWarp> active{};
    std::size_t count = 0;
    for (Thread& thread : threads())
      if (takes_part(thread)) active[count++] = &thread;
    if (count == 0) return false;
    std::array<Offset, kWarp> of_lists{};
    std::array<Offset, kWarp> of_records{};
    const Offset records_in_sector = kSectorBytes / lists_.record_bytes;
    for (Offset step = 0; step < steps; ++step) {
      for (std::size_t i = 0; i < count; ++i) {
        Thread& thread = *active[i];
        of_lists[i] = thread.next * kNumberBytes / kSectorBytes;
        of_records[i] = lists_.record(thread.next) / records_in_sector;
        thread.next += lanes_;
        --thread.left;
      }
      loads_ +=
          {1, different(std::span(of_lists).first(count)), different(std::span(of_records).first(count))};
    }
    return true;
  }

  const RecordLists& lists_;
  Offset lanes_;
  std::array<Thread, kWarp> threads_{};
  std::size_t size_ = 0;
  ListLoads loads_;
};

/// Divides `size` threads into warps and calls `count(begin, end)` for the threads of every stride-th warp;
/// returns the sum of the results.
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

GpuCost additions_to(std::span<const Index> ascending, GpuLayout layout) {
  const Additions additions = additions_of(layout);
  GpuCost cost;
  for (std::size_t begin = 0; begin < ascending.size(); begin += kWarp) {
    const auto warp = ascending.subspan(begin, std::min<std::size_t>(kWarp, ascending.size() - begin));
    cost.sectors += sectors_of_additions(warp, additions);
    cost.requests += Offset{additions.count} * additions.arrays;
  }
  return cost;
}

ListLoads& ListLoads::operator+=(const ListLoads& other) {
  requests += other.requests;
  lists += other.lists;
  records += other.records;
  return *this;
}

ListLoads loads_of_lists(const RecordLists& lists, int lanes) {
  const auto count = static_cast<Index>(lists.offsets.size() - 1);
  const Index lists_in_warp = kWarp / lanes;
  return sum_over_chunks<ListLoads>(count, lists_in_warp * kWarpsInChunk, [&](Index begin, Index end) {
    ListLoads loads;
    WarpLoop warp(lists, lanes);
    for (Index list = begin; list < end; ++list) {
      warp.add(list);
      if ((list + 1) % lists_in_warp == 0 || list + 1 == end) loads += warp.run();
    }
    return loads;
  });
}

Offset sectors_of_product(GraphRef graph, const Permutation& order, Index stride) {
  return sum_over_warps(graph.size(), stride, [&](Index begin, Index end) {
    std::vector<Index> columns;  // columns of the warp's rows, ascending in each row
    std::array<Offset, kWarp + 1> offsets{};
    for (Index place = begin; place < end; ++place) {
      const auto first = static_cast<std::ptrdiff_t>(columns.size());
      columns.push_back(place);
      for (const Index u : graph[order.new_to_old()[place]]) columns.push_back(order.old_to_new()[u]);
      std::sort(columns.begin() + first, columns.end());
      offsets[place - begin + 1] = std::ssize(columns);
    }
    const auto rows = static_cast<std::size_t>(end - begin);
    return loads_of_lists({.offsets = std::span(offsets).first(rows + 1), .records = columns}, 1).records;
  });
}

}  // namespace meshorder
