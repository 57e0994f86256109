// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"

#include "base/point.hpp"
#include "graph/join_limit.hpp"
#include "mesh/procedural.hpp"
#include "mesh/simplices.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace meshorder {
namespace {

using Pairs = std::set<std::pair<Index, Index>>;

struct Cell {
  Shape shape;
  std::vector<Index> vertices;
};

Mesh mesh_of(const std::vector<Cell>& cells) {
  Mesh mesh;
  Index last = -1;
  for (const Cell& cell : cells) {
    mesh.cells.push_back(cell.shape, cell.vertices);
    for (const Index v : cell.vertices) last = std::max(last, v);
  }
  mesh.points.resize(static_cast<std::size_t>(last) + 1);
  return mesh;
}

/// The edges of a graph, smaller end first.
Pairs edges_of(const CsrGraph& graph) {
  test::check_graph(graph);
  Pairs result;
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) result.insert(std::minmax(u, v));
  }
  return result;
}

Pairs facet_neighbours(const std::vector<Cell>& cells) { return edges_of(facet_graph(mesh_of(cells))); }

/// Pairs of elements that share a facet, by comparing every facet of every pair as sets of vertices.
Pairs sharing_a_facet(const Mesh& mesh) {
  const CellArrays cells = cell_arrays(mesh);
  const CellSelection top = CellSelection::elements(cells);
  std::vector<std::set<std::set<Index>>> facet_sets(static_cast<std::size_t>(top.size()));
  for (Index e = 0; e < top.size(); ++e) {
    const Index c = top.cell(e);
    for (const auto& positions : facets(mesh.cells.shapes[c], mesh.cells.vertex_count(c))) {
      std::set<Index> corners;
      for (const int k : positions) corners.insert(mesh.cells[c][k]);
      facet_sets[e].insert(corners);
    }
  }
  Pairs result;
  for (Index e = 0; e < top.size(); ++e) {
    for (Index f = e + 1; f < top.size(); ++f) {
      const bool share = std::any_of(facet_sets[e].begin(), facet_sets[e].end(),
                                     [&](const auto& facet) { return facet_sets[f].contains(facet); });
      if (share) result.emplace(static_cast<Index>(e), static_cast<Index>(f));
    }
  }
  return result;
}

TEST(MeshVertexGraph, JoinsExactlyThePairsOfACommonElement) {
  const Mesh mesh = test::mixed_mesh();
  Pairs expected;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (dimension(mesh.cells.shapes[c]) != 3) continue;
    for (const Index a : mesh.cells[c]) {
      for (const Index b : mesh.cells[c]) {
        if (a < b) expected.emplace(a, b);
      }
    }
  }
  const CsrGraph graph = vertex_graph(mesh);
  EXPECT_EQ(graph.size(), mesh.vertex_count());
  EXPECT_EQ(edges_of(graph), expected);
}

TEST(MeshVertexGraph, LeavesVerticesOfLowerCellsAlone) {
  const Mesh mesh =
      mesh_of({{Shape::tetrahedron, {0, 1, 2, 3}}, {Shape::triangle, {3, 4, 5}}, {Shape::line, {5, 0}}});
  EXPECT_EQ(edges_of(vertex_graph(mesh)), (Pairs{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}));
  EXPECT_EQ(vertex_graph(mesh).degree(4), 0);
}

TEST(MeshVertexGraph, OfNoCellsHasNoEdges) {
  Mesh mesh;
  mesh.points.resize(3);
  EXPECT_EQ(vertex_graph(mesh).size(), 3);
  EXPECT_EQ(vertex_graph(mesh).edge_count(), 0);
  EXPECT_EQ(facet_graph(mesh).size(), 0);
  EXPECT_EQ(vertex_graph(Mesh{}).size(), 0);
}

TEST(MeshVertexGraph, JoinsConsecutivePointsOfAPolyline) {
  EXPECT_EQ(edges_of(vertex_graph(mesh_of({{Shape::polyline, {3, 0, 2, 1}}, {Shape::line, {1, 4}}}))),
            (Pairs{{0, 3}, {0, 2}, {1, 2}, {1, 4}}));
}

TEST(MeshVertexGraph, JoinsTheCornersOfTheTrianglesOfAStrip) {
  EXPECT_EQ(edges_of(vertex_graph(mesh_of({{Shape::triangle_strip, {0, 1, 2, 3, 4}}}))),
            (Pairs{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {2, 4}, {3, 4}}));
}

