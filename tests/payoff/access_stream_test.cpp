// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/access_stream.hpp"

#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "metrics/reuse_sample.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Input of the plain kernels.
struct Prepared {
  explicit Prepared(const Mesh& mesh)
      : graph(vertex_graph(mesh)), simplices(cut_into_simplices(mesh)), starts(1, 0) {
    for (Index v = 0; v < graph.size(); ++v) {
      std::vector<Index> row(graph[v].begin(), graph[v].end());
      row.push_back(v);
      std::sort(row.begin(), row.end());
      columns.insert(columns.end(), row.begin(), row.end());
      starts.push_back(static_cast<Offset>(columns.size()));
    }
  }

  CsrGraph graph;
  Simplices simplices;
  std::vector<Offset> starts;
  std::vector<Index> columns;
};

enum class Memory { starts, columns, values, x, y, positions, forces, elements, ends, lengths };

/// Records accesses in the order of the kernels' source code.
class Recorder {
 public:
  using Line = std::pair<Memory, Offset>;

  void touch(Memory array, Offset byte, Offset bytes) {
    for (Offset line = byte / 64; line <= (byte + bytes - 1) / 64; ++line)
      add({array, line}, Access::gathered);
  }
  /// Records streamed accesses, only to lines that no earlier call of `read` has recorded.
  void read(Memory array, Offset byte, Offset bytes) {
    for (Offset line = byte / 64; line <= (byte + bytes - 1) / 64; ++line) {
      if (read_.insert({array, line}).second) add({array, line}, Access::streamed);
    }
  }
  void clear(Memory array, Offset bytes) {
    for (Offset line = 0; line < (bytes + 63) / 64; ++line) add({array, line}, Access::streamed);
  }
  void point(Memory array, Index v) { touch(array, Offset{24} * v, 24); }

  std::vector<Line> lines;
  std::vector<Access> how;

 private:
  void add(const Line& line, Access access) {
    lines.push_back(line);
    how.push_back(access);
  }

  std::set<Line> read_;
};

void multiply(const Prepared& p, Recorder& to) {
  to.read(Memory::starts, 0, 8);
  for (Index v = 0; v < p.graph.size(); ++v) {
    to.read(Memory::starts, Offset{8} * (v + 1), 8);
    for (Offset k = p.starts[v]; k < p.starts[v + 1]; ++k) {
      to.read(Memory::columns, 4 * k, 4);
      to.read(Memory::values, 8 * k, 8);
      to.touch(Memory::x, Offset{8} * p.columns[k], 8);
    }
    to.read(Memory::y, Offset{8} * v, 8);
  }
}

void add_elements(const Prepared& p, bool assembly, Recorder& to) {
  const Offset corners = p.simplices.dimension + 1;
  if (corners == 1) return;
  if (assembly) {
    to.clear(Memory::values, Offset{8} * std::ssize(p.columns));
  } else {
    to.clear(Memory::forces, Offset{24} * p.graph.size());
  }
  for (Offset first = 0; first < std::ssize(p.simplices.vertices); first += corners) {
    const auto element = std::span(p.simplices.vertices).subspan(first, corners);
    to.read(Memory::elements, 4 * first, 4 * corners);
    for (const Index v : element) to.point(Memory::positions, v);
    for (const Index a : element) {
      if (!assembly) {
        to.point(Memory::forces, a);
        continue;
      }
      to.touch(Memory::starts, Offset{8} * a, 8);
      for (const Index b : element) {
        Offset k = p.starts[a];
        while (p.columns[k] != b) ++k;
        to.touch(Memory::columns, 4 * p.starts[a], 4 * (k + 1 - p.starts[a]));
        to.touch(Memory::values, 8 * k, 8);
      }
    }
  }
}

