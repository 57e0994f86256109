// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// For the tests that link VTK.
#pragma once

#include "support/sample_meshes.hpp"
#include <meshorder/mesh.hpp>

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::test {

/// One cell of each linear volume type and a second wedge, in version 2.2 of Gmsh's format. No face is
/// exactly plane, and no coordinate occurs twice in a cell.
inline const std::string kVolumesOfGmsh = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
18
1 0 0.01 0.02
2 1 0.03 -0.01
3 1.04 1 0.05
4 0.06 1.02 0
5 0.02 -0.03 1
6 1.01 0.04 1.03
7 1.05 1.03 0.98
8 -0.02 0.99 1.04
9 0.4 0.6 2.1
10 3 0 0
11 4.1 0.1 0.2
12 3.2 1.1 -0.1
13 3.1 0.2 1.2
14 4 -0.1 1.1
15 3.3 1 0.9
16 3.05 0.15 2.1
17 4.2 0.05 2.3
18 3.25 1.2 2.2
$EndNodes
$Elements
5
1 5 2 1 1 1 2 3 4 5 6 7 8
2 7 2 1 1 5 6 7 8 9
3 6 2 1 1 10 11 12 13 14 15
4 6 2 1 1 13 14 15 16 17 18
5 4 2 1 1 10 11 12 1
$EndElements
)";

/// The types of cells that VTK's own formats hold.
inline CellTypes types_of_vtk() {
  return common_types({{Shape::poly_vertex, 3},
                       {Shape::polyline, 4},
                       {Shape::polygon, 5},
                       {Shape::triangle_strip, 6},
                       {Shape::line, 4},
                       {Shape::triangle, 7},
                       {Shape::pyramid, 19}});
}

/// The vertices of a cell of `mesh`, in VTK's order for cells of the type `type`.
inline std::vector<Index> vertices_in_vtk(const Mesh& mesh, Index cell, int type) {
  std::vector<Index> vertices(mesh.cells[cell].begin(), mesh.cells[cell].end());
  if (type == VTK_WEDGE) {
    std::swap(vertices[1], vertices[2]);
    std::swap(vertices[4], vertices[5]);
  }
  return vertices;
}

/// EXPECTs the points and cells of `mesh`.
inline void expect_same_grid(vtkUnstructuredGrid* grid, const Mesh& mesh) {
  ASSERT_EQ(grid->GetNumberOfPoints(), mesh.vertex_count());
  ASSERT_EQ(grid->GetNumberOfCells(), mesh.cell_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(grid->GetPoint(v)[i], mesh.points[v][i]);
  }
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    vtkIdType count = 0;
    const vtkIdType* vertices = nullptr;
    grid->GetCellPoints(c, count, vertices);
    EXPECT_EQ(std::vector<Index>(vertices, vertices + count), vertices_in_vtk(mesh, c, grid->GetCellType(c)));
  }
}

/// EXPECTs that VTK's faces of every cell are anticlockwise from outside of the cell.
inline void expect_faces_outward(vtkUnstructuredGrid* grid) {
  const auto middle = [](vtkCell* cell) {
    std::array<double, 3> sum{};
    for (vtkIdType i = 0; i < cell->GetNumberOfPoints(); ++i) {
      for (int k = 0; k < 3; ++k)
        sum[k] += cell->GetPoints()->GetPoint(i)[k] / static_cast<double>(cell->GetNumberOfPoints());
    }
    return sum;
  };
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    vtkCell* const cell = grid->GetCell(c);
    const std::array<double, 3> inner = middle(cell);
    ASSERT_GT(cell->GetNumberOfFaces(), 0) << "cell " << c;
    for (int f = 0; f < cell->GetNumberOfFaces(); ++f) {
      vtkCell* const face = cell->GetFace(f);
      const vtkIdType corners = face->GetNumberOfPoints();
      const std::array<double, 3> outer = middle(face);
      // the normal that all sides of the face add up to
      double volume = 0;
      for (vtkIdType i = 0; i < corners; ++i) {
        std::array<double, 3> a{};
        std::array<double, 3> b{};
        face->GetPoints()->GetPoint(i, a.data());
        face->GetPoints()->GetPoint((i + 1) % corners, b.data());
        for (int k = 0; k < 3; ++k) {
          const int l = (k + 1) % 3;
          const int m = (k + 2) % 3;
          volume += ((a[l] - outer[l]) * (b[m] - outer[m]) - (a[m] - outer[m]) * (b[l] - outer[l])) *
                    (outer[k] - inner[k]);
        }
      }
      EXPECT_GT(volume, 0) << "face " << f << " of cell " << c << ", " << cell->GetClassName();
    }
  }
}

/// A wedge and a Lagrange wedge on separate points. The first triangle of the Lagrange wedge faces inward;
/// that of the wedge faces outward, as in VTK up to 9.6, or `inward`, as in later versions.
inline vtkSmartPointer<vtkUnstructuredGrid> grid_of_wedges(bool inward = false) {
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const double x : {0.0, 5.0}) {
    for (const double z : {0.0, 1.5}) {
      points->InsertNextPoint(x, 0, z);
      points->InsertNextPoint(x, 1, z + 0.25);
      points->InsertNextPoint(x + 1, 0, z);
    }
  }
  grid->SetPoints(points);
  std::array<vtkIdType, 6> wedge{0, 1, 2, 3, 4, 5};
  if (inward) wedge = {0, 2, 1, 3, 5, 4};
  const std::array<vtkIdType, 6> lagrange{6, 8, 7, 9, 11, 10};
  grid->InsertNextCell(VTK_WEDGE, 6, wedge.data());
  grid->InsertNextCell(VTK_LAGRANGE_WEDGE, 6, lagrange.data());
  return grid;
}

/// EXPECTs that the edges from the first corner of every wedge are right-handed, as in Gmsh.
inline void expect_wedges_of_gmsh(const Mesh& mesh) {
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (mesh.cells.shapes[c] != Shape::wedge) continue;
    const Point& origin = mesh.points[mesh.cells[c][0]];
    std::array<Point, 3> e{};
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) e[i][k] = mesh.points[mesh.cells[c][i + 1]][k] - origin[k];
    }
    const double determinant = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                               e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                               e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    EXPECT_GT(determinant, 0) << "cell " << c;
  }
}

/// The points of every cell, one after another.
inline std::vector<std::vector<vtkIdType>> points_of_cells(vtkUnstructuredGrid* grid) {
  std::vector<std::vector<vtkIdType>> result;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    vtkIdType count = 0;
    const vtkIdType* vertices = nullptr;
    grid->GetCellPoints(c, count, vertices);
    result.emplace_back(vertices, vertices + count);
  }
  return result;
}

}  // namespace meshorder::test