TEST(MeshVertexGraph, JoinsNoPointsOfACloud) {
  EXPECT_EQ(edges_of(vertex_graph(mesh_of({{Shape::poly_vertex, {0, 1, 2}}}))), Pairs{});
}

TEST(MeshVertexGraph, JoinsAllVerticesOfACellOrThoseOfItsSimplices) {
  for (const Shape shape : {Shape::polygon, Shape::polyhedron}) {
    for (const Index size : {5, 64, 65, 1000}) {
      std::vector<Index> vertices(static_cast<std::size_t>(size));
      std::iota(vertices.begin(), vertices.end(), 0);
      const Mesh mesh = mesh_of({{shape, vertices}});
      const Simplices cut = cut_into_simplices(mesh);
      Pairs of_cut;
      for (Offset s = 0; s < cut.size(); ++s) {
        const std::span corners = std::span(cut.vertices).subspan((cut.dimension + 1) * s, cut.dimension + 1);
        for (const Index a : corners) {
          for (const Index b : corners) {
            if (a < b) of_cut.emplace(a, b);
          }
        }
      }
      const Pairs joined = edges_of(vertex_graph(mesh));
      if (size <= 64) {
        EXPECT_EQ(std::ssize(joined), size * (size - 1) / 2) << to_string(shape) << size;
      } else {
        EXPECT_EQ(joined, of_cut) << to_string(shape) << size;
      }
    }
  }
}

TEST(MeshVertexGraph, OfTooManyPairsIsRefusedWithTheCellThatHasThem) {
  std::vector<Index> nodes(1000);
  std::iota(nodes.begin(), nodes.end(), 0);
  const Mesh mesh = mesh_of({{Shape::line, {0, 1}}, {Shape::hexahedron, nodes}});
  limit_joins(1000 * 999 * kBytesToOrder);
  EXPECT_EQ(vertex_graph(mesh).edge_count(), 1000 * 999 / 2);
  limit_joins(1000 * 999 * kBytesToOrder - 1);
  try {
    (void)vertex_graph(mesh);
    ADD_FAILURE();
  } catch (const TooLarge& error) {
    EXPECT_STREQ(error.what(),
                 "cell 1 has 1000 vertices, each joined to all others: the graph would take 22.87 MiB, more "
                 "than the limit of 22.87 MiB; cut such cells, or raise the memory limit (--limit-memory)");
  }
  limit_joins(UINT64_MAX);
}

TEST(ElementGraph, OfTooManyPairsIsRefusedWithTheVertexThatHasThem) {
  std::vector<Cell> fan;
  for (Index k = 1; k < 100; ++k) fan.push_back({Shape::triangle, {0, k, k + 1}});
  const Mesh mesh = mesh_of(fan);
  const CellArrays cells = cell_arrays(mesh);
  EXPECT_EQ(joined_by_vertex(cells.incidence()).edge_count(), 99 * 98 / 2);
  limit_joins(1000);
  try {
    (void)joined_by_vertex(cells.incidence());
    ADD_FAILURE();
  } catch (const TooLarge& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 26), "vertex 0 has 99 elements, ");
  }
  limit_joins(UINT64_MAX);
}

TEST(Elements, AreTheCellsOfTheHighestDimensionAndLowerCellsTheRest) {
  const Mesh mesh = test::mixed_mesh();
  const CellArrays cells = cell_arrays(mesh);
  const CellSelection top = CellSelection::elements(cells);
  const CellSelection lower = CellSelection::lower_dimensional(cells);
  std::vector<Index> all;
  for (Index e = 0; e < top.size(); ++e) all.push_back(top.cell(e));
  for (Index e = 0; e < lower.size(); ++e) all.push_back(lower.cell(e));
  std::sort(all.begin(), all.end());
  EXPECT_EQ(index_size(all), mesh.cell_count());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
  for (const auto& [part, is_top] : {std::pair(&top, true), std::pair(&lower, false)}) {
    for (Index e = 0; e < part->size(); ++e) {
      const Index c = part->cell(e);
      EXPECT_TRUE(e == 0 || part->cell(e - 1) < c);
      EXPECT_EQ(dimension(mesh.cells.shapes[c]) == 3, is_top);
      EXPECT_TRUE(std::equal(part->incidence()[e].begin(), part->incidence()[e].end(), mesh.cells[c].begin(),
                             mesh.cells[c].end()));
    }
  }
}

