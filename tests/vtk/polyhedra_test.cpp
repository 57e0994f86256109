// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Polyhedra in .vtu and legacy .vtk files, by VTK's own readers and writers.
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace meshorder::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The corners of the faces of a cube on points `first` to `first + 7`, numbered along the axes.
std::vector<std::vector<int>> faces_of_cube(int first) {
  std::vector<std::vector<int>> faces{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (std::vector<int>& face : faces) {
    for (int& corner : face) corner += first;
  }
  return faces;
}

/// Two cubes as polyhedra, one on the other, and two tetrahedra between them in the list; labels 10 to 13.
vtkSmartPointer<vtkUnstructuredGrid> grid_of_polyhedra() {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int z = 0; z < 3; ++z) {
    for (int k = 0; k < 4; ++k) points->InsertNextPoint(k % 2, k / 2, z);
  }
  points->InsertNextPoint(0.5, 0.5, 3);
  grid->SetPoints(points);
  const auto add_cube = [&](int first) {
    const vtkNew<vtkIdList> numbers;
    const auto faces = faces_of_cube(first);
    numbers->InsertNextId(static_cast<vtkIdType>(faces.size()));
    for (const std::vector<int>& face : faces) {
      numbers->InsertNextId(static_cast<vtkIdType>(face.size()));
      for (const int corner : face) numbers->InsertNextId(corner);
    }
    grid->InsertNextCell(VTK_POLYHEDRON, numbers);
  };
  const auto add_tetrahedron = [&](std::array<vtkIdType, 4> corners) {
    grid->InsertNextCell(VTK_TETRA, 4, corners.data());
  };
  add_cube(0);
  add_tetrahedron({8, 9, 10, 12});
  add_cube(4);
  add_tetrahedron({9, 11, 10, 12});
  const vtkNew<vtkIntArray> labels;
  labels->SetName("label");
  for (int c = 0; c < 4; ++c) labels->InsertNextValue(10 + c);
  grid->GetCellData()->AddArray(labels);
  return grid;
}

using Faces = std::vector<std::vector<Point>>;  // each face by its corners' coordinates, in turn

/// The faces of every polyhedron in VTK, by label; for other cells, their points as one face.
std::map<int, Faces> faces_by_label(vtkUnstructuredGrid* grid) {
  std::map<int, Faces> result;
  const auto point = [&](vtkIdType p) {
    return Point{grid->GetPoint(p)[0], grid->GetPoint(p)[1], grid->GetPoint(p)[2]};
  };
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    Faces& faces = result[static_cast<int>(grid->GetCellData()->GetArray("label")->GetTuple1(c))];
    const vtkNew<vtkIdList> numbers;
    if (grid->GetCellType(c) != VTK_POLYHEDRON) {
      grid->GetCellPoints(c, numbers);
      faces.emplace_back();
      for (vtkIdType k = 0; k < numbers->GetNumberOfIds(); ++k)
        faces.back().push_back(point(numbers->GetId(k)));
      continue;
    }
    grid->GetFaceStream(c, numbers);
    for (vtkIdType at = 1; at < numbers->GetNumberOfIds(); at += 1 + numbers->GetId(at)) {
      faces.emplace_back();
      for (vtkIdType k = 0; k < numbers->GetId(at); ++k)
        faces.back().push_back(point(numbers->GetId(at + 1 + k)));
    }
  }
  return result;
}

template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> grid_in(const std::filesystem::path& path) {
  const vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

/// EXPECTs that VTK reads the faces of `grid` from the mesh of grid_of_polyhedra, reordered and written.
template <class Reader>
void expect_faces_follow(const std::filesystem::path& path, vtkUnstructuredGrid* grid) {
  Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.cells.shapes,
            (std::vector{Shape::polyhedron, Shape::tetrahedron, Shape::polyhedron, Shape::tetrahedron}));
  EXPECT_EQ(std::set<Index>(mesh.cells[2].begin(), mesh.cells[2].end()),
            (std::set<Index>{4, 5, 6, 7, 8, 9, 10, 11}));
  apply_reordering(mesh, shuffled(13, 3), Permutation::from_old_to_new({3, 0, 1, 2}));
  const auto written = path.parent_path() / ("written" + path.extension().string());
  Notes notes;
  write_mesh(mesh, written, &notes);
  EXPECT_EQ(notes, Notes{});
  const auto found = grid_in<Reader>(written);
  EXPECT_EQ(found->GetCellType(3), VTK_POLYHEDRON);
  EXPECT_EQ(faces_by_label(found), faces_by_label(grid));
  const Mesh back = read_mesh(written);
  EXPECT_EQ(back.cells.shapes, mesh.cells.shapes);
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.data, mesh.data);
}