void add_springs(const Prepared& p, Recorder& to) {
  to.clear(Memory::forces, Offset{24} * p.graph.size());
  Offset spring = 0;
  for (Index a = 0; a < p.graph.size(); ++a) {
    for (const Index b : p.graph[a]) {
      if (b < a) continue;
      to.read(Memory::ends, 8 * spring, 8);
      to.point(Memory::positions, a);
      to.point(Memory::positions, b);
      to.read(Memory::lengths, 8 * spring++, 8);
      to.point(Memory::forces, a);
      to.point(Memory::forces, b);
    }
  }
}

Recorder recorded(Kernel kernel, const Prepared& p) {
  Recorder to;
  if (kernel == Kernel::spmv) multiply(p, to);
  if (kernel == Kernel::element || kernel == Kernel::assembly)
    add_elements(p, kernel == Kernel::assembly, to);
  if (kernel == Kernel::springs) add_springs(p, to);
  return to;
}

std::vector<Mesh> meshes() {
  std::vector<Mesh> result{Mesh{},
                           test::tetrahedral_bar(37),
                           test::mixed_mesh(),
                           test::cells_of_type(Shape::quad, 4, 13),
                           test::cells_of_type(Shape::line, 2, 21),
                           test::cells_of_type(Shape::vertex, 1, 4)};
  Mesh shuffled = result[1];
  apply_reordering(shuffled, test::shuffled(shuffled.vertex_count(), 3), test::shuffled_cells(shuffled, 4));
  result.push_back(shuffled);
  // a flat element that names a vertex twice
  Mesh degenerate = test::cells_of_type(Shape::tetrahedron, 4, 9);
  degenerate.cells.vertices[5] = degenerate.cells.vertices[4];
  result.push_back(degenerate);
  return result;
}

TEST(AccessStream, TouchesTheLinesThatTheKernelTouches) {
  for (const Mesh& mesh : meshes()) {
    const Prepared prepared(mesh);
    for (const Kernel kernel : kKernels) {
      SCOPED_TRACE(std::string(to_string(kernel)) + ", " + std::to_string(mesh.vertex_count()) + " vertices");
      const AccessStream stream(kernel, prepared.graph, prepared.simplices);
      std::vector<Index> lines;
      std::vector<Access> how;
      stream.visit([&](Index line, Access access) {
        lines.push_back(line);
        how.push_back(access);
      });
      const Recorder recorder = recorded(kernel, prepared);
      const std::vector<Recorder::Line>& expected = recorder.lines;
      EXPECT_EQ(how, recorder.how);
      ASSERT_EQ(lines.size(), expected.size());
      std::map<Index, Recorder::Line> names;
      std::set<Recorder::Line> distinct;
      for (std::size_t k = 0; k < lines.size(); ++k) {
        ASSERT_GE(lines[k], 0);
        ASSERT_LT(lines[k], stream.line_count());
        ASSERT_EQ(names.insert({lines[k], expected[k]}).first->second, expected[k]) << "access " << k;
        distinct.insert(expected[k]);
      }
      EXPECT_EQ(names.size(), distinct.size());
    }
  }
}

/// A sample of lines, and the accesses to them.
struct Wanted {
  std::vector<std::pair<Index, Access>> accesses = {};
  Offset gathered = 0;  ///< calls of `gather`, also for lines that are not wanted

  static bool is_wanted(Index line) { return line / 7 % 50 == 1; }
  static bool samples(Index first, Index last) {
    for (Index line = first; line <= last; ++line) {
      if (is_wanted(line)) return true;
    }
    return false;
  }
  void gather(Index line) {
    ++gathered;
    if (is_wanted(line)) accesses.emplace_back(line, Access::gathered);
  }
  void stream(Index first, Index end) {
    for (Index line = first; line < end; ++line) {
      if (is_wanted(line)) accesses.emplace_back(line, Access::streamed);
    }
  }
};