TEST(FacetGraph, JoinsTetrahedraThatShareAFaceInAnyOrder) {
  EXPECT_EQ(facet_neighbours({{Shape::tetrahedron, {0, 1, 2, 3}}, {Shape::tetrahedron, {4, 3, 1, 2}}}),
            (Pairs{{0, 1}}));
  // an edge or a vertex in common is not enough
  EXPECT_EQ(facet_neighbours({{Shape::tetrahedron, {0, 1, 2, 3}},
                              {Shape::tetrahedron, {0, 1, 4, 5}},
                              {Shape::tetrahedron, {0, 6, 7, 8}}}),
            Pairs{});
}

TEST(FacetGraph, JoinsVolumesOfDifferentShapes) {
  // a hexahedron, a wedge on its side, a pyramid on its top, a tetrahedron on a side of the pyramid and one
  // on the end of the wedge
  const std::vector<Cell> cells{{Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}},
                                {Shape::wedge, {1, 8, 2, 5, 9, 6}},
                                {Shape::pyramid, {4, 5, 6, 7, 10}},
                                {Shape::tetrahedron, {5, 6, 10, 11}},
                                {Shape::tetrahedron, {5, 9, 6, 12}}};
  EXPECT_EQ(facet_neighbours(cells), (Pairs{{0, 1}, {0, 2}, {1, 4}, {2, 3}}));
}

TEST(FacetGraph, DoesNotTakeATriangleForPartOfAQuad) {
  // three of the four corners of the hexahedron's top
  EXPECT_EQ(
      facet_neighbours({{Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}}, {Shape::tetrahedron, {4, 5, 6, 8}}}),
      Pairs{});
}

TEST(FacetGraph, JoinsSurfacesAlongEdges) {
  EXPECT_EQ(facet_neighbours({{Shape::triangle, {0, 1, 2}},
                              {Shape::quad, {1, 3, 4, 2}},
                              {Shape::polygon, {3, 5, 6, 7, 4}},
                              {Shape::triangle, {0, 8, 9}},
                              {Shape::triangle_strip, {5, 3, 10, 11}}}),
            (Pairs{{0, 1}, {1, 2}, {2, 4}}));
}

TEST(FacetGraph, JoinsLinesAtTheirEnds) {
  EXPECT_EQ(facet_neighbours({{Shape::line, {0, 1}},
                              {Shape::line, {2, 1}},
                              {Shape::polyline, {2, 3, 4}},
                              {Shape::line, {3, 5}}}),
            (Pairs{{0, 1}, {1, 2}}));
}

TEST(FacetGraph, ChainsTheElementsOfANonManifoldFacet) {
  // four triangles around one edge: each is joined to the next, which keeps them together
  EXPECT_EQ(facet_neighbours({{Shape::triangle, {0, 1, 2}},
                              {Shape::triangle, {1, 0, 3}},
                              {Shape::triangle, {4, 1, 0}},
                              {Shape::triangle, {0, 5, 1}}}),
            (Pairs{{0, 1}, {1, 2}, {2, 3}}));
}

TEST(FacetGraph, ComparesCornersOfSecondOrderCells) {
  EXPECT_EQ(facet_neighbours({{Shape::tetrahedron, {0, 1, 2, 3, 10, 11, 12, 13, 14, 15}},
                              {Shape::tetrahedron, {1, 2, 3, 4}}}),
            (Pairs{{0, 1}}));
  EXPECT_EQ(
      facet_neighbours({{Shape::triangle, {0, 1, 2, 5, 6, 7}}, {Shape::quad, {1, 0, 3, 4, 8, 9, 10, 11}}}),
      (Pairs{{0, 1}}));
  // midpoints are no corners
  EXPECT_EQ(facet_neighbours({{Shape::triangle, {0, 1, 2, 5, 6, 7}}, {Shape::triangle, {5, 6, 3}}}), Pairs{});
}

TEST(FacetGraph, JoinsPolyhedraByThreeVertices) {
  const Cell prism{Shape::polyhedron, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}};
  EXPECT_EQ(facet_neighbours({prism, {Shape::polyhedron, {9, 3, 11, 12, 0}}}), (Pairs{{0, 1}}));
  EXPECT_EQ(facet_neighbours({prism, {Shape::polyhedron, {9, 3, 11, 12, 13}}}), Pairs{});
  EXPECT_EQ(
      facet_neighbours({{Shape::tetrahedron, {4, 5, 20, 6}}, prism, {Shape::tetrahedron, {20, 4, 6, 21}}}),
      (Pairs{{0, 1}, {0, 2}}));
}

