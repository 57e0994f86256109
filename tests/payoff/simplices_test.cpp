// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/reorder.hpp"
#include "payoff/deformed.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace meshorder {
namespace {

double volume(const RestShapes& rest, Offset s) {
  return rest.geometry[(s / kBatch * rest.quantities() + rest.quantities() - 1) * kBatch + s % kBatch];
}

double total_volume(const RestShapes& rest) {
  double sum = 0.0;
  for (Offset s = 0; s < rest.count; ++s) sum += volume(rest, s);
  return sum;
}

/// One cell on all the points.
Mesh single_cell(Shape shape, std::vector<Point> points) {
  Mesh mesh;
  mesh.points = std::move(points);
  std::vector<Index> vertices(mesh.points.size());
  std::iota(vertices.begin(), vertices.end(), Index{0});
  mesh.cells.push_back(shape, vertices);
  return mesh;
}

struct Solid {
  Shape shape;
  std::vector<Point> points;
  Offset pieces;
  double volume;
};

TEST(CutIntoSimplices, FillsEveryCell) {
  const std::vector<Solid> solids{
      {Shape::line, {{0, 0, 0}, {0, 3, 4}}, 1, 5.0},
      {Shape::polyline, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}, 3, 3.0},
      {Shape::triangle, {{0, 0, 1}, {2, 0, 1}, {0, 2, 1}}, 1, 2.0},
      {Shape::quad, {{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {0, 0, 1}}, 2, 2.0},
      {Shape::polygon, {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}}, 3, 5.0},
      {Shape::triangle_strip, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}}, 3, 1.5},
      {Shape::tetrahedron, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1, 1.0 / 6},
      {Shape::pyramid, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 3}}, 2, 1.0},
      {Shape::wedge, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}}, 3, 1.0},
      {Shape::hexahedron,
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
       6,
       1.0}};
  for (const Solid& solid : solids) {
    SCOPED_TRACE(to_string(solid.shape));
    const Mesh mesh = single_cell(solid.shape, solid.points);
    const Simplices simplices = cut_into_simplices(mesh);
    EXPECT_EQ(simplices.dimension, dimension(solid.shape));
    EXPECT_EQ(simplices.size(), solid.pieces);
    EXPECT_NEAR(total_volume(rest_shapes(simplices, mesh.points)), solid.volume, 1e-14);
  }
}

