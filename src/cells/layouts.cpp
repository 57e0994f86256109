// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "cells/cell_arrays.hpp"
#include "cells/warp_sectors.hpp"
#include <meshorder/error.hpp>
#include <meshorder/layouts.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <string>

namespace meshorder {
inline namespace v0_3 {
namespace {

constexpr Index kCellsInChunk = 1 << 14;
constexpr Index kFirstColours = 256;  ///< each vertex records which of these colours are taken

/// Calls `work(cell)` for the cells begin … end − 1, in the order of a patch. The cells are cut into 32
/// series of adjacent cells, one for each thread of a warp; warp w gets the w-th cell of each series. The
/// last warp may have fewer threads.
template <class Work>
void deal_out(Index begin, Index end, const Work& work) {
  const Index warps = chunk_count(end - begin, kWarp);
  const Index in_last = end - begin - (warps - 1) * kWarp;
  for (Index warp = 0; warp < warps; ++warp) {
    const Index threads = warp + 1 < warps ? kWarp : in_last;
    // series of threads that the last warp lacks are one cell shorter
    for (Index thread = 0; thread < threads; ++thread)
      work(begin + thread * warps - std::max(thread - in_last, 0) + warp);
  }
}

/// The colours that the cells at a vertex have.
class ColoursAtVertex {
 public:
  void take(Index colour) {
    if (colour < kFirstColours) {
      taken_[colour / kBits] |= std::uint64_t{1} << (colour % kBits);
    } else {
      next_ = colour + 1;
    }
  }
  ColoursAtVertex& operator+=(const ColoursAtVertex& other) {
    for (std::size_t word = 0; word < taken_.size(); ++word) taken_[word] |= other.taken_[word];
    next_ = std::max(next_, other.next_);
    return *this;
  }
  [[nodiscard]] Index first_free() const {
    const auto word = std::ranges::find_if(taken_, [](std::uint64_t bits) { return ~bits != 0; });
    if (word == taken_.end()) return next_;
    return static_cast<Index>((word - taken_.begin()) * kBits + std::countr_one(*word));
  }

 private:
  static constexpr Index kBits = 64;

  std::array<std::uint64_t, kFirstColours / kBits> taken_{};
  Index next_ = kFirstColours;  ///< the first colour after all taken ones; ≥ kFirstColours
};

/// Finds the vertices of patches and their local numbers.
class PatchCutter {
 public:
  PatchCutter(const CellArrays& cells, Patches& patches)
      : cells_(cells), patches_(patches), local_of_(static_cast<std::size_t>(cells.vertex_count)) {}

  /// Writes the cells and local numbers of a patch, and appends its vertices.
  void cut(Index patch, std::vector<Index>& vertices) {
    const Index begin = patch * patches_.size;
    const auto end =
        static_cast<Index>(std::min(Offset{begin} + patches_.size, static_cast<Offset>(cells_.size())));
    const std::span<const Index> all =
        cells_.vertices.subspan(static_cast<std::size_t>(cells_.offsets[begin]),
                                static_cast<std::size_t>(cells_.offsets[end] - cells_.offsets[begin]));
    const std::size_t first = vertices.size();
    for (const Index v : all) {
      if (local_of_[v] == kTaken) continue;
      local_of_[v] = kTaken;
      vertices.push_back(v);
    }
    const auto own = std::span(vertices).subspan(first);
    std::ranges::sort(own);
    for (std::size_t i = 0; i < own.size(); ++i) local_of_[own[i]] = static_cast<std::uint16_t>(i);
    Index* cell_out = patches_.cells.data() + begin;
    std::uint16_t* out = patches_.local.data() + Offset{begin} * patches_.corners_per_cell;
    deal_out(begin, end, [&](Index cell) {
      *cell_out++ = cell;
      for (const Index v : cells_.incidence()[cell]) *out++ = local_of_[v];
    });
    for (const Index v : own) local_of_[v] = 0;
  }

 private:
  static constexpr std::uint16_t kTaken = std::numeric_limits<std::uint16_t>::max();

  const CellArrays& cells_;
  Patches& patches_;
  std::vector<std::uint16_t> local_of_;  ///< for the vertices of the patch: `kTaken`, then the local number
};

}  // namespace

Patches patches(const CellsView& cells, std::size_t vertex_count, int size, const Run& run) {
  return in_call(run, [&] {
    const CellArrays arrays = cell_arrays(cells, vertex_count, Check::full);
    const int width = uniform_width(arrays, "patches");
    const int most = std::numeric_limits<std::uint16_t>::max() / std::max(width, 1);
    if (most < 2) {
      throw InvalidArgument("patches: cells of " + std::to_string(width) +
                            " vertices are too large: a patch must hold two");
    }
    if (size < 2 || size > most) {
      throw InvalidArgument("patches: " + std::to_string(size) + " cells each; give 2 to " +
                            std::to_string(most) + ", so that local numbers fit 16 bits");
    }
    Patches result{.size = size, .corners_per_cell = width};
    result.cells.resize(static_cast<std::size_t>(arrays.size()));
    result.local.resize(arrays.vertices.size());
    const Index count = chunk_count(arrays.size(), size);
    // one part for each thread: each part needs an array of numbers for all vertices
    const Index parts = std::min(count, thread_count());
    std::vector<std::vector<Index>> vertices(static_cast<std::size_t>(parts));
    result.offsets.resize(static_cast<std::size_t>(count) + 1);
    for_each_part(parts, [&](Index part) {
      PatchCutter cutter(arrays, result);
      const auto first = static_cast<Index>(Offset{count} * part / parts);
      const auto last = static_cast<Index>(Offset{count} * (part + 1) / parts);
      for (Index patch = first; patch < last; ++patch) {
        const std::size_t before = vertices[part].size();
        cutter.cut(patch, vertices[part]);
        result.offsets[patch + 1] = static_cast<Offset>(vertices[part].size() - before);
      }
    });
    std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
    result.vertices.reserve(static_cast<std::size_t>(result.offsets.back()));
    for (const std::vector<Index>& part : vertices)
      result.vertices.insert(result.vertices.end(), part.begin(), part.end());
    return result;
  });
}

GatherLists gather_lists(const CellsView& cells, std::size_t vertex_count, const Run& run) {
  return in_call(run, [&] {
    const CellArrays arrays = cell_arrays(cells, vertex_count, Check::full);
    GatherLists lists;
    lists.offsets.resize(static_cast<std::size_t>(arrays.vertex_count) + 1);
    for (const Index v : arrays.vertices) ++lists.offsets[v + 1];
    std::partial_sum(lists.offsets.begin(), lists.offsets.end(), lists.offsets.begin());
    lists.cells.resize(arrays.vertices.size());
    lists.corners.resize(arrays.vertices.size());
    // calling `transposed` and then searching each vertex in its cells would take three times as long
    std::vector<Offset> next(lists.offsets.begin(), lists.offsets.end() - 1);
    for (Index c = 0; c < arrays.size(); ++c) {
      const std::span<const Index> corners = arrays.incidence()[c];
      if (corners.size() > std::numeric_limits<std::uint8_t>::max() + 1U) {
        throw InvalidArgument("gather_lists: cell " + std::to_string(c) + " has " +
                              std::to_string(corners.size()) + " vertices, more than 256");
      }
      for (std::size_t a = 0; a < corners.size(); ++a) {
        const Offset at = next[corners[a]]++;
        lists.cells[at] = c;
        lists.corners[at] = static_cast<std::uint8_t>(a);
      }
    }
    return lists;
  });
}

Colours colours(const CellsView& cells, std::size_t vertex_count, const Run& run) {
  return in_call(run, [&] {
    const CellArrays arrays = cell_arrays(cells, vertex_count, Check::full);
    const IncidenceRef incidence = arrays.incidence();
    std::vector<ColoursAtVertex> at(static_cast<std::size_t>(arrays.vertex_count));
    std::vector<Index> colour_of(static_cast<std::size_t>(arrays.size()));
    Colours result;
    for (Index c = 0; c < arrays.size(); ++c) {
      ColoursAtVertex all;
      for (const Index v : incidence[c]) all += at[v];
      const Index colour = all.first_free();
      for (const Index v : incidence[c]) at[v].take(colour);
      colour_of[c] = colour;
      const std::size_t needed = static_cast<std::size_t>(colour) + 2;
      if (needed > result.starts.size()) result.starts.resize(needed);
      ++result.starts[colour + 1];
    }
    std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
    std::vector<Index> next(result.starts.begin(), result.starts.end() - 1);
    result.cells.resize(colour_of.size());
    for (Index c = 0; c < arrays.size(); ++c) result.cells[next[colour_of[c]]++] = c;
    return result;
  });
}

std::vector<Index> sort_corners(const CellsView& cells, std::size_t vertex_count, const Run& run) {
  return in_call(run, [&] {
    const CellArrays arrays = cell_arrays(cells, vertex_count, Check::full);
    const int width = uniform_width(arrays, "sort_corners");
    const Shape shape = arrays.shapes.empty() ? Shape::vertex : arrays.shapes[0];
    const bool are_triangles = shape == Shape::triangle && width == 3;
    const bool are_tetrahedra = shape == Shape::tetrahedron && width == 4;
    if (arrays.size() > 0 && !are_triangles && !are_tetrahedra) {
      throw InvalidArgument(
          "sort_corners: the cells are neither triangles nor tetrahedra with "
          "vertices at their corners alone");
    }
    std::vector<Index> sorted(arrays.vertices.begin(), arrays.vertices.end());
    for_each_chunk(arrays.size(), kCellsInChunk, [&](Index /*chunk*/, Index begin, Index end) {
      for (Index c = begin; c < end; ++c) {
        const auto corners = std::span(sorted).subspan(static_cast<std::size_t>(Offset{c} * width),
                                                       static_cast<std::size_t>(width));
        if (are_triangles) {
          std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
          continue;
        }
        bool is_odd = false;
        for (const auto& [a, b] : {std::array{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}}) {
          if (corners[a] <= corners[b]) continue;
          std::swap(corners[a], corners[b]);
          is_odd = !is_odd;
        }
        if (is_odd) std::swap(corners[2], corners[3]);
      }
    });
    return sorted;
  });
}

}  // namespace v0_3
}  // namespace meshorder
