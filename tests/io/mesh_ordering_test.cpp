// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "metrics/edge_span.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/registry.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

ReorderOptions methods(std::string vertices, std::string elements) {
  return {.methods = {std::move(vertices), std::move(elements)}};
}

/// The vertices of a cell in descending order, which lexmax compares in a mesh with reordered vertices.
std::vector<Index> falling(const Mesh& mesh, Index cell) {
  std::vector<Index> result(mesh.cells[cell].begin(), mesh.cells[cell].end());
  std::sort(result.rbegin(), result.rend());
  return result;
}

/// Whether the cells of that dimension from `first` to `end` are in lexmax order.
bool in_lexmax_order(const Mesh& mesh, int of_dimension, Index first, Index end) {
  std::vector<std::vector<Index>> tuples;
  for (Index c = first; c < end; ++c) {
    if (dimension(mesh.cells.shapes[c]) == of_dimension) tuples.push_back(falling(mesh, c));
  }
  return std::is_sorted(tuples.begin(), tuples.end());
}

/// A bar of tetrahedra with the boundary's faces, some edges and points, all mixed and scrambled.
Mesh bar_with_boundary() {
  Mesh mesh = test::tetrahedral_bar(8);
  mesh.data.clear();
  mesh.sets.clear();
  for (Index i = 0; i < 8; ++i) {
    mesh.cells.push_back(Shape::triangle, std::vector<Index>{4 * i, 4 * i + 4, 4 * i + 5});
    mesh.cells.push_back(Shape::line, std::vector<Index>{4 * i + 1, 4 * i + 5});
    mesh.cells.push_back(Shape::triangle, std::vector<Index>{4 * i, 4 * i + 5, 4 * i + 1});
    mesh.cells.push_back(Shape::vertex, std::vector<Index>{4 * i + 2});
  }
  mesh.cell_blocks.clear();
  apply_reordering(mesh, test::shuffled(mesh.vertex_count(), 1), test::shuffled_cells(mesh, 2));
  return mesh;
}

TEST(MeshOrdering, LowerCellsFollowLexmaxWhateverTheElementsDo) {
  for (const char* of_elements : {"lexmax", "mean", "fiedler-facet", "hilbert", "scrambled"}) {
    Mesh mesh = bar_with_boundary();
    reorder(mesh, methods("rcm", of_elements));
    for (int d = 0; d < 3; ++d) EXPECT_TRUE(in_lexmax_order(mesh, d, 0, mesh.cell_count())) << of_elements;
    const bool elements_too = in_lexmax_order(mesh, 3, 0, mesh.cell_count());
    EXPECT_TRUE(elements_too || std::string(of_elements) != "lexmax");
    EXPECT_FALSE(elements_too && std::string(of_elements) == "scrambled");
  }
}

TEST(MeshOrdering, CellsKeepToTheirBlocksAndDimensions) {
  Mesh mesh = test::mixed_mesh();
  mesh.cell_blocks = {0, 5, 5, 22, 40};
  const Mesh before = mesh;
  const MeshOrder result = reorder(mesh, methods("fiedler", "lexmax"));
  EXPECT_FALSE(result.cells.permutation.is_identity());
  const std::vector<Index> ends{5, 5, 22, 40, mesh.cell_count()};
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto block = [&](Index cell) {
      return std::upper_bound(ends.begin(), ends.end(), cell) - ends.begin();
    };
    EXPECT_EQ(block(result.cells.permutation.old_to_new()[c]), block(c));
    EXPECT_EQ(dimension(mesh.cells.shapes[c]), dimension(before.cells.shapes[c]));
  }
  for (std::size_t b = 0; b < ends.size(); ++b) {
    for (int d = 0; d <= 3; ++d) EXPECT_TRUE(in_lexmax_order(mesh, d, before.cell_blocks[b], ends[b]));
  }
  EXPECT_EQ(mesh.cell_blocks, before.cell_blocks);
}

TEST(MeshOrdering, OriginalAndOriginalIsTheIdentity) {
  Mesh mesh = bar_with_boundary();
  const Mesh before = mesh;
  const MeshOrder result = reorder(mesh, methods("original", "original"));
  EXPECT_TRUE(result.vertices.permutation.is_identity());
  EXPECT_TRUE(result.cells.permutation.is_identity());
  test::expect_same(mesh, before);
}

TEST(MeshOrdering, UnusedVerticesComeLastInOldOrder) {
  Mesh mesh;
  mesh.points.resize(12);
  for (Index v = 0; v < 12; ++v) mesh.points[v] = {1.0 * v, 0.5 * (v % 3), 0.25 * (v % 5)};
  mesh.cells.push_back(Shape::tetrahedron, std::vector<Index>{1, 3, 4, 6});
  mesh.cells.push_back(Shape::tetrahedron, std::vector<Index>{3, 4, 6, 9});
  mesh.cells.push_back(Shape::triangle, std::vector<Index>{0, 2, 9});  // lower dimension: 0 and 2 stay unused
  for (const MethodInfo& method : vertex_methods()) {
    if (method.name == "original") continue;
    const CsrGraph graph = vertex_graph(mesh);
    const MeshOrder result = compute_reordering(mesh, graph, methods(std::string(method.name), "lexmax"));
    const std::vector<Index> last(result.vertices.permutation.new_to_old().begin() + 5,
                                  result.vertices.permutation.new_to_old().end());
    EXPECT_EQ(last, (std::vector<Index>{0, 2, 5, 7, 8, 10, 11})) << method.name;
  }
}