/// The same grid as VTK 9.7 writes it, with the face between the cubes only once.
constexpr std::string_view kByFace = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="2.3" byte_order="LittleEndian" header_type="UInt32">
  <UnstructuredGrid>
    <Piece NumberOfPoints="13" NumberOfCells="4">
      <CellData>
        <DataArray type="Int32" Name="label" format="ascii">10 11 12 13</DataArray>
      </CellData>
      <Points>
        <DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">
          0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1 0 0 2 1 0 2 0 1 2 1 1 2 0.5 0.5 3
        </DataArray>
      </Points>
      <Cells>
        <DataArray type="Int64" Name="connectivity" format="ascii">
          0 1 2 3 4 5 6 7 8 9 10 12 4 5 6 7 8 9 10 11 9 11 10 12
        </DataArray>
        <DataArray type="Int64" Name="offsets" format="ascii">8 12 20 24</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">42 10 42 10</DataArray>
        <DataArray type="Int64" Name="face_connectivity" format="ascii">
          0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5
          8 9 11 10 4 5 9 8 6 10 11 7 4 8 10 6 5 7 11 9
        </DataArray>
        <DataArray type="Int64" Name="face_offsets" format="ascii">4 8 12 16 20 24 28 32 36 40 44</DataArray>
        <DataArray type="Int64" Name="polyhedron_to_faces" format="ascii">0 1 2 3 4 5 1 6 7 8 9 10</DataArray>
        <DataArray type="Int64" Name="polyhedron_offsets" format="ascii">6 6 12 12</DataArray>
      </Cells>
    </Piece>
  </UnstructuredGrid>
</VTKFile>
)";

}  // namespace

TEST(VtkPolyhedra, FacesOfLegacyFilesFollowTheirCells) {
  const TemporaryFolder folder;
  const auto grid = grid_of_polyhedra();
  for (const int version : {42, 51}) {
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(std::to_string(version) + (binary ? " binary" : " text"));
      const vtkNew<vtkUnstructuredGridWriter> writer;
      writer->SetInputData(grid);
      writer->SetFileName((folder.path() / "a.vtk").c_str());
      writer->SetFileVersion(version);
      writer->SetFileType(binary ? VTK_BINARY : VTK_ASCII);
      ASSERT_EQ(writer->Write(), 1);
      expect_faces_follow<vtkUnstructuredGridReader>(folder.path() / "a.vtk", grid);
    }
  }
}

TEST(VtkPolyhedra, FacesOfVtuFilesFollowTheirCells) {
  const TemporaryFolder folder;
  const auto grid = grid_of_polyhedra();
  for (const int mode : {0, 1, 2}) {
    SCOPED_TRACE(mode);
    const vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid);
    writer->SetFileName((folder.path() / "a.vtu").c_str());
    writer->SetDataMode(mode);
    ASSERT_EQ(writer->Write(), 1);
    expect_faces_follow<vtkXMLUnstructuredGridReader>(folder.path() / "a.vtu", grid);
  }
}

TEST(VtkPolyhedra, AreWrittenByFaceAsTheyWereRead) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.vtu", kByFace));
  apply_reordering(mesh, shuffled(13, 5), Permutation::from_old_to_new({1, 0, 3, 2}));
  write_mesh(mesh, folder.path() / "b.vtu");
  const std::string written = content_of(folder.path() / "b.vtu");
  EXPECT_THAT(written, HasSubstr("version=\"2.3\""));
  EXPECT_THAT(written, HasSubstr("polyhedron_to_faces"));
  write_mesh(read_mesh(folder.path() / "b.vtu"), folder.path() / "c.vtu");
  EXPECT_EQ(content_of(folder.path() / "c.vtu"), written);
  // VTK before 9.4 reads legacy files
  write_mesh(read_mesh(folder.path() / "b.vtu"), folder.path() / "d.vtk");
  const auto found = faces_by_label(grid_in<vtkUnstructuredGridReader>(folder.path() / "d.vtk"));
  const auto expected = faces_by_label(grid_of_polyhedra());
  const auto turned = [](Faces faces) {  // the shared face has the lower cube's orientation
    for (auto& face : faces) std::sort(face.begin(), face.end());
    std::sort(faces.begin(), faces.end());
    return faces;
  };
  for (const int label : {10, 11, 12, 13}) EXPECT_EQ(turned(found.at(label)), turned(expected.at(label)));
}

