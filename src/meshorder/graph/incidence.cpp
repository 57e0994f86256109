// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/parallel.hpp>
#include <meshorder/graph/incidence.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <numeric>

namespace meshorder {

Incidence transposed(const Incidence& incidence) {
  Incidence result;
  result.vertex_count = incidence.size();
  result.offsets.assign(Offset{incidence.vertex_count} + 1, 0);
  for (const Index v : incidence.vertices) ++result.offsets[v + 1];
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.vertices.resize(incidence.vertices.size());
  std::vector<Offset> next(result.offsets.begin(), result.offsets.end() - 1);
  for (Index e = 0; e < incidence.size(); ++e) {
    for (const Index v : incidence[e]) result.vertices[next[v]++] = e;
  }
  return result;
}

CsrGraph vertex_graph(const Incidence& elements) {
  constexpr Index kChunk = 4096;  // vertices; a few hundred kB of rows
  const Incidence at_vertex = transposed(elements);
  const Index n = elements.vertex_count;
  CsrGraph graph;
  graph.offsets.assign(Offset{n} + 1, 0);

  // rows of each chunk, one after another; offsets[v + 1] holds the degree of v for now
  std::vector<std::vector<Index>> rows((Offset{n} + kChunk - 1) / kChunk);
  // seen_by[u] == v: u already stands in the row of v
  tbb::enumerable_thread_specific<std::vector<Index>> marks([n] { return std::vector<Index>(n, -1); });
  for_each_chunk(n, kChunk, [&](Index chunk, Index begin, Index end) {
    std::vector<Index>& seen_by = marks.local();
    std::vector<Index>& found = rows[chunk];
    for (Index v = begin; v < end; ++v) {
      const auto row = static_cast<Offset>(found.size());
      seen_by[v] = v;
      for (const Index e : at_vertex[v]) {
        for (const Index u : elements[e]) {
          if (seen_by[u] == v) continue;
          seen_by[u] = v;
          found.push_back(u);
        }
      }
      std::sort(found.begin() + row, found.end());
      graph.offsets[v + 1] = static_cast<Offset>(found.size()) - row;
    }
  });

  std::partial_sum(graph.offsets.begin(), graph.offsets.end(), graph.offsets.begin());
  graph.neighbours.resize(graph.offsets.back());
  for_each_chunk(n, kChunk, [&](Index chunk, Index begin, Index) {
    std::copy(rows[chunk].begin(), rows[chunk].end(), graph.neighbours.begin() + graph.offsets[begin]);
  });
  return graph;
}

CsrGraph dual_graph_by_vertex(const Incidence& elements) { return vertex_graph(transposed(elements)); }

}  // namespace meshorder