TEST(CutIntoSimplices, PiecesOfASolidDoNotOverlap) {
  // volumes with their signs add up to the volume only when no piece is turned inside out
  Mesh mesh = single_cell(Shape::wedge, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
  std::vector<Index> hexahedron{6, 7, 8, 9, 10, 11, 12, 13};
  for (const Point& p : std::vector<Point>{
           {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}) {
    mesh.points.push_back(p);
  }
  mesh.cells.push_back(Shape::hexahedron, hexahedron);
  const Simplices simplices = cut_into_simplices(mesh);
  for (Offset s = 0; s < simplices.size(); ++s) {
    Point e[3];
    for (int a = 0; a < 3; ++a) {
      for (int c = 0; c < 3; ++c) {
        e[a][c] =
            mesh.points[simplices.vertices[4 * s + a + 1]][c] - mesh.points[simplices.vertices[4 * s]][c];
      }
    }
    const double determinant = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                               e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                               e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    EXPECT_GT(determinant, 0.1) << "simplex " << s;
  }
}

TEST(CutIntoSimplices, TakesCornersOfTheHighestCellsInTheirOrder) {
  const Mesh mesh = test::mixed_mesh();
  const Simplices simplices = cut_into_simplices(mesh);
  EXPECT_EQ(simplices.dimension, 3);
  std::vector<Index> tetrahedra;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (mesh.cells.shapes[c] == Shape::tetrahedron) {
      tetrahedra.insert(tetrahedra.end(), mesh.cells[c].begin(), mesh.cells[c].begin() + 4);
    }
  }
  // a round of mixed_mesh: tetrahedron, pyramid, wedge, hexahedron, linear and then quadratic ones
  // (pyramid, two wedges and two hexahedra)
  EXPECT_EQ(simplices.size(), 3 * ((1 + 2 + 3 + 6) + (1 + 2 + 2 * 3 + 2 * 6)));
  const std::vector<Index> first(simplices.vertices.begin(), simplices.vertices.begin() + 4);
  const std::vector<Index> linear(tetrahedra.begin(), tetrahedra.begin() + 4);
  const std::vector<Index> quadratic(tetrahedra.begin() + 4, tetrahedra.begin() + 8);
  EXPECT_EQ(first, linear);
  EXPECT_EQ(std::vector<Index>(simplices.vertices.begin() + 48, simplices.vertices.begin() + 52), quadratic);
}

TEST(CutIntoSimplices, ReturnsTheCellOfEachSimplex) {
  const Mesh mesh = test::mixed_mesh();
  const Simplices simplices = cut_into_simplices(mesh);
  ASSERT_EQ(static_cast<Offset>(simplices.cells.size()), simplices.size());
  EXPECT_TRUE(std::is_sorted(simplices.cells.begin(), simplices.cells.end()));
  for (Offset s = 0; s < simplices.size(); ++s) {
    const auto cell = mesh.cells[simplices.cells[s]];
    for (int a = 0; a < 4; ++a) {
      EXPECT_NE(std::find(cell.begin(), cell.end(), simplices.vertices[4 * s + a]), cell.end());
    }
  }
}

TEST(CutIntoSimplices, FindsNoneInAMeshOfPoints) {
  const Mesh points = test::cells_of_type(Shape::vertex, 1, 3);
  EXPECT_EQ(rest_shapes(cut_into_simplices(points), points.points).count, 0);
  EXPECT_EQ(rest_shapes(cut_into_simplices(Mesh{}), {}).count, 0);
}

std::vector<Index> corners_of(SimplicesRef simplices) {
  return {simplices.vertices.begin(), simplices.vertices.end()};
}

TEST(CellSimplices, AreThoseThatTheCellsAreCutInto) {
  for (const Mesh& mesh :
       {test::mixed_mesh(), test::tetrahedral_bar(4), Mesh{}, test::cells_of_type(Shape::vertex, 1, 3),
        test::cells_of_type(Shape::hexahedron, 8, 3), test::cells_of_type(Shape::tetrahedron, 10, 3)}) {
    const Simplices cut = cut_into_simplices(mesh);
    const CellSimplices simplices(mesh);
    EXPECT_EQ(simplices.size(), cut.size());
    EXPECT_EQ(SimplicesRef(simplices).dimension, cut.dimension);
    EXPECT_EQ(corners_of(simplices), cut.vertices);
  }
}

TEST(CellSimplices, AreTheArrayOfAMeshOfTetrahedra) {
  const Mesh mesh = test::tetrahedral_bar(4);
  const CellSimplices simplices(mesh);
  EXPECT_EQ(SimplicesRef(simplices).vertices.data(), mesh.cells.vertices.data());
}

TEST(CellSimplices, MoveWithTheirCells) {
  for (Mesh mesh : {test::mixed_mesh(), test::tetrahedral_bar(30), Mesh{}}) {
    const Permutation vertices = test::shuffled(mesh.vertex_count(), 1);
    const Permutation cells = test::shuffled_cells(mesh, 2);
    const CellSimplices moved = CellSimplices(mesh).moved(vertices, cells);
    move_mesh(mesh, vertices, cells, Ids::keep);
    EXPECT_EQ(corners_of(moved), cut_into_simplices(mesh).vertices);
    // and moved once more, back
    const CellSimplices back = moved.moved(vertices.inverse(), cells.inverse());
    move_mesh(mesh, vertices.inverse(), cells.inverse(), Ids::keep);
    EXPECT_EQ(corners_of(back), cut_into_simplices(mesh).vertices);
  }
}

TEST(RestShapes, InverseMakesTheRestMetricTheIdentity) {
  for (int d = 1; d <= 3; ++d) {
    SCOPED_TRACE(d);
    const test::Patch patch = test::deformed_patch(d, 19);
    for (Offset s = 0; s < patch.rest.count; ++s) {
      double inverse[3][3] = {};
      int q = 0;
      for (int i = 0; i < d; ++i) {
        for (int j = i; j < d; ++j) {
          inverse[i][j] =
              patch.rest.geometry[(s / kBatch * patch.rest.quantities() + q++) * kBatch + s % kBatch];
        }
      }
      // F = D Dₘ⁻¹ of the rest state is a rotation into the simplex's frame: FᵀF = I
      double f[3][3] = {};
      for (int c = 0; c < 3; ++c) {
        for (int j = 0; j < d; ++j) {
          for (int a = 0; a < d; ++a) {
            const Index* const corner = patch.simplices.vertices.data() + (d + 1) * s;
            f[c][j] += (patch.points[corner[a + 1]][c] - patch.points[corner[0]][c]) * inverse[a][j];
          }
        }
      }
      for (int i = 0; i < d; ++i) {
        for (int j = 0; j < d; ++j) {
          EXPECT_NEAR(f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j], i == j ? 1.0 : 0.0, 1e-12);
        }
      }
    }
  }
}

TEST(RestShapes, TurnTheFrameOfATetrahedronTheRightWay) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0.2, 0}, {0.3, 1, 0}, {0.1, 0.2, 1}};
  // the same corners in both orientations
  const RestShapes rest = rest_shapes(Simplices{3, {0, 1, 2, 3, 0, 2, 1, 3}, {}}, points);
  for (Offset s = 0; s < 2; ++s) {
    // the diagonal of the inverse is its determinant, 1 / (6 · volume with its sign)
    const double diagonal = rest.geometry[s] * rest.geometry[3 * kBatch + s] * rest.geometry[5 * kBatch + s];
    EXPECT_NEAR(diagonal * 6 * volume(rest, s), s == 0 ? 1.0 : -1.0, 1e-14);
    EXPECT_GT(volume(rest, s), 0.1);
  }
}

TEST(RestShapes, FlatSimplicesHaveNoVolumeAndNoNumberIsInfinite) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0}, {0, 0, 1}};
  // flat, one vertex twice, one vertex four times, valid
  const Simplices simplices{3, {0, 1, 2, 3, 0, 1, 1, 4, 2, 2, 2, 2, 0, 1, 2, 4}, {}};
  const RestShapes rest = rest_shapes(simplices, points);
  for (const double value : rest.geometry) EXPECT_TRUE(std::isfinite(value));
  for (Offset s = 0; s < 3; ++s) EXPECT_EQ(volume(rest, s), 0.0);
  EXPECT_NEAR(volume(rest, 3), 1.0 / 6, 1e-15);
}

TEST(RestShapes, FillsTheLastBatchWithNothing) {
  const test::Patch patch = test::deformed_patch(3, 11);
  EXPECT_EQ(patch.rest.batches(), 2);
  for (Offset s = 11; s < 16; ++s) EXPECT_EQ(volume(patch.rest, s), 0.0);
  for (const Index v : patch.rest.vertices) {
    EXPECT_GE(v, 0);
    EXPECT_LT(v, index_size(patch.points));
  }
}

}  // namespace
}  // namespace meshorder