TEST(MeshOrdering, IsTheSameTwice) {
  const Mesh mesh = bar_with_boundary();
  const CsrGraph graph = vertex_graph(mesh);
  for (const MethodInfo& method : vertex_methods()) {
    const ReorderOptions options = methods(std::string(method.name), "fiedler");
    const MeshOrder once = compute_reordering(mesh, graph, options);
    const MeshOrder again = compute_reordering(mesh, graph, options);
    EXPECT_EQ(once.vertices.permutation, again.vertices.permutation) << method.name;
    EXPECT_EQ(once.cells.permutation, again.cells.permutation) << method.name;
  }
}

TEST(MeshOrdering, InStepsIsTheSameAndGoesByTheGivenGraph) {
  const Mesh original = bar_with_boundary();
  ReorderOptions options = methods("rcm", "lexmax");
  options.format = "tetgen";  // this format sorts the cells first
  const Format& to = format_named(options.format);
  Mesh expected = original;
  const MeshOrder computed = reorder(expected, options);
  const auto reordered = [&](Mesh& mesh, const CsrGraph& graph) {
    const std::optional<Permutation> arranged = arrange_cells(mesh, to);
    MeshOrder order = compute_order_in_file(mesh, graph, options);
    EXPECT_EQ(mesh.points, original.points);  // no vertex has moved yet
    order.cells.permutation = move_in_file(mesh, order.vertices.permutation,
                                           std::move(order.cells.permutation), &to, arranged, options.ids);
    return order;
  };
  Mesh mesh = original;
  const MeshOrder given = reordered(mesh, vertex_graph(original));
  EXPECT_EQ(given.vertices.permutation, computed.vertices.permutation);
  EXPECT_EQ(given.cells.permutation, computed.cells.permutation);
  test::expect_same(mesh, expected);
  // a given graph is not replaced, even if it has no edges
  const CsrGraph without_edges{std::vector<Offset>(original.points.size() + 1, 0), {}};
  mesh = original;
  EXPECT_NE(reordered(mesh, without_edges).vertices.permutation, computed.vertices.permutation);
}

TEST(MeshOrdering, GroupsOfCellsStayTheirsWhereTheFormatSortsCells) {
  Mesh mesh = bar_with_boundary();
  std::vector<int> groups;
  for (Index c = 0; c < mesh.cell_count(); ++c) groups.push_back(c % 3);
  ReorderOptions options = methods("rcm", "lexmax");
  options.format = "tetgen";
  options.order.cell_groups = groups;
  const MeshOrder order = reorder(mesh, options);
  std::map<Shape, int> last;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const int group = groups[order.cells.permutation.new_to_old()[c]];
    EXPECT_LE(last[mesh.cells.shapes[c]], group) << c;
    last[mesh.cells.shapes[c]] = group;
  }
}

TEST(MeshOrdering, EveryPairOfMethodsGivesASoundMeshThatTheInverseRestores) {
  for (const Mesh& original : {test::mixed_mesh(), bar_with_boundary(), Mesh{}}) {
    const CsrGraph graph = vertex_graph(original);
    for (const MethodInfo& of_vertices : vertex_methods()) {
      for (const MethodInfo& of_elements : element_methods()) {
        SCOPED_TRACE(std::string(of_vertices.name) + " and " + std::string(of_elements.name));
        const ReorderOptions options = methods(std::string(of_vertices.name), std::string(of_elements.name));
        Mesh mesh = original;
        const MeshOrder applied = reorder(mesh, options);
        check_mesh(mesh);
        const MeshOrder computed = compute_reordering(original, graph, options);
        EXPECT_EQ(computed.vertices.permutation, applied.vertices.permutation);
        EXPECT_EQ(computed.cells.permutation, applied.cells.permutation);
        apply_reordering(mesh, applied.vertices.permutation.inverse(), applied.cells.permutation.inverse());
        test::expect_same(mesh, original);
      }
    }
  }
}

TEST(MeshOrdering, ReportsHowTheEigensolverFared) {
  Mesh mesh = bar_with_boundary();
  const MeshOrder both = reorder(mesh, methods("fiedler", "fiedler"));
  ASSERT_EQ(both.vertices.fiedler.size(), 1U);
  ASSERT_EQ(both.cells.fiedler.size(), 1U);
  EXPECT_EQ(both.vertices.fiedler[0].size, mesh.vertex_count());
  EXPECT_EQ(both.cells.fiedler[0].size, 48);
  EXPECT_TRUE(both.vertices.fiedler[0].converged && both.cells.fiedler[0].converged);
  const MeshOrder neither = reorder(mesh, methods("rcm", "lexmax"));
  EXPECT_TRUE(neither.vertices.fiedler.empty());
  EXPECT_TRUE(neither.cells.fiedler.empty());
}

TEST(MeshOrdering, ShortensTheSpansOfAScrambledBar) {
  Mesh mesh = bar_with_boundary();
  const auto mean_span = [&] {
    return edge_span(vertex_graph(mesh), Permutation::identity(mesh.vertex_count())).mean;
  };
  const double scrambled = mean_span();
  reorder(mesh);
  EXPECT_LT(mean_span(), 4.5);
  EXPECT_GT(scrambled, 8);
}

TEST(MeshOrdering, RefusesUnknownMethodsAndLeavesTheMesh) {
  Mesh mesh = bar_with_boundary();
  const Mesh before = mesh;
  EXPECT_THROW(reorder(mesh, methods("alphabetical", "lexmax")), InvalidArgument);
  EXPECT_THROW(reorder(mesh, methods("fiedler", "alphabetical")), InvalidArgument);
  test::expect_same(mesh, before);
}

}  // namespace
}  // namespace meshorder
