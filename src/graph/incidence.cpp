// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/incidence.hpp"

#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/resize_in_steps.hpp"
#include "base/run_scope.hpp"
#include <meshorder/error.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {

Incidence transposed(IncidenceRef incidence) {
  Incidence result;
  result.vertex_count = incidence.size();
  result.offsets.assign(Offset{incidence.vertex_count} + 1, 0);
  for (const Index v : incidence.vertices) ++result.offsets[v + 1];
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  resize_in_steps(result.vertices, incidence.vertices.size());
  std::vector<Offset> next(result.offsets.begin(), result.offsets.end() - 1);
  for (Index e = 0; e < incidence.size(); ++e) {
    poll_in_loop(e);
    for (const Index v : incidence[e]) result.vertices[next[v]++] = e;
  }
  return result;
}

namespace {

constexpr Index kRowsOfPart = 16384;  // vertices whose rows a thread finds together

/// The size that all elements share, 0 where they differ.
Offset common_size(IncidenceRef elements) {
  if (elements.size() == 0) return 0;
  const Offset size = elements.offsets[1];
  for (Index e = 0; e < elements.size(); ++e) {
    if (elements.offsets[e + 1] != (e + 1) * size) return 0;
  }
  return size;
}

/// Rows of a graph one after another, entries within a row in any order.
struct Rows {
  std::vector<Index> neighbours;
  Offset end = 0;  ///< of what is used
};

/// Where the elements stand among all vertices of elements. `Size` is the size of every element, which
/// spares reading the offsets, or 0 where they differ.
template <int Size>
struct Elements {
  IncidenceRef incidence;

  [[nodiscard]] const Index* begin(Index e) const {
    return incidence.vertices.data() + (Size > 0 ? Offset{e} * Size : incidence.offsets[e]);
  }
  [[nodiscard]] Offset size(Index e) const {
    return Size > 0 ? Size : incidence.offsets[e + 1] - incidence.offsets[e];
  }
};

/// Appends the neighbours of v. `seen_by[u] == v` marks those that the row already has.
template <int Size>
void append_row(Elements<Size> elements, const Incidence& at_vertex, Index v, std::vector<Index>& seen_by,
                Rows& rows) {
  constexpr Offset kAhead = 12;  // elements lie anywhere in memory: ask for them early
  Offset most = 0;
  for (const Index e : at_vertex[v]) most += elements.size(e);
  if (rows.end + most >= static_cast<Offset>(rows.neighbours.size())) {
    rows.neighbours.resize(3 * rows.neighbours.size() / 2 + static_cast<std::size_t>(most) + 1);
  }
  const auto last_incidence = static_cast<Offset>(at_vertex.vertices.size()) - 1;
  Index* const found = rows.neighbours.data();
  Index* const seen = seen_by.data();
  Offset end = rows.end;
  seen[v] = v;
  for (Offset k = at_vertex.offsets[v]; k < at_vertex.offsets[v + 1]; ++k) {
    __builtin_prefetch(elements.begin(at_vertex.vertices[std::min(k + kAhead, last_incidence)]));
    const Index e = at_vertex.vertices[k];
    const Index* const vertices = elements.begin(e);
    for (Offset i = 0; i < elements.size(e); ++i) {
      // branch-free: the test is unpredictable
      const Index u = vertices[i];
      found[end] = u;
      end += seen[u] == v ? 0 : 1;
      seen[u] = v;
    }
  }
  rows.end = end;
}

/// All rows, kRowsOfPart in each part, and the degrees: `degrees[v + 1]` is that of v.
template <int Size>
std::vector<Rows> find_rows(Elements<Size> elements, std::vector<Offset>& degrees) {
  const Incidence at_vertex = transposed(elements.incidence);
  const Index n = elements.incidence.vertex_count;
  std::vector<Rows> parts(chunk_count(n, kRowsOfPart));
  tbb::enumerable_thread_specific<std::vector<Index>> marks([n] { return std::vector<Index>(n, -1); });
  for_each_chunk(n, kRowsOfPart, [&](Index chunk, Index begin, Index end) {
    Rows& rows = parts[chunk];
    // enough for meshes of triangles and tetrahedra
    rows.neighbours.resize(at_vertex.offsets[end] - at_vertex.offsets[begin]);
    std::vector<Index>& seen_by = marks.local();
    for (Index v = begin; v < end; ++v) {
      const Offset row = rows.end;
      append_row(elements, at_vertex, v, seen_by, rows);
      degrees[v + 1] = rows.end - row;
    }
  });
  return parts;
}

/// The same for elements whose size is known only now.
std::vector<Rows> find_rows(IncidenceRef elements, std::vector<Offset>& degrees) {
  switch (common_size(elements)) {
    case 3:
      return find_rows(Elements<3>{elements}, degrees);
    case 4:
      return find_rows(Elements<4>{elements}, degrees);
    default:
      return find_rows(Elements<0>{elements}, degrees);
  }
}

/// The symmetric graph with these rows, kRowsOfPart in each of `chunks`, each sorted: reading the rows in
/// turn and the entries the other way sorts them all in one pass. Chunks are freed once they are read.
CsrGraph with_sorted_rows(std::vector<Offset> offsets, std::vector<Rows> chunks) {
  CsrGraph graph;
  resize_in_steps(graph.neighbours, offsets.back());
  std::vector<Offset> next(offsets.begin(), offsets.end() - 1);
  graph.offsets = std::move(offsets);
  for (Index v = 0, chunk = 0; v < graph.size(); ++chunk) {
    poll();
    const Rows& rows = chunks[chunk];
    Offset k = 0;
    for (const Index chunk_end = std::min(graph.size() - v, kRowsOfPart) + v; v < chunk_end; ++v) {
      for (const Offset end = k + graph.degree(v); k < end; ++k) {
        graph.neighbours[next[rows.neighbours[k]]++] = v;
      }
    }
    chunks[chunk] = {};
  }
  return graph;
}

}  // namespace

namespace {

/// Throws TooLarge where elements of many vertices would make a graph beyond the limit on memory.
void require_memory(IncidenceRef elements) {
  constexpr Offset kMany = 64;              // vertices of an element
  constexpr std::uint64_t kBytesEach = 16;  // of an entry, with what orders keep beside the graph
  std::uint64_t entries = 0;
  for (Index e = 0; e < elements.size(); ++e) {
    const Offset size = elements.offsets[e + 1] - elements.offsets[e];
    if (size > kMany) entries += static_cast<std::uint64_t>(size) * static_cast<std::uint64_t>(size - 1);
  }
  const std::uint64_t bytes = bytes_for(entries, kBytesEach);
  if (bytes <= memory_limit().bytes) return;
  throw TooLarge("the graph of all vertices would have " + std::to_string(entries) +
                 " entries, as each cell joins all of its vertices, and take " + size_text(bytes) +
                 ", more than the limit of " + size_text(memory_limit().bytes) +
                 "; cut the cells of many vertices, or raise the limit on memory (--limit-memory)");
}

}  // namespace

CsrGraph joined_vertices(IncidenceRef elements) {
  require_memory(elements);
  std::vector<Offset> offsets(Offset{elements.vertex_count} + 1, 0);
  std::vector<Rows> rows = find_rows(elements, offsets);
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  return with_sorted_rows(std::move(offsets), std::move(rows));
}

CsrGraph joined_by_vertex(IncidenceRef elements) { return joined_vertices(transposed(elements)); }

}  // namespace meshorder