TEST(VtkPolyhedra, OfPiecesAreJoined) {
  const TemporaryFolder folder;
  const auto piece = folder.file("a0.vtu", kByFace);
  (void)folder.file("a1.vtu", kByFace);
  const Mesh two = read_mesh(folder.file(
      "a.pvtu",
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<PUnstructuredGrid GhostLevel=\"0\">\n<Piece Source=\"a0.vtu\"/>\n"
      "<Piece Source=\"a1.vtu\"/>\n</PUnstructuredGrid>\n</VTKFile>\n"));
  EXPECT_EQ(two.cell_count(), 8);
  write_mesh(two, folder.path() / "b.vtk");
  const auto grid = grid_in<vtkUnstructuredGridReader>(folder.path() / "b.vtk");
  write_mesh(read_mesh(piece), folder.path() / "c.vtk");
  const auto one = grid_in<vtkUnstructuredGridReader>(folder.path() / "c.vtk");
  for (vtkIdType c = 0; c < 8; ++c) {
    const vtkNew<vtkIdList> found;
    const vtkNew<vtkIdList> expected;
    if (grid->GetCellType(c) != VTK_POLYHEDRON) continue;
    grid->GetFaceStream(c, found);
    one->GetFaceStream(c % 4, expected);
    ASSERT_EQ(found->GetNumberOfIds(), expected->GetNumberOfIds());
    vtkIdType next = 1;  // where the next number of corners is
    for (vtkIdType k = 1; k < found->GetNumberOfIds(); ++k) {
      const bool is_count = k == next;
      if (is_count) next += 1 + expected->GetId(k);
      EXPECT_EQ(found->GetId(k), expected->GetId(k) + (!is_count && c >= 4 ? 13 : 0));
    }
  }
}

TEST(VtkPolyhedra, CellsThatAreLeftOutTakeTheirFacesAlong) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.vtu", kByFace));
  mesh.format_metadata = mesh.format_metadata->moved({}, std::vector<Index>{-1, 0, 1, -1});
  mesh.data.clear();
  mesh.cells = {};
  mesh.cells.push_back(Shape::tetrahedron, std::vector<Index>{8, 9, 10, 12});
  mesh.cells.push_back(Shape::polyhedron, std::vector<Index>{4, 5, 6, 7, 8, 9, 10, 11});
  write_mesh(mesh, folder.path() / "b.vtu");
  EXPECT_EQ(read_mesh(folder.path() / "b.vtu").cells, mesh.cells);
  // faces of another polyhedron
  mesh.cells.vertices.back() = 0;
  EXPECT_THROW(write_mesh(mesh, folder.path() / "c.vtu"), InvalidArgument);
}

TEST(VtkPolyhedra, PrismsKeepTheirTypes) {
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const vtkNew<vtkIntArray> labels;
  labels->SetName("label");
  for (const int sides : {5, 6}) {
    std::vector<vtkIdType> corners;
    for (int k = 0; k < 2 * sides; ++k) {
      corners.push_back(
          points->InsertNextPoint(std::cos(6.2832 * k / sides), std::sin(6.2832 * k / sides), k / sides));
    }
    grid->InsertNextCell(sides == 5 ? VTK_PENTAGONAL_PRISM : VTK_HEXAGONAL_PRISM, 2 * sides, corners.data());
    labels->InsertNextValue(sides);
  }
  grid->SetPoints(points);
  grid->GetCellData()->AddArray(labels);
  const TemporaryFolder folder;
  const vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetFileName((folder.path() / "a.vtk").c_str());
  writer->SetFileTypeToBinary();
  ASSERT_EQ(writer->Write(), 1);
  Mesh mesh = read_mesh(folder.path() / "a.vtk");
  EXPECT_EQ(mesh.cells.shapes, (std::vector<Shape>(2, Shape::polyhedron)));
  apply_reordering(mesh, shuffled(22, 3), Permutation::from_old_to_new({1, 0}));
  write_mesh(mesh, folder.path() / "b.vtk");
  write_mesh(mesh, folder.path() / "b.vtu");
  for (const auto& found : {grid_in<vtkUnstructuredGridReader>(folder.path() / "b.vtk"),
                            grid_in<vtkXMLUnstructuredGridReader>(folder.path() / "b.vtu")}) {
    EXPECT_EQ(found->GetCellType(0), VTK_HEXAGONAL_PRISM);
    EXPECT_EQ(found->GetCellType(1), VTK_PENTAGONAL_PRISM);
    EXPECT_EQ(faces_by_label(found), faces_by_label(grid));
  }
  write_mesh(mesh, folder.path() / "b.vtkhdf");
  EXPECT_EQ(read_mesh(folder.path() / "b.vtkhdf").cells, mesh.cells);
  EXPECT_THAT(write_error(mesh, folder.path() / "b.msh"), HasSubstr("cannot hold a cell of type polyhedron"));
  expect_broken("c.vtk",
                {{"a prism that lacks a corner",
                  "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
                  "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n15\n",
                  ":9: cell 0 (counted from 0) is a VTK_PENTAGONAL_PRISM of 4 vertices; it has 10"}});
}