TEST(FacetGraph, DoesNotCountVerticesOfVeryManyPolyhedra) {
  const auto around_one_vertex = [](Index count) {
    std::vector<Cell> cells;
    for (Index c = 0; c < count; ++c) {
      cells.push_back({Shape::polyhedron, {0, 1 + 2 * c, 2 + 2 * c, 3 + 2 * c, 4 + 2 * c}});
    }
    return facet_neighbours(cells).size();
  };
  EXPECT_EQ(around_one_vertex(1024), 1023U);
  EXPECT_EQ(around_one_vertex(1025), 0U);
}

TEST(FacetGraph, LeavesOutLowerCells) {
  const Mesh mesh = mesh_of({{Shape::triangle, {0, 1, 2}},
                             {Shape::tetrahedron, {0, 1, 2, 3}},
                             {Shape::triangle, {1, 2, 3}},
                             {Shape::tetrahedron, {1, 2, 3, 4}}});
  EXPECT_EQ(facet_graph(mesh).size(), 2);
  EXPECT_EQ(edges_of(facet_graph(mesh)), (Pairs{{0, 1}}));
}

TEST(FacetGraph, OfDegenerateAndRepeatedCellsHasNoLoops) {
  EXPECT_EQ(facet_neighbours(
                {{Shape::triangle, {0, 0, 0}}, {Shape::triangle, {1, 1, 2}}, {Shape::triangle, {2, 1, 1}}}),
            (Pairs{{1, 2}}));
  EXPECT_EQ(facet_neighbours({{Shape::triangle_strip, {0}}}), Pairs{});
  EXPECT_EQ(facet_neighbours({{Shape::polyline, {0}}, {Shape::polyline, {0, 1, 0}}}), (Pairs{{0, 1}}));
}

TEST(FacetGraph, IsThatOfAllPairsOnWholeMeshes) {
  for (const Mesh& mesh : {test::tetrahedral_bar(6), test::mixed_mesh(), make_torus({1, 0.1, 0})}) {
    EXPECT_EQ(edges_of(facet_graph(mesh)), sharing_a_facet(mesh));
  }
}

TEST(Facets, BoundEveryVolumeOnceOnEachSide) {
  // in a closed surface each edge occurs once in each direction
  for (const auto& [shape, corners] : test::linear_types()) {
    if (dimension(shape) != 3) continue;
    std::multiset<std::pair<int, int>> walked;
    for (const auto& facet : facets(shape, corners)) {
      for (std::size_t k = 0; k < facet.size(); ++k) walked.emplace(facet[k], facet[(k + 1) % facet.size()]);
    }
    for (const auto& [from, to] : walked) {
      EXPECT_EQ(walked.count({from, to}), 1U) << to_string(shape);
      EXPECT_EQ(walked.count({to, from}), 1U) << to_string(shape);
    }
  }
}

TEST(Facets, OfVolumesFaceOutward) {
  // the volumes between the origin and the facets add up to the cell's volume; it is positive when the facets
  // face outward
  const std::vector<std::pair<Shape, std::vector<Point>>> cells{
      {Shape::tetrahedron, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {Shape::pyramid, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}}},
      {Shape::wedge, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}},
      {Shape::hexahedron,
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}}};
  for (const auto& [shape, points] : cells) {
    double volume = 0;
    for (const auto& facet : facets(shape, static_cast<int>(points.size()))) {
      for (std::size_t k = 2; k < facet.size(); ++k) {
        volume += dot(points[facet[0]], cross(points[facet[k - 1]], points[facet[k]])) / 6;
      }
    }
    EXPECT_GT(volume, 0.1) << to_string(shape);
  }
}

TEST(Facets, OfATriangleStripAreItsOutline) {
  for (int n = 3; n <= 8; ++n) {
    // edges that only one of the strip's triangles has
    std::multiset<std::set<int>> of_triangles;
    for (int i = 0; i + 2 < n; ++i) {
      of_triangles.insert({i, i + 1});
      of_triangles.insert({i + 1, i + 2});
      of_triangles.insert({i, i + 2});
    }
    std::set<std::set<int>> expected;
    for (const auto& edge : of_triangles) {
      if (of_triangles.count(edge) == 1) expected.insert(edge);
    }
    const auto outline = facets(Shape::triangle_strip, n);
    std::set<std::set<int>> found;
    for (const auto& edge : outline) found.emplace(edge.begin(), edge.end());
    EXPECT_EQ(found, expected) << n;
    EXPECT_EQ(found.size(), outline.size()) << n;
  }
}

}  // namespace
}  // namespace meshorder
