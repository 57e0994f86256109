// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/incidence.hpp"

#include "base/buckets.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "graph/join_limit.hpp"
#include <meshorder/error.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// The position of an entry of a matrix.
struct Position {
  Index row;
  Index column;
};

/// Rows that a thread takes together.
constexpr Index kRowsOfPart = 16384;

}  // namespace

template <>
struct StoredEntry<Position> {
  static_assert(kRowsOfPart - 1 <= UINT16_MAX);
  std::uint16_t row;     ///< relative to the first row of its part
  std::uint16_t column;  ///< relative to the first column of its bucket

  static StoredEntry of(Position at, Index first_row, Index first_column) {
    return {static_cast<std::uint16_t>(at.row - first_row),
            static_cast<std::uint16_t>(at.column - first_column)};
  }
  [[nodiscard]] Position whole(Index first_row, Index first_column) const {
    return {first_row + row, first_column + column};
  }
};

namespace {

/// Returns whether consecutive rows have columns far apart, so that `by_columns` would wait for memory. Looks
/// at about a thousand rows.
bool is_scattered(IncidenceRef incidence) {
  constexpr Index kLooks = 1000;
  constexpr Index kFar = 65536;  // the entries of this many columns fill a cache of some megabytes
  const Index step = incidence.size() / kLooks + 1;
  Index looks = 0;
  Index far = 0;
  for (Offset e = step; e < incidence.size(); e += step) {
    const std::span<const Index> before = incidence[static_cast<Index>(e - 1)];
    const std::span<const Index> row = incidence[static_cast<Index>(e)];
    if (before.empty() || row.empty()) continue;
    ++looks;
    if (std::abs(row.front() - before.front()) > kFar) ++far;
  }
  return far > looks / 8;
}

// The next two functions return the rows of each column, ascending, one column after another.
// `entries_of(part, begin, end)(call)` calls `call` with row and column of each entry of a part.

/// @param offsets  where each column begins, and the end
template <class EntriesOf>
std::vector<Index> by_columns(Index row_count, const EntriesOf& entries_of,
                              const std::vector<Offset>& offsets) {
  std::vector<Index> rows;
  resize_large(rows, static_cast<std::size_t>(offsets.back()));
  std::vector<Offset> next(offsets.begin(), offsets.end() - 1);
  const auto write = [rows = rows.data(), next = next.data()](Position at) {
    rows[next[at.column]++] = at.row;
  };
  for (Index begin = 0, part = 0; begin < row_count; ++part) {
    poll();
    const Index end = begin + std::min(row_count - begin, kRowsOfPart);
    entries_of(part, begin, end)(write);
    begin = end;
  }
  return rows;
}

/// Like `by_columns`, but for scattered columns and on all threads.
///
/// @param offsets  written: where each column begins, and the end
template <class EntriesOf>
std::vector<Index> by_columns_in_buckets(Index row_count, const EntriesOf& entries_of,
                                         std::vector<Offset>& offsets) {
  const auto column_of = [](const Position& at) { return at.column; };
  const auto columns = static_cast<Index>(offsets.size() - 1);
  const Buckets<Position> buckets(row_count, kRowsOfPart, columns, entries_of, column_of);
  std::vector<Index> rows;
  resize_large(rows, static_cast<std::size_t>(buckets.start(buckets.size())));
  parallel_loop(buckets.size(), [&](Index bucket) {
    std::vector<Offset> next = buckets.key_starts(bucket, column_of);
    const Index first = buckets.first_key(bucket);
    std::copy(next.begin(), next.end() - 1, offsets.begin() + first);
    buckets.for_each(bucket, [rows = rows.data(), next = next.data(), first](Position at) {
      rows[next[at.column - first]++] = at.row;
    });
  });
  offsets.back() = std::ssize(rows);
  return rows;
}

}  // namespace

Incidence transposed(IncidenceRef incidence) {
  const auto entries_of = [&](Index /*part*/, Index begin, Index end) {
    return [&incidence, begin, end](const auto& call) {
      for (Index e = begin; e < end; ++e) {
        for (const Index v : incidence[e]) call(Position{.row = e, .column = v});
      }
    };
  };
  Incidence result;
  result.vertex_count = incidence.size();
  result.offsets.assign(Offset{incidence.vertex_count} + 1, 0);
  if (is_scattered(incidence)) {
    result.vertices = by_columns_in_buckets(incidence.size(), entries_of, result.offsets);
    return result;
  }
  for (const Index v : incidence.vertices) ++result.offsets[v + 1];
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.vertices = by_columns(incidence.size(), entries_of, result.offsets);
  return result;
}

Offset common_size(IncidenceRef elements) {
  if (elements.size() == 0) return 0;
  const Offset size = elements.offsets[1];
  const bool is_common = holds_for_all(elements.size(), [&](Offset begin, Offset end) {
    bool all = true;
    for (Offset e = begin; e < end; ++e) all &= elements.offsets[e + 1] == (e + 1) * size;
    return all;
  });
  return is_common ? size : 0;
}

