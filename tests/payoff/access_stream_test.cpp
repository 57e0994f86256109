// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/access_stream.hpp"

#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "metrics/reuse_sample.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Input of a kernel, prepared as KernelBench does.
struct Prepared {
  explicit Prepared(const Mesh& mesh)
      : graph(vertex_graph(mesh)),
        matrix(zero_block_csr(graph)),
        simplices(cut_into_simplices(mesh)),
        rest(rest_shapes(simplices, mesh.points)),
        map(assembly_map(rest, matrix)),
        springs(springs_on_edges(graph, mesh.points)) {}

  CsrGraph graph;
  BlockCsr matrix;
  Simplices simplices;
  RestShapes rest;
  AssemblyMap map;
  Springs springs;
};

enum class Memory {
  offsets,
  columns,
  values,
  x,
  y,
  positions,
  forces,
  vertices,
  geometry,
  map,
  ends,
  lengths
};

/// Accesses as the kernels' sources read, to the data that they are given.
class Recorder {
 public:
  using Line = std::pair<Memory, Offset>;

  void touch(Memory array, Offset byte, Offset bytes) {
    for (Offset line = byte / 64; line <= (byte + bytes - 1) / 64; ++line)
      add({array, line}, Access::gathered);
  }
  /// The same, but only addresses that were not touched before.
  void read(Memory array, Offset byte, Offset bytes) {
    for (Offset line = byte / 64; line <= (byte + bytes - 1) / 64; ++line) {
      if (read_.insert({array, line}).second) add({array, line}, Access::streamed);
    }
  }
  void clear(Memory array, Offset bytes) {
    for (Offset line = 0; line < (bytes + 63) / 64; ++line) add({array, line}, Access::streamed);
  }
  template <class Vertices>
  void vertex_data(Memory array, const Vertices& vertices, Offset first, Offset count) {
    for (Offset k = first; k < first + count; ++k) touch(array, Offset{32} * vertices[k], 32);
  }

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
  to.read(Memory::offsets, 0, 8);
  for (Index v = 0; v < p.matrix.size(); ++v) {
    to.read(Memory::offsets, 8 * (v + 1), 8);
    for (Offset k = p.matrix.offsets[v]; k < p.matrix.offsets[v + 1]; ++k) {
      to.read(Memory::columns, 4 * k, 4);
      to.read(Memory::values, 72 * k, 72);
      to.touch(Memory::x, Offset{24} * p.matrix.columns[k], 24);
    }
    to.read(Memory::y, Offset{24} * v, 24);
  }
}

void add_elements(const Prepared& p, bool assembly, Recorder& to) {
  const Offset corners = p.rest.dimension + 1;
  if (p.rest.count == 0) return;
  if (assembly) {
    to.clear(Memory::values, 72 * p.matrix.block_count());
  } else {
    to.clear(Memory::forces, Offset{32} * p.graph.size());
  }
  Offset simplex = 0;
  for (Offset batch = 0; batch < p.rest.batches(); ++batch) {
    const Offset doubles = Offset{8} * p.rest.quantities();
    to.read(Memory::geometry, 8 * batch * doubles, 8 * doubles);
    to.read(Memory::vertices, 4 * batch * 8 * corners, 4 * 8 * corners);
    to.vertex_data(Memory::positions, p.rest.vertices, batch * 8 * corners, 8 * corners);
    if (!assembly) to.vertex_data(Memory::forces, p.rest.vertices, batch * 8 * corners, 8 * corners);
    for (Offset lane = 0; assembly && lane < 8 && simplex < p.rest.count; ++lane, ++simplex) {
      const Offset first = simplex * corners * corners;
      to.read(Memory::map, 4 * first, 4 * corners * corners);
      for (Offset a = 0; a < corners; ++a) {
        for (Offset b = a; b < corners; ++b) {
          to.touch(Memory::values, Offset{72} * p.map.blocks[first + a * corners + b], 72);
          if (a != b) to.touch(Memory::values, Offset{72} * p.map.blocks[first + b * corners + a], 72);
        }
      }
    }
  }
}

