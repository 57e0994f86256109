// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/global_graph.hpp"

#include "distributed/order/curve.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "slices.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

namespace meshorder::distributed {
namespace {

/// The rows of all ranks as a graph, at the root.
CsrGraph gathered(const Communicator& communicator, const GlobalGraph& graph) {
  std::vector<Offset> degrees;
  for (Offset row = 0; row < graph.rows.size(); ++row) degrees.push_back(std::ssize(graph.rows[row]));
  CsrGraph all;
  for (const Offset degree : communicator.gathered_at_root(degrees))
    all.offsets.push_back(all.offsets.back() + degree);
  for (const GlobalIndex vertex : communicator.gathered_at_root(graph.rows.entries))
    all.neighbours.push_back(static_cast<Index>(vertex - graph.layout.begin(0)));
  return all;
}

class Shifted : public testing::TestWithParam<GlobalIndex> {};

TEST_P(Shifted, RowsAreThoseOfTheSerialGraph) {
  const Communicator communicator;
  const GlobalIndex shift = GetParam();
  for (const Mesh& mesh : {make_ball({.size = 6}), test::mixed_mesh(), test::triangles_and_line(1)}) {
    const MeshSlice slice = scattered(communicator, mesh);
    std::vector<GlobalIndex> starts;
    for (int rank = 0; rank <= communicator.size(); ++rank)
      starts.push_back(shift + mesh.vertex_count() * rank / communicator.size());
    const GlobalGraph graph =
        global_graph(communicator, Layout(starts), test::elements_of(communicator, slice, shift));
    const CsrGraph all = gathered(communicator, graph);
    EXPECT_EQ(all, communicator.is_root() ? vertex_graph(mesh) : CsrGraph());
    for (const GlobalIndex ghost : ghosts(graph, communicator.rank()))
      EXPECT_NE(graph.layout.owner(ghost), communicator.rank());
  }
}

INSTANTIATE_TEST_SUITE_P(Numbers, Shifted, testing::Values(0, GlobalIndex{1} << 33));

TEST(MeshSlice, HoldsTheMeshInPieces) {
  const Communicator communicator;
  const Mesh mesh = communicator.is_root() ? test::mixed_mesh() : Mesh();
  const MeshSlice slice = scattered(communicator, mesh);
  const std::vector<Point> points = communicator.gathered_at_root(slice.points);
  const std::vector<Shape> shapes = communicator.gathered_at_root(slice.shapes);
  const std::vector<GlobalIndex> vertices = communicator.gathered_at_root(slice.cell_vertices.entries);
  if (!communicator.is_root()) return;
  EXPECT_EQ(points, mesh.points);
  EXPECT_EQ(shapes, mesh.cells.shapes);
  EXPECT_TRUE(
      std::equal(vertices.begin(), vertices.end(), mesh.cells.vertices.begin(), mesh.cells.vertices.end()));
}

TEST(Curve, IsTheSerialHilbertOrder) {
  const Communicator communicator;
  const Mesh mesh = make_ball({.size = 8});
  const MeshSlice slice = scattered(communicator, mesh);
  const Curve curve = along_hilbert_curve(communicator, slice.vertices, slice.points,
                                          std::vector<char>(slice.points.size(), 1));
  const CsrGraph graph = vertex_graph(mesh);
  const Permutation serial =
      order_vertices({graph.offsets, graph.neighbours}, "hilbert", {}, mesh.points).permutation;
  const std::vector<GlobalIndex> numbers = communicator.gathered_at_root(curve.number_of);
  if (communicator.is_root()) {
    EXPECT_TRUE(
        std::equal(numbers.begin(), numbers.end(), serial.old_to_new().begin(), serial.old_to_new().end()));
  }
  for (std::size_t k = 0; k < curve.points.size(); ++k)
    EXPECT_EQ(curve.points[k], mesh.points[static_cast<std::size_t>(curve.number_in_file[k])]);
}

TEST(Curve, NumbersWhatNothingUsesLastInTheFilesOrder) {
  const Communicator communicator;
  const Mesh mesh = make_grid({.size = 4});
  const MeshSlice slice = scattered(communicator, mesh);
  std::vector<char> used;
  for (GlobalIndex v = slice.vertices.begin(communicator.rank()); v < slice.vertices.end(communicator.rank());
       ++v)
    used.push_back(v % 3 != 0);
  const Curve curve = along_hilbert_curve(communicator, slice.vertices, slice.points, used);
  EXPECT_EQ(curve.layout.size(), 125 - 42);
  GlobalIndex vertex = slice.vertices.begin(communicator.rank());
  for (const GlobalIndex number : curve.number_of) {
    EXPECT_EQ(number >= 83, vertex % 3 == 0);
    EXPECT_TRUE(number < 83 || number == 83 + vertex / 3) << vertex;
    ++vertex;
  }
}

}  // namespace
}  // namespace meshorder::distributed