TEST(AccessStream, HasAllThatIsWantedWhereItMayLeaveOutTheRest) {
  for (const Mesh& mesh : meshes()) {
    const Prepared prepared(mesh);
    for (const Kernel kernel : kKernels) {
      SCOPED_TRACE(std::string(to_string(kernel)) + ", " + std::to_string(mesh.vertex_count()) + " vertices");
      const AccessStream stream(kernel, prepared.graph, prepared.simplices);
      Wanted wanted;
      std::vector<std::pair<Index, Access>> all;
      Offset gathered = 0;
      stream.visit([&](Index line, Access how) {
        gathered += how == Access::gathered ? 1 : 0;
        if (Wanted::is_wanted(line)) all.emplace_back(line, how);
      });
      stream.visit_some(wanted);
      EXPECT_EQ(wanted.accesses, all);
      if (prepared.graph.size() > 30 && mesh.cells.highest_dimension() == 3) {
        EXPECT_LT(wanted.gathered, 0.75 * static_cast<double>(gathered));
      }
    }
  }
}

TEST(ReuseOf, HasNoColdAccessesAndMissesTheLeastWithTheLargestCache) {
  const Prepared prepared(test::tetrahedral_bar(200));
  for (const Kernel kernel : kKernels) {
    SCOPED_TRACE(to_string(kernel));
    const ReuseHistogram histogram = reuse_of(kernel, prepared.graph, prepared.simplices).all;
    const Index lines = AccessStream(kernel, prepared.graph, prepared.simplices).line_count();
    EXPECT_EQ(histogram.cold(), 0);
    EXPECT_EQ(histogram.accesses(), static_cast<Offset>(recorded(kernel, prepared).lines.size()));
    EXPECT_EQ(histogram.misses(2 * lines), 0);
    EXPECT_EQ(histogram.misses(0), histogram.accesses());
    // the bar in order: a cache of a few cubes misses each line once, and each cleared line twice
    EXPECT_LE(histogram.misses(200), 2 * lines);
    EXPECT_GT(histogram.misses(200), lines / 2);
  }
}

/// Counts the lengths that a simple prediction misses: it predicts the length that has followed the last
/// occurrence of the eight preceding lengths.
Offset unforeseen(const std::vector<Offset>& lengths) {
  std::map<std::vector<Offset>, Offset> followed;
  std::vector<Offset> last(8, 0);
  Offset turns = 0;
  for (const Offset length : lengths) {
    const auto found = followed.find(last);
    turns += found == followed.end() || found->second != length ? 1 : 0;
    followed[last] = length;
    last.erase(last.begin());
    last.push_back(length);
  }
  return turns;
}

TEST(ReuseOf, CountsLoopsThatDoNotEndWhereTheyAreForeseen) {
  for (const Mesh& mesh : {test::tetrahedral_bar(30), test::mixed_mesh()}) {
    const Prepared p(mesh);
    std::vector<Offset> rows;
    for (Index v = 0; v < p.graph.size(); ++v) rows.push_back(p.graph.degree(v));
    EXPECT_EQ(reuse_of(Kernel::spmv, p.graph, p.simplices).turns, unforeseen(rows));
    const Offset corners = p.simplices.dimension + 1;
    std::vector<Offset> searches;
    for (Offset first = 0; first < std::ssize(p.simplices.vertices); first += corners) {
      for (Offset pair = 0; pair < corners * corners; ++pair) {
        const Index a = p.simplices.vertices[first + pair / corners];
        Offset k = p.starts[a];
        while (p.columns[k] != p.simplices.vertices[first + pair % corners]) ++k;
        searches.push_back(k - p.starts[a]);
      }
    }
    // different sequences of lengths are rarely mistaken for equal ones
    const Offset expected = unforeseen(searches);
    const Offset found = reuse_of(Kernel::assembly, p.graph, p.simplices).turns;
    EXPECT_NEAR(static_cast<double>(found), static_cast<double>(expected),
                0.02 * static_cast<double>(searches.size()));
    EXPECT_LT(found, std::ssize(searches) / 2);
    EXPECT_EQ(reuse_of(Kernel::assembly, p.graph, p.simplices, 3).turns, found);
    for (const Kernel other : {Kernel::element, Kernel::springs})
      EXPECT_EQ(reuse_of(other, p.graph, p.simplices).turns, 0);
  }
}

