// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/band.hpp"

#include "kernels/simplices.hpp"
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "payoff/kernel_bench.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

/// Tetrahedra, triangles, hexahedra and quadratic cells, with and without unused vertices.
std::vector<Mesh> some_meshes() {
  std::vector<Mesh> meshes{test::tetrahedral_bar(40),
                           test::mixed_mesh(),
                           test::cells_of_type(Shape::tetrahedron, 4, 30),
                           test::cells_of_type(Shape::tetrahedron, 10, 12),
                           test::cells_of_type(Shape::hexahedron, 8, 9),
                           test::cells_of_type(Shape::quad, 4, 11),
                           test::cells_of_type(Shape::line, 2, 7)};
  meshes.push_back(test::tetrahedral_bar(10));
  meshes.back().points.resize(meshes.back().points.size() + 13, Point{});
  Mesh surface;  // a triangulated strip
  for (Index v = 0; v < 60; ++v) surface.points.push_back({0.5 * v, 1.0 * (v % 2), 0.1 * (v % 3)});
  for (Index v = 0; v + 2 < 60; ++v) surface.cells.push_back(Shape::triangle, std::vector{v, v + 1, v + 2});
  meshes.push_back(surface);
  return meshes;
}

TEST(IdealBand, HasTheVerticesEdgesAndSimplicesOfTheMesh) {
  for (const Mesh& mesh : some_meshes()) {
    const CsrGraph graph = vertex_graph(mesh);
    const Band band = ideal_band(cut_into_simplices(mesh), graph);
    check_mesh(band.mesh);
    test::check_graph(band.graph);
    EXPECT_EQ(band.mesh.vertex_count(), mesh.vertex_count());
    EXPECT_EQ(band.graph.size(), mesh.vertex_count());
    EXPECT_EQ(band.graph.edge_count(), graph.edge_count());
    EXPECT_EQ(Offset{band.mesh.cell_count()}, cut_into_simplices(mesh).size());
    EXPECT_EQ(cut_into_simplices(band.mesh).dimension, mesh.cells.highest_dimension());
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const auto isolated = [](const CsrGraph& g, Index i) { return g.degree(i) == 0; };
      if (isolated(band.graph, v) && v + 1 < mesh.vertex_count()) {
        EXPECT_TRUE(isolated(band.graph, v + 1)) << v;
      }
    }
  }
}

TEST(IdealBand, JoinsEachVertexToItsNearestOnes) {
  const Mesh mesh = test::tetrahedral_bar(40);
  const CsrGraph graph = vertex_graph(mesh);
  const Band band = ideal_band(cut_into_simplices(mesh), graph);
  // each vertex is joined to the next k or k + 1 ones, where k is the rounded-down mean number of edges per
  // vertex
  const auto k = static_cast<Index>(graph.edge_count() / graph.size());
  for (Index v = 0; v + k + 1 < band.graph.size(); ++v) {
    const auto row = band.graph[v];
    const auto after = static_cast<Index>(row.end() - std::upper_bound(row.begin(), row.end(), v));
    EXPECT_GE(after, k) << v;
    EXPECT_LE(after, k + 1) << v;
    EXPECT_EQ(row.back(), v + after) << v;
  }
}

TEST(IdealBand, RunsThroughTheVerticesInSimplicesThatUseTheEdges) {
  const Mesh mesh = make_grid({.size = 12});
  const CsrGraph graph = vertex_graph(mesh);
  const Band band = ideal_band(cut_into_simplices(mesh), graph);
  const auto k = static_cast<Index>(graph.edge_count() / graph.size());
  EXPECT_EQ(band.mesh.cells[0].front(), 0);
  EXPECT_GE(band.mesh.cells[band.mesh.cell_count() - 1].back(), mesh.vertex_count() - 1 - k);
  for (Index c = 0; c < band.mesh.cell_count(); ++c) {
    const auto cell = band.mesh.cells[c];
    for (int a = 1; a < 4; ++a) EXPECT_GT(cell[a], cell[a - 1]);
    EXPECT_LE(cell[3], cell[0] + k);
    if (c > 0) {
      EXPECT_GE(cell[0], band.mesh.cells[c - 1][0]);
      EXPECT_LE(cell[0], band.mesh.cells[c - 1][0] + 1);
    }
  }
  const CsrGraph of_simplices = vertex_graph(band.mesh);
  EXPECT_GT(of_simplices.edge_count(), graph.edge_count() * 8 / 10);
  EXPECT_LE(of_simplices.edge_count(), graph.edge_count());
}

TEST(IdealBand, IsAProblemForEveryKernel) {
  for (const Mesh& mesh : some_meshes()) {
    const Band band = ideal_band(cut_into_simplices(mesh), vertex_graph(mesh));
    const auto bench = prepare_kernels(KernelSet::plain, band.mesh, band.graph);
    for (const Kernel kernel : kKernels) {
      bench->run(kernel);
      double largest = 0.0;
      for (const double value : bench->result(kernel)) {
        ASSERT_TRUE(std::isfinite(value));
        largest = std::max(largest, std::abs(value));
      }
      EXPECT_GT(largest, 0.0) << to_string(kernel);
    }
    // no simplex is flat
    const RestShapes rest = rest_shapes(cut_into_simplices(band.mesh), band.mesh.points);
    for (Offset s = 0; s < rest.count; ++s) {
      const Offset volume = rest.quantities() * (s / kBatch + 1) - 1;
      EXPECT_GT(rest.geometry[volume * kBatch + s % kBatch], 0.0);
    }
  }
}

TEST(IdealBand, TakesDegenerateMeshes) {
  EXPECT_EQ(ideal_band({}, CsrGraph{}).mesh.vertex_count(), 0);
  Mesh point;
  point.points.resize(3);
  point.cells.push_back(Shape::triangle, std::vector<Index>{1, 1, 1});
  const Band band = ideal_band(cut_into_simplices(point), vertex_graph(point));
  check_mesh(band.mesh);
  EXPECT_EQ(band.mesh.cell_count(), 1);
  const auto bench = prepare_kernels(KernelSet::plain, band.mesh, band.graph);
  for (const Kernel kernel : kKernels) bench->run(kernel);
}

}  // namespace
}  // namespace meshorder
