// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/cells.hpp"

#include "base/memory.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace meshorder {
namespace {

/// Returns whether a number occurs twice. `sorted` is working memory.
bool repeats(std::span<const Index> numbers, std::vector<Index>& sorted) {
  constexpr std::size_t kComparedInPairs = 10;
  if (numbers.size() == 4) {  // the most frequent cells of large meshes
    const Index* const n = numbers.data();
    return (n[0] == n[1]) | (n[0] == n[2]) | (n[0] == n[3]) | (n[1] == n[2]) | (n[1] == n[3]) |
           (n[2] == n[3]);
  }
  if (numbers.size() <= kComparedInPairs) {
    bool repeated = false;
    for (std::size_t i = 1; i < numbers.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) repeated |= numbers[i] == numbers[j];
    }
    return repeated;
  }
  sorted.assign(numbers.begin(), numbers.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

}  // namespace

std::vector<Index> degenerate_cells(const Cells& cells) {
  constexpr Index kCellsAtOnce = 65536;
  std::vector<std::vector<Index>> found(chunk_count(cells.size(), kCellsAtOnce));
  for_each_chunk(cells.size(), kCellsAtOnce, [&](Index chunk, Index begin, Index end) {
    std::vector<Index> sorted;
    for (Index c = begin; c < end; ++c) {
      if (repeats(cells[c], sorted)) found[chunk].push_back(c);
    }
  });
  std::vector<Index> result;
  for (const std::vector<Index>& part : found) result.insert(result.end(), part.begin(), part.end());
  return result;
}

std::string note_of_degenerate(std::int64_t count, std::int64_t first) {
  return std::to_string(count) +
         (count == 1 ? " cell names a vertex twice and is kept" : " cells name a vertex twice and are kept") +
         ": the first is cell " + std::to_string(first) + ", counted from 0";
}

void append_cells(Cells& cells, Shape shape, int nodes, Index count) {
  const Index first = cells.size();
  const Offset begin = cells.offsets.back();
  cells.shapes.resize(static_cast<std::size_t>(Offset{first} + count), shape);
  resize_large(cells.offsets, static_cast<std::size_t>(Offset{first} + count + 1));
  for (Offset c = 1; c <= count; ++c) cells.offsets[static_cast<std::size_t>(first + c)] = begin + c * nodes;
  resize_large(cells.vertices, static_cast<std::size_t>(begin + Offset{count} * nodes));
}

void trim_to_corners(Cells& cells, Index first, Index count) {
  std::array<std::size_t, kShapes> nodes{};
  const std::size_t end = static_cast<std::size_t>(first) + static_cast<std::size_t>(count);
  auto to = static_cast<std::size_t>(cells.offsets[static_cast<std::size_t>(first)]);
  for (auto c = static_cast<std::size_t>(first); c < end; ++c) {
    const auto from = static_cast<std::size_t>(cells.offsets[c]);
    std::size_t& size = nodes[static_cast<std::size_t>(cells.shapes[c])];
    if (size == 0) size = static_cast<std::size_t>(corners(cells.shapes[c], 0));
    for (std::size_t k = 0; to < from && k < size; ++k) cells.vertices[to + k] = cells.vertices[from + k];
    cells.offsets[c] = static_cast<Offset>(to);
    to += size;
  }
  cells.offsets[end] = static_cast<Offset>(to);
  cells.offsets.resize(end + 1);
  cells.shapes.resize(end);
  cells.vertices.resize(to);
}

}  // namespace meshorder
