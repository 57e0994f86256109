// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "cells/cache_windows.hpp"
#include "cells/cell_arrays.hpp"
#include "cells/warp_sectors.hpp"
#include "graph/clean_graph.hpp"
#include "graph/csr_graph.hpp"
#include <meshorder/error.hpp>
#include <meshorder/layouts.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

template <>
struct EnumNames<GpuLayout> {
  static constexpr std::string_view kind = "layout";
  static constexpr std::array names{
      std::pair{GpuLayout::packed, "packed"},     std::pair{GpuLayout::apart, "apart"},
      std::pair{GpuLayout::padded, "padded"},     std::pair{GpuLayout::patches, "patches"},
      std::pair{GpuLayout::gathered, "gathered"},
  };
};

inline namespace v0_3 {
namespace {

constexpr Offset kFloatBytes = 4;
constexpr Offset kIndexBytes = 4;
constexpr Offset kLocalBytes = 2;          // a vertex's number within its patch
constexpr Offset kPackedBytes = 12;        // three numbers side by side
constexpr Offset kContributionBytes = 16;  // a cell's contribution to a corner
constexpr Offset kSector = CacheWindows::kSectorBytes;

/// Returns the size in bytes of the offsets of n lists.
Offset bytes_of_offsets(Offset n) { return n > 0 ? kIndexBytes * (n + 1) : 0; }

Offset sectors_of(Offset bytes) { return (bytes + kSector - 1) / kSector; }

Offset checked_cache(std::size_t bytes, const char* caller) {
  if (bytes < 1) throw InvalidArgument(std::string(caller) + ": a cache of 0 bytes; give its size");
  return static_cast<Offset>(std::min<std::size_t>(bytes, std::size_t{1} << 62));
}

/// Returns the number of sectors that threads load to read the 32-bit begin and end of each of n lists.
///
/// @param lanes  threads for each list
Offset sectors_of_offsets(Offset n, Offset lanes) {
  constexpr Offset kInSector = kSector / kIndexBytes;
  Offset sectors = 0;
  for (Offset first = 0; first < n; first += kWarp / lanes) {
    const Offset last = std::min(n, first + kWarp / lanes) - 1;
    sectors += last / kInSector - first / kInSector + (last + 1) / kInSector - (first + 1) / kInSector + 2;
  }
  return sectors;
}

/// Returns a graph with each vertex added to its own row, still ascending: the pattern of a matrix with a
/// diagonal.
CsrGraph with_diagonal(GraphRef graph) {
  CsrGraph matrix;
  matrix.offsets.reserve(static_cast<std::size_t>(graph.size()) + 1);
  matrix.neighbours.reserve(graph.neighbours.size() + static_cast<std::size_t>(graph.size()));
  for (Index v = 0; v < graph.size(); ++v) {
    const std::span<const Index> row = graph[v];
    const auto above = std::ranges::lower_bound(row, v);
    matrix.neighbours.insert(matrix.neighbours.end(), row.begin(), above);
    matrix.neighbours.push_back(v);
    matrix.neighbours.insert(matrix.neighbours.end(), above, row.end());
    matrix.offsets.push_back(std::ssize(matrix.neighbours));
  }
  return matrix;
}

/// Returns the number of vertices that the cells name.
Offset used_vertices(const CellArrays& cells) {
  std::vector<char> is_used(static_cast<std::size_t>(cells.vertex_count));
  for (const Index v : cells.vertices) is_used[v] = 1;
  return std::ranges::count(is_used, 1);
}

/// Sets `dram_bytes` and `dram_floor`: a pass over cells reads a record of each corner and adds to another.
void count_bytes(GpuCost& cost, const CellArrays& cells, GpuLayout layout, Offset cache_bytes) {
  const int arrays = layout == GpuLayout::apart ? 3 : 1;
  const int record = static_cast<int>(layout == GpuLayout::apart    ? kFloatBytes
                                      : layout == GpuLayout::padded ? 4 * kFloatBytes
                                                                    : kPackedBytes);
  CacheWindows cache(Offset{cells.vertex_count} * record, 2 * arrays, cache_bytes);
  for (Index c = 0; c < cells.size(); ++c) {
    const std::span<const Index> corners = cells.incidence()[c];
    cache.stream(kIndexBytes * std::ssize(corners));
    for (const Index v : corners) cache.touch(v, record);
  }
  cost.dram_bytes = cache.bytes();
  cost.dram_floor = kIndexBytes * std::ssize(cells.vertices) +
                    2 * arrays * kSector * sectors_of(used_vertices(cells) * record);
}

/// Returns the cost of thread blocks, each of which loads the vertices of a patch and adds to them.
GpuCost cost_of(const Patches& cut, const CellArrays& cells, Offset cache_bytes) {
  GpuCost cost;
  CacheWindows cache(Offset{cells.vertex_count} * kPackedBytes, 2, cache_bytes);
  for (std::size_t patch = 0; patch < cut.count(); ++patch) {
    const std::span<const Index> own = cut.vertices_of(patch);
    const GpuCost additions = additions_to(own, GpuLayout::packed);
    cost.requests += additions.requests;
    cost.sectors += additions.sectors;
    cache.stream(kIndexBytes * std::ssize(own));
    for (const Index v : own) cache.touch(v, kPackedBytes);
  }
  const Offset used = used_vertices(cells);
  const Offset local = kLocalBytes * std::ssize(cut.local);
  cost.floor = requests_and_floor(static_cast<Index>(used), 1, GpuLayout::packed).floor;
  cost.dram_bytes = cache.bytes() + local;
  cost.dram_floor = kIndexBytes * used + local + 2 * kSector * sectors_of(kPackedBytes * used);
  return cost;
}

/// Returns the cost of storing the contributions of cells to their corners, and of summing them for each
/// vertex.
GpuCost cost_of(const GatherLists& lists, const CellArrays& cells, int width, Offset cache_bytes) {
  const Offset entries = std::ssize(cells.vertices);
  const Offset n = cells.vertex_count;
  const RecordLists named{.offsets = lists.offsets,
                          .records = {},
                          .record_bytes = kContributionBytes,
                          .cells = lists.cells,
                          .corners = lists.corners,
                          .width = width};
  const ListLoads loads = loads_of_lists(named, 1);
  const Offset warps = chunk_count(cells.vertex_count, kWarp);
  GpuCost cost;
  const Offset stored = sectors_of(kContributionBytes * entries);
  cost.requests = Offset{width} * chunk_count(cells.size(), kWarp) + 2 * (warps + loads.requests);
  cost.sectors = stored + sectors_of_offsets(n, 1) + loads.lists + loads.records;
  cost.floor = 2 * stored + sectors_of_offsets(n, 1) + sectors_of(kIndexBytes * entries);

  CacheWindows first(n * kPackedBytes, 1, cache_bytes);
  for (Index c = 0; c < cells.size(); ++c) {
    first.stream((kIndexBytes + kContributionBytes) * width);
    for (const Index v : cells.incidence()[c]) first.touch(v, kPackedBytes);
  }
  CacheWindows second(entries * kContributionBytes, 1, cache_bytes);
  for (Offset entry = 0; entry < entries; ++entry) {
    second.stream(kIndexBytes);
    second.touch(named.record(entry), kContributionBytes);
  }
  const Offset written = kContributionBytes * entries;  // written, not read
  cost.dram_bytes = first.bytes() - written + second.bytes() + bytes_of_offsets(n);
  cost.dram_floor = 2 * kIndexBytes * entries + kSector * sectors_of(used_vertices(cells) * kPackedBytes) +
                    kSector * stored + bytes_of_offsets(n);
  return cost;
}

}  // namespace

std::string_view to_string(GpuLayout layout) { return to_string<GpuLayout>(layout); }
GpuLayout parse_gpu_layout(std::string_view name) { return parse<GpuLayout>(name); }

GpuCost gpu_cost(const CellsView& cells, std::size_t vertex_count, GpuLayout layout, std::size_t cache_bytes,
                 const Run& run) {
  return in_call(run, [&] {
    const Offset cache = checked_cache(cache_bytes, "gpu_cost");
    const CellArrays arrays = cell_arrays(cells, vertex_count, Check::full);
    const int width = uniform_width(arrays, "gpu_cost");
    if (layout == GpuLayout::patches) return cost_of(patches(cells, vertex_count), arrays, cache);
    if (layout == GpuLayout::gathered) {
      return cost_of(gather_lists(cells, vertex_count), arrays, width, cache);
    }
    GpuCost cost = requests_and_floor(arrays.size(), width, layout);
    cost.sectors = sectors_of_additions({.elements = arrays.incidence()}, layout);
    count_bytes(cost, arrays, layout, cache);
    return cost;
  });
}

GpuCost gpu_product_cost(const GraphView& graph, int lanes, std::size_t cache_bytes, const Run& run) {
  return in_call(run, [&] {
    const Offset cache_size = checked_cache(cache_bytes, "gpu_product_cost");
    if (lanes < 1 || lanes > kWarp || !std::has_single_bit(static_cast<unsigned>(lanes))) {
      throw InvalidArgument("gpu_product_cost: " + std::to_string(lanes) +
                            " threads of a row; give 1, 2, 4, 8, 16 or 32");
    }
    const GraphArrays clean = clean_graph(graph, Check::full, Symmetry::require);
    const CsrGraph matrix = with_diagonal(GraphRef(clean.offsets, clean.neighbours));
    const Offset entries = std::ssize(matrix.neighbours);
    const Offset n = matrix.size();
    const ListLoads loads = loads_of_lists({.offsets = matrix.offsets, .records = matrix.neighbours}, lanes);

    GpuCost cost;
    cost.requests = 2 * chunk_count(matrix.size(), kWarp / lanes) + 3 * loads.requests;
    cost.sectors = sectors_of_offsets(n, lanes) + 2 * loads.lists + loads.records;
    cost.floor = sectors_of_offsets(n, lanes) + 3 * sectors_of(kFloatBytes * entries);
    CacheWindows cache(n * kFloatBytes, 1, cache_size);
    for (const Index column : matrix.neighbours) {
      cache.stream(kIndexBytes + kFloatBytes);
      cache.touch(column, kFloatBytes);
    }
    const Offset offsets = bytes_of_offsets(n);
    cost.dram_bytes = cache.bytes() + offsets;
    cost.dram_floor = (kIndexBytes + kFloatBytes) * entries + offsets + kSector * sectors_of(n * kFloatBytes);
    return cost;
  });
}

}  // namespace v0_3
}  // namespace meshorder
