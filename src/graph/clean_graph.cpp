// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/clean_graph.hpp"

#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "graph/csr_graph.hpp"
#include "graph/row_access.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// Sorts row v, drops its loops and merges its repeats. Returns the number of entries that remain, at the
/// front of the row.
Offset clean_row(OwnedGraph& rows, Index v, std::vector<std::pair<Index, double>>& buffer) {
  const Offset begin = rows.offsets[v];
  const Offset end = rows.offsets[v + 1];
  Index* const row = rows.neighbours.data() + begin;
  if (rows.weights.empty()) {
    Index* const kept = std::remove(row, row + (end - begin), v);
    std::sort(row, kept);
    return std::unique(row, kept) - row;
  }
  buffer.clear();
  for (Offset k = begin; k < end; ++k) {
    if (rows.neighbours[k] != v) buffer.emplace_back(rows.neighbours[k], rows.weights[k]);
  }
  std::sort(buffer.begin(), buffer.end());
  double* const weights = rows.weights.data() + begin;
  Offset kept = 0;
  for (const auto& [u, weight] : buffer) {
    if (kept > 0 && row[kept - 1] == u) {
      weights[kept - 1] += weight;
    } else {
      row[kept] = u;
      weights[kept] = weight;
      ++kept;
    }
  }
  return kept;
}

/// Cleans all rows and closes the gaps.
OwnedGraph cleaned_rows(OwnedGraph rows) {
  constexpr Index kRows = 4096;  // rows that a thread cleans at a time
  std::vector<Offset> offsets(rows.offsets.size(), 0);
  for_each_chunk(rows.size(), kRows, [&](Index /*chunk*/, Index begin, Index end) {
    std::vector<std::pair<Index, double>> buffer;
    for (Index v = begin; v < end; ++v) offsets[v + 1] = clean_row(rows, v, buffer);
  });
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  const auto close_gaps = [&](auto& entries) {
    if (entries.empty()) return;
    for (Index v = 0; v < rows.size(); ++v) {
      const auto row = entries.begin() + rows.offsets[v];
      if (offsets[v] != rows.offsets[v])
        std::copy_n(row, offsets[v + 1] - offsets[v], entries.begin() + offsets[v]);
    }
    entries.resize(static_cast<std::size_t>(offsets.back()));
  };
  close_gaps(rows.neighbours);
  close_gaps(rows.weights);
  rows.offsets = std::move(offsets);
  return rows;
}

/// Copies a graph without its loops. The rows must ascend and have no repeats.
OwnedGraph without_loops(const GraphArrays& graph) {
  constexpr Index kRows = 4096;  // rows that a thread copies at a time
  OwnedGraph copy;
  resize_large(copy.offsets, graph.offsets.size());
  const GraphRef rows(graph.offsets, graph.neighbours);
  for_each_chunk(graph.size(), kRows, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      const bool has_loop = entries_below(rows[v], v) < entries_below(rows[v], v + 1);
      copy.offsets[v + 1] = rows.degree(v) - (has_loop ? 1 : 0);
    }
  });
  std::partial_sum(copy.offsets.begin(), copy.offsets.end(), copy.offsets.begin());
  const auto copy_kept = [&](auto from, auto& to) {
    if (from.empty()) return;
    resize_large(to, static_cast<std::size_t>(copy.offsets.back()));
    for_each_chunk(graph.size(), kRows, [&](Index /*chunk*/, Index begin, Index end) {
      for (Index v = begin; v < end; ++v) {
        const auto row = from.begin() + graph.offsets[v];
        const Index below = entries_below(rows[v], v);
        const Offset after = copy.offsets[v + 1] - copy.offsets[v] - below;
        const auto kept = std::copy_n(row, below, to.begin() + copy.offsets[v]);
        std::copy_n(from.begin() + graph.offsets[v + 1] - after, after, kept);
      }
    });
  };
  copy_kept(graph.neighbours, copy.neighbours);
  copy_kept(graph.weights, copy.weights);
  return copy;
}