void add_springs(const Prepared& p, Recorder& to) {
  to.clear(Memory::forces, Offset{32} * p.graph.size());
  for (Offset first = 0; first < p.springs.count; first += 8) {
    to.read(Memory::ends, 8 * first, 64);
    to.vertex_data(Memory::positions, p.springs.ends, 2 * first, 16);
    to.read(Memory::lengths, 8 * first, 64);
    to.vertex_data(Memory::forces, p.springs.ends, 2 * first, 16);
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
      EXPECT_EQ(reuse_of(kernel, prepared.graph, prepared.simplices).gathers,
                std::count(how.begin(), how.end(), Access::gathered));
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

/// Some lines of many, and the accesses to them.
struct Wanted {
  std::vector<std::pair<Index, Access>> accesses = {};
  Offset gathered = 0;  ///< as told, to lines that are not wanted, too

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

TEST(AccessStream, TellsAllThatIsWantedWhereItMayLeaveOutTheRest) {
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
    // the bar in order: whoever keeps a few cubes misses each line once, and each cleared line twice
    EXPECT_LE(histogram.misses(200), 2 * lines);
    EXPECT_GT(histogram.misses(200), lines / 2);
  }
}

TEST(ReuseOf, CountsAdditionsToAVertexThatHardlyLeftTheRegisters) {
  for (const Mesh& mesh : {test::tetrahedral_bar(30), test::mixed_mesh()}) {
    const Prepared p(mesh);
    // registers of eight doubles: all lanes of a corner, those of the lower and the upper half by turns
    std::vector<Index> added;
    for (Offset batch = 0; batch < p.rest.batches(); ++batch) {
      for (int a = 0; a <= p.rest.dimension; ++a) {
        for (int i = 0; i < kBatch / 2; ++i) {
          added.push_back(p.rest.vertex(batch * kBatch + i, a));
          added.push_back(p.rest.vertex(batch * kBatch + kBatch / 2 + i, a));
        }
      }
    }
    Offset repeats = 0;
    for (std::size_t i = 1; i < added.size(); ++i) {
      if (added[i] == added[i - 1] || (i > 1 && added[i] == added[i - 2])) ++repeats;
    }
    ASSERT_GT(repeats, 0);
    EXPECT_EQ(reuse_of(Kernel::element, p.graph, p.simplices).repeats, repeats);
    EXPECT_EQ(reuse_of(Kernel::element, p.graph, p.simplices, 3).repeats, repeats);
    for (const Kernel other : {Kernel::spmv, Kernel::assembly, Kernel::springs}) {
      EXPECT_EQ(reuse_of(other, p.graph, p.simplices).repeats, 0);
    }
  }
}

TEST(ReuseOf, CountsSixteensOfGatheredAccessesOfWhichOneWasLeftForLong) {
  // in any order, and small enough that only some of the groups have one that was left for so long
  Mesh mesh = test::tetrahedral_bar(120);
  apply_reordering(mesh, test::shuffled(mesh.vertex_count(), 3), test::shuffled_cells(mesh, 4));
  const Prepared p(mesh);
  const Recorder stream = recorded(Kernel::spmv, p);
  std::map<Recorder::Line, int> read_before;
  int read = 0;
  std::vector<bool> left;  // of each gathered access
  for (std::size_t i = 0; i < stream.lines.size(); ++i) {
    if (stream.how[i] == Access::streamed) {
      ++read;
      continue;
    }
    const auto found = read_before.find(stream.lines[i]);
    left.push_back(found == read_before.end() || read - found->second >= 512);
    read_before[stream.lines[i]] = read;
  }
  Offset stalls = 0;
  for (std::size_t first = 0; first + 16 <= left.size(); first += 16) {
    stalls += std::any_of(left.begin() + first, left.begin() + first + 16, std::identity()) ? 1 : 0;
  }
  ASSERT_GT(stalls, std::ssize(left) / 16 / 5);
  ASSERT_LT(stalls, std::ssize(left) / 16 * 4 / 5);
  EXPECT_EQ(reuse_of(Kernel::spmv, p.graph, p.simplices).stalls, stalls);
  EXPECT_EQ(reuse_of(Kernel::spmv, p.graph, p.simplices, 3).stalls, stalls);
  for (const Kernel other : {Kernel::element, Kernel::assembly, Kernel::springs}) {
    EXPECT_EQ(reuse_of(other, p.graph, p.simplices).stalls, 0);
  }
}

TEST(ReuseOf, IsTheSameWhereWhatIsNotSampledIsLeftOut) {
  const Prepared p(test::tetrahedral_bar(400));
  for (const Kernel kernel : kKernels) {
    const AccessStream stream(kernel, p.graph, p.simplices);
    ReuseSample of_all(stream.line_count(), 3);
    stream.visit([&](Index line, Access how) { of_all.access(line, how); });
    const Reuse expected = std::move(of_all).repeated();
    const Reuse found = reuse_of(kernel, p.graph, p.simplices, 3);
    EXPECT_EQ(found, expected) << to_string(kernel);
    EXPECT_GT(found.all.accesses(), 0);
  }
}

TEST(ReuseOf, CountsSixteensOfLargeMeshesInStretchesOfTheirRows) {
  Mesh mesh = make_grid({.size = 40});
  const Permutation as_is = Permutation::identity(mesh.cell_count());
  for (const bool scrambled : {false, true}) {
    if (scrambled) move_mesh(mesh, test::shuffled(mesh.vertex_count(), 1), as_is, Ids::keep);
    const Simplices simplices = cut_into_simplices(mesh);
    const CsrGraph graph = vertex_graph(mesh);
    const Offset exact = reuse_of(Kernel::spmv, graph, simplices, 3).stalls;
    const Offset estimate = reuse_of(Kernel::spmv, graph, simplices, 4).stalls;
    EXPECT_NEAR(static_cast<double>(estimate), static_cast<double>(exact), 0.03 * static_cast<double>(exact));
    EXPECT_NE(estimate, exact);
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
    EXPECT_EQ(reuse_of_kernels(mesh, vertex_graph(mesh), vertices, cells),
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