TEST(VtkPolyhedra, OtherFormatsRefuseThem) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.vtu", kByFace));
  for (const char* const name : {"b.vtkhdf", "b.msh", "b.ply"}) {
    EXPECT_THAT(write_error(mesh, folder.path() / name), HasSubstr("cannot hold a cell of type polyhedron"))
        << name;
  }
}

TEST(VtkPolyhedra, BrokenFacesGiveOneClearError) {
  const auto by_face = [](std::string_view old, std::string_view fresh) {
    return with(std::string(kByFace), old, fresh);
  };
  expect_broken(
      "b.vtu",
      {{"a face that is not there", by_face("0 1 2 3 4 5 1 6", "0 1 2 3 4 5 11 6"),
        ":24: a polyhedron names the face 11; the piece has faces 0 to 10"},
       {"a point that is not there", by_face("4 8 10 6 5", "4 8 13 6 5"), ":19: a cell names the point 13"},
       {"a point of another cell", by_face("4 8 10 6 5", "4 8 0 6 5"),
        "cell 2 (counted from 0) is a polyhedron whose faces are not on its points"},
       {"faces that end before they begin", by_face("4 8 12 16", "4 8 6 16"),
        ":23: face 2 (counted from 0) ends at 6, before it begins at 8"},
       {"no faces", by_face("6 6 12 12", "12 12 12 12"),
        "cell 0 (counted from 0) is a polyhedron whose faces"},
       {"no offsets of faces", by_face("face_offsets", "offsets_of_faces"),
        ":13: the array face_offsets is missing in <Cells>; polyhedra have face_connectivity"},
       {"neither way", by_face("polyhedron_to_faces", "faces"),
        ":13: the array faceoffsets is missing in <Cells>; polyhedra have faces and faceoffsets"}});
  const auto old = [](const std::string& faces, const std::string& ends) {
    std::string text(kByFace);
    const auto begin = text.find("        <DataArray type=\"Int64\" Name=\"face_connectivity\"");
    text.replace(begin, text.find("      </Cells>") - begin,
                 "<DataArray type=\"Int32\" Name=\"faces\" format=\"ascii\">" + faces +
                     "</DataArray>\n<DataArray type=\"Int32\" Name=\"faceoffsets\" format=\"ascii\">" + ends +
                     "</DataArray>\n");
    return text;
  };
  expect_broken("b.vtu",
                {{"counts that do not fit", old("2 4 0 1 2 3 5 4 5 6 7 1 3 4 5 6", "11 -1 16 -1"),
                  ":19: cell 0 (counted from 0), a polyhedron, has faces that do not fit its 11 numbers"},
                 {"a huge count", old("2000000000 4 0 1 2 3 1 3 4 5 6", "6 -1 11 -1"), ":19: cell 0"},
                 {"no end", old("1 4 0 1 2 3", "6 -1 -1 -1"),
                  ":20: the faces of cell 2 (counted from 0), a polyhedron, end at -1"},
                 {"a point that is not there", old("1 4 0 1 2 3 1 3 4 5 66", "6 -1 11 -1"),
                  ":19: a face names the point 66; the piece has points 0 to 12"}});
  const std::string head =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
      "0 0 0 1 0 0 0 1 0 0 0 1\n";
  const auto cell = [&](const std::string& numbers) {
    return head + "CELLS 1 " + numbers + "\nCELL_TYPES 1\n42\n";
  };
  expect_broken("b.vtk",
                {{"counts that do not fit", cell("6\n5 1 4 0 1 2"),
                  ":7: cell 0 (counted from 0), a polyhedron, has faces that do not fit its 5 numbers"},
                 {"a point that is not there", cell("6\n5 1 3 0 1 4"),
                  ":7: cell 0 (counted from 0), a polyhedron, names the point 4; points run from 0 to 3"},
                 {"no numbers", cell("1\n0"), ":7: cell 0 (counted from 0), a polyhedron"}});
}

}  // namespace meshorder::test