TEST(ReuseOf, EstimatesTheTurnsOfLargeMeshes) {
  const Mesh mesh = make_grid({.size = 40});
  const CsrGraph graph = vertex_graph(mesh);
  const Simplices simplices = cut_into_simplices(mesh);
  const auto exact = static_cast<double>(reuse_of(Kernel::assembly, graph, simplices, 3).turns);
  const auto estimate = static_cast<double>(reuse_of(Kernel::assembly, graph, simplices, 4).turns);
  EXPECT_NE(estimate, exact);
  EXPECT_NEAR(estimate, exact, 0.3 * exact);
}

TEST(ReuseOf, IsTheSameWhereWhatIsNotSampledIsLeftOut) {
  const Prepared p(test::tetrahedral_bar(400));
  // the halvings of each kernel's sample, in the order of kKernels
  for (const auto& [halvings, of_kernels] : {std::pair{3, std::array{1, 3, 3, 3}}, {4, {3, 4, 5, 4}}}) {
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      const AccessStream stream(kKernels[k], p.graph, p.simplices);
      ReuseSample of_all(stream.line_count(), of_kernels[k]);
      stream.visit([&](Index line, Access how) { of_all.access(line, how); });
      const Reuse expected = std::move(of_all).repeated();
      const Reuse found = reuse_of(kKernels[k], p.graph, p.simplices, halvings);
      EXPECT_EQ(found, expected) << to_string(kKernels[k]) << ", " << halvings << " halvings";
      EXPECT_GT(found.all.accesses(), 0);
    }
  }
}

TEST(HalvingsFor, FollowsAllLinesOfSmallMeshesAndFewerOfLargerOnes) {
  EXPECT_EQ(halvings_for(0), 0);
  EXPECT_EQ(halvings_for(180'000), 0);
  int before = 0;
  for (const Offset simplices : {300'000, 1'600'000, 60'000'000}) {
    EXPECT_GT(halvings_for(simplices), before);
    before = halvings_for(simplices);
  }
  // a first level of 32 KB is 16 lines of the sample
  EXPECT_LE(before, 5);
}

TEST(ReuseOfKernels, IsThatOfEachByItself) {
  const Prepared prepared(test::mixed_mesh());
  const KernelReuse reuse = reuse_of_kernels(prepared.graph, prepared.simplices);
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    EXPECT_EQ(reuse[k], reuse_of(kKernels[k], prepared.graph, prepared.simplices)) << to_string(kKernels[k]);
  }
}

TEST(ReuseOfKernels, OfAnOrderIsThatOfTheReorderedMesh) {
  for (const Mesh& mesh : {test::tetrahedral_bar(30), test::mixed_mesh()}) {
    const Permutation vertices = test::shuffled(mesh.vertex_count(), 3);
    const Permutation cells = test::shuffled_cells(mesh, 4);
    Mesh ordered = mesh;
    apply_reordering(ordered, vertices, cells);
    const Prepared prepared(ordered);
    const CsrGraph graph = vertex_graph(mesh);
    EXPECT_EQ(reuse_of_kernels(KernelInput(mesh, graph).moved({{vertices}, {cells}})),
              reuse_of_kernels(prepared.graph, prepared.simplices));
  }
}

TEST(ReuseOf, IsFartherInAScrambledOrder) {
  const Mesh ordered = test::tetrahedral_bar(400);
  Mesh scrambled = ordered;
  apply_reordering(scrambled, test::shuffled(ordered.vertex_count(), 3), test::shuffled_cells(ordered, 4));
  const Prepared good(ordered);
  const Prepared bad(scrambled);
  for (const Kernel kernel : kKernels) {
    SCOPED_TRACE(to_string(kernel));
    const ReuseHistogram few = reuse_of(kernel, good.graph, good.simplices).all;
    const ReuseHistogram many = reuse_of(kernel, bad.graph, bad.simplices).all;
    EXPECT_LT(few.misses(128), many.misses(128));
    EXPECT_LT(few.mean_log2() + 0.2, many.mean_log2());
  }
}

}  // namespace
}  // namespace meshorder