/// Moves the clean copy into `arrays`, which then refer to it.
void adopt(GraphArrays& arrays, OwnedGraph clean) {
  arrays.own_offsets = std::move(clean.offsets);
  arrays.own_neighbours = std::move(clean.neighbours);
  arrays.own_weights = std::move(clean.weights);
  arrays.offsets = arrays.own_offsets;
  arrays.neighbours = arrays.own_neighbours;
  arrays.weights = arrays.own_weights;
}

std::string counted(Offset count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace

OwnedGraph cleaned_copy(const GraphArrays& graph, const GraphFindings& findings) {
  if (findings.unordered == 0) return without_loops(graph);
  return cleaned_rows({{graph.offsets.begin(), graph.offsets.end()},
                       {graph.neighbours.begin(), graph.neighbours.end()},
                       {graph.weights.begin(), graph.weights.end()}});
}

OwnedGraph mirrored_copy(const GraphArrays& graph) {
  OwnedGraph rows;
  rows.offsets.assign(graph.offsets.size(), 0);
  for (Index v = 0; v < graph.size(); ++v) rows.offsets[v + 1] = graph.offsets[v + 1] - graph.offsets[v];
  for (const Index u : graph.neighbours) ++rows.offsets[u + 1];
  std::partial_sum(rows.offsets.begin(), rows.offsets.end(), rows.offsets.begin());
  rows.neighbours.resize(2 * graph.neighbours.size());
  rows.weights.resize(2 * graph.weights.size());
  std::vector<Offset> next(rows.offsets.begin(), rows.offsets.end() - 1);
  const auto add = [&](Index row, Index neighbour, Offset entry) {
    const Offset place = next[row]++;
    rows.neighbours[place] = neighbour;
    if (!graph.weights.empty()) rows.weights[place] = graph.weights[entry] / 2;
  };
  for (Index v = 0; v < graph.size(); ++v) {
    for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
      add(v, graph.neighbours[k], k);
      add(graph.neighbours[k], v, k);
    }
  }
  return cleaned_rows(std::move(rows));
}

GraphArrays clean_graph(const GraphView& graph, Check check, Symmetry symmetry) {
  const bool trusted = check == Check::none;
  GraphArrays arrays = graph_arrays(graph, trusted);
  if (trusted && symmetry == Symmetry::require) return arrays;
  // also for Check::fast: on an asymmetric graph the methods would write outside their arrays
  const GraphFindings found = examine(arrays, true);
  refuse_faults(graph, arrays, found);
  const bool mirror = found.asymmetry != 0 && (symmetry == Symmetry::mirror || check == Check::fast);
  if (found.is_clean() && !mirror) {
    if (found.asymmetry != 0) refuse_asymmetry(arrays.offsets, arrays.neighbours, arrays.weights, graph.base);
    return arrays;
  }
  const auto before = static_cast<Offset>(arrays.neighbours.size());
  OwnedGraph clean = mirror ? mirrored_copy(arrays) : cleaned_copy(arrays, found);
  if (!mirror && found.asymmetry != 0) {
    refuse_asymmetry(clean.offsets, clean.neighbours, clean.weights, graph.base);
  }
  const auto after = static_cast<Offset>(clean.neighbours.size());
  if (found.loops > 0) arrays.notes.push_back(counted(found.loops, "loop dropped", "loops dropped"));
  if (mirror) {
    arrays.notes.emplace_back("asymmetric pattern mirrored");
  } else if (const Offset repeats = before - found.loops - after; repeats > 0) {
    arrays.notes.push_back(counted(repeats, "repeated entry merged", "repeated entries merged"));
  } else if (found.unordered > 0) {
    arrays.notes.emplace_back("rows sorted");
  }
  adopt(arrays, std::move(clean));
  return arrays;
}

}  // namespace meshorder