namespace {

/// Rows of a graph, one after another; the entries of a row are in any order.
struct Rows {
  std::vector<Index> neighbours;
  Offset end = 0;  ///< number of neighbours in use
};

/// The vertices of each element. `Size` is the number of vertices that every element has, so that offsets
/// need not be read; if it is 0, the offsets are read.
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

/// Appends the row of v. `seen_by[u] == v` marks vertices u that the row already has, and v itself.
template <int Size>
void append_row(Elements<Size> elements, const Incidence& at_vertex, Index v, std::vector<Index>& seen_by,
                Rows& rows) {
  constexpr Offset kAhead = 12;  // elements lie anywhere in memory: prefetch them early
  Offset most = 0;
  for (const Index e : at_vertex[v]) most += elements.size(e);
  most = std::min(most, Offset{elements.incidence.vertex_count});
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

/// Returns the rows of all vertices, kRowsOfPart in each part, and sets `degrees[v + 1]` to the degree of v.
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

/// The same for elements whose size is known only at run time.
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

/// Returns the symmetric graph with these rows, kRowsOfPart in each of `parts`. Writing a symmetric matrix by
/// columns gives ascending rows. Frees each part once it is read.
CsrGraph with_sorted_rows(std::vector<Offset> offsets, std::vector<Rows> parts, bool scattered) {
  CsrGraph graph;
  graph.offsets = std::move(offsets);
  const auto entries_of = [&](Index part, Index begin, Index end) {
    return [&graph, rows = std::move(parts[part]), begin, end](const auto& call) {
      const Index* neighbour = rows.neighbours.data();
      for (Index v = begin; v < end; ++v) {
        for (const Index* const last = neighbour + graph.degree(v); neighbour < last; ++neighbour)
          call(Position{.row = v, .column = *neighbour});
      }
    };
  };
  graph.neighbours = scattered ? by_columns_in_buckets(graph.size(), entries_of, graph.offsets)
                               : by_columns(graph.size(), entries_of, graph.offsets);
  return graph;
}

/// See `limit_joins`.
struct LimitOnJoins {
  std::uint64_t bytes = UINT64_MAX;
  std::uint64_t bytes_of_entry = kBytesToOrder;
};

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): of the process
LimitOnJoins limit_on_joins;

/// Returns an upper bound on the number of graph entries from long rows: each member of a row may have all
/// other members as neighbours.
std::uint64_t entries_of_long_rows(IncidenceRef rows) {
  std::vector<Offset> neighbours(static_cast<std::size_t>(rows.vertex_count), 0);
  for (Index e = 0; e < rows.size(); ++e) {
    const std::span<const Index> row = rows[e];
    if (row.size() <= kManyJoined) continue;
    for (const Index v : row) neighbours[v] += std::ssize(row) - 1;
  }
  std::uint64_t entries = 0;
  for (const Offset most : neighbours)
    entries += static_cast<std::uint64_t>(std::min(most, Offset{rows.vertex_count} - 1));
  return entries;
}

/// Throws TooLarge if rows of more than `kManyJoined` members would make a graph beyond the limit; the
/// message names the longest row. O(entries).
void require_memory_to_join(IncidenceRef rows, const JoinNames& names) {
  Index longest = -1;
  std::size_t most = kManyJoined;
  for (Index e = 0; e < rows.size(); ++e) {
    if (rows[e].size() <= most) continue;
    most = rows[e].size();
    longest = e;
  }
  if (longest < 0) return;
  const std::uint64_t bytes = bytes_for(entries_of_long_rows(rows), limit_on_joins.bytes_of_entry);
  const std::uint64_t limit = std::min(limit_on_joins.bytes, memory_limit().bytes);
  if (bytes <= limit) return;
  throw TooLarge(
      std::string(names.row) + " " + std::to_string(names.number_of ? names.number_of(longest) : longest) +
      " has " + std::to_string(most) + " " + names.members +
      ", each joined to all others: the graph would take " + size_text(bytes) + ", more than the limit of " +
      size_text(limit) + "; " + names.remedy + ", or raise the memory limit (--limit-memory)");
}

}  // namespace

void limit_joins(std::uint64_t bytes, std::uint64_t bytes_of_entry) {
  limit_on_joins = {bytes, bytes_of_entry};
}

CsrGraph joined_vertices(IncidenceRef elements, const JoinNames& names) {
  require_memory_to_join(elements, names);
  std::vector<Offset> offsets(Offset{elements.vertex_count} + 1, 0);
  std::vector<Rows> rows = find_rows(elements, offsets);
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  return with_sorted_rows(std::move(offsets), std::move(rows), is_scattered(elements));
}

CsrGraph joined_vertices(IncidenceRef elements) { return joined_vertices(elements, {}); }

CsrGraph joined_by_vertex(IncidenceRef elements) {
  return joined_vertices(transposed(elements),
                         {.row = "vertex",
                          .members = "elements",
                          .remedy = "join elements by facets (--elements fiedler-facet)"});
}

}  // namespace meshorder
