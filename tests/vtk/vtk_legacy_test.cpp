// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include "support/vtk_grids.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <vtkBitArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCharArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkPolyDataWriter.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedLongLongArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkUnstructuredGridWriter.h>

#include <cmath>
#include <csignal>
#include <random>

namespace meshorder::test {
namespace {

/// A tetrahedron and a triangle, on lines that the tests of broken files name.
const std::string kSmall = R"(# vtk DataFile Version 3.0
two cells
ASCII
DATASET UNSTRUCTURED_GRID
FIELD FieldData 1
TimeValue 1 1 double
0.25
POINTS 5 double
0 0 0  1 0 0  0 1 0
0 0 1  0.1 0.2 0.3
CELLS 2 9
4 0 1 2 3
3 1 2 4
CELL_TYPES 2
10
5
POINT_DATA 5
SCALARS heat float 1
LOOKUP_TABLE warm
1 2.5 nan -inf 5
LOOKUP_TABLE warm 2
0 0 0 1
1 0.5 0 1
VECTORS wind double
1 2 3 4 5 6 7 8 9 10 11 12 13 14 0.1
CELL_DATA 2
FIELD more 2
part%20one 1 2 int
7 -8
who 1 2 string
a%20b

)";

const std::string kPolydata = R"(# vtk DataFile Version 4.2
surface
ASCII
DATASET POLYDATA
POINTS 6 float
0 0 0 1 0 0 1 1 0 0 1 0 2 0 0 2 1 0
POLYGONS 2 9
3 0 1 2
4 0 1 2 3
VERTICES 2 5
1 5
2 0 1
LINES 1 4
3 0 1 2
TRIANGLE_STRIPS 1 5
4 1 2 4 5
CELL_DATA 6
SCALARS kind int 1
LOOKUP_TABLE default
1 2 3 4 5 6
)";

template <class Reader>
auto read_with_vtk(const std::filesystem::path& path) {
  const vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  return vtkSmartPointer(reader->GetOutput());
}

void write_with_vtk(vtkUnstructuredGrid* grid, const std::filesystem::path& path, bool binary, int version) {
  const vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetFileName(path.c_str());
  writer->SetFileType(binary ? VTK_BINARY : VTK_ASCII);
  writer->SetFileVersion(version);
  ASSERT_EQ(writer->Write(), 1);
}

/// A grid with an array of every kind that VTK's writers support.
vtkSmartPointer<vtkUnstructuredGrid> grid_with_everything() {
  const TemporaryFolder folder;
  write_mesh(mixed_mesh(), folder.path() / "mixed.vtk");
  const auto grid = read_with_vtk<vtkUnstructuredGridReader>(folder.path() / "mixed.vtk");
  const vtkIdType n = grid->GetNumberOfCells();
  const auto add = [&](vtkAbstractArray* array, const char* name) {
    array->SetName(name);
    array->SetNumberOfTuples(n);
    grid->GetCellData()->AddArray(array);
  };
  const vtkNew<vtkBitArray> bits;
  add(bits, "bits");
  const vtkNew<vtkCharArray> chars;
  add(chars, "chars");
  const vtkNew<vtkUnsignedLongLongArray> wide;
  add(wide, "wide & %odd");
  const vtkNew<vtkIdTypeArray> ids;
  add(ids, "ids");
  const vtkNew<vtkStringArray> texts;
  add(texts, "texts");
  const vtkNew<vtkDoubleArray> tensors;
  tensors->SetNumberOfComponents(9);
  tensors->SetComponentName(8, "z z");
  add(tensors, "tensors");
  tensors->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), "MPa");
  const vtkNew<vtkDoubleArray> normals;
  normals->SetNumberOfComponents(3);
  add(normals, "normals");
  for (vtkIdType c = 0; c < n; ++c) {
    bits->SetValue(c, c % 3 == 0);
    chars->SetValue(c, static_cast<char>(c - 5));
    wide->SetValue(c, c == 0 ? ~0ULL : static_cast<unsigned long long>(c));
    ids->SetValue(c, 100 - c);
    texts->SetValue(c, std::string(static_cast<std::size_t>(40 * c), 'x') + " é\n%");
    for (int i = 0; i < 9; ++i) tensors->SetComponent(c, i, 0.5 * i + static_cast<double>(c));
    for (int i = 0; i < 3; ++i) normals->SetComponent(c, i, i);
  }
  grid->GetCellData()->SetGlobalIds(ids);
  grid->GetCellData()->SetTensors(tensors);
  grid->GetCellData()->SetNormals(normals);
  const vtkNew<vtkDoubleArray> time;
  time->SetName("TimeValue");
  time->InsertNextValue(0.25);
  grid->GetFieldData()->AddArray(time);
  return grid;
}

}  // namespace

TEST(VtkLegacy, ReadsPointsCellsAndAllArrays) {
  const TemporaryFolder folder;
  Notes notes;
  const Mesh mesh = read_mesh(folder.file("a.vtk", kSmall), {.notes = &notes});
  EXPECT_EQ(mesh.vertex_count(), 5);
  EXPECT_EQ(mesh.points[4], (Point{0.1, 0.2, 0.3}));
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::tetrahedron, Shape::triangle}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 3, 1, 2, 4}));
  const auto& heat = std::get<std::vector<float>>(find_array(mesh, "heat", Association::vertices)->values);
  EXPECT_EQ(heat[1], 2.5F);
  EXPECT_TRUE(std::isnan(heat[2]));
  EXPECT_TRUE(std::isinf(heat[3]));
  EXPECT_EQ(std::get<std::vector<double>>(find_array(mesh, "wind", Association::vertices)->values)[14], 0.1);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(find_array(mesh, "part one", Association::cells)->values),
            (std::vector<std::int32_t>{7, -8}));
  EXPECT_EQ(std::get<std::vector<std::string>>(find_array(mesh, "who", Association::cells)->values),
            (std::vector<std::string>{"a b", ""}));
  EXPECT_EQ(mesh.format_metadata->contents(),
            (std::vector<std::string>{"the field 'TimeValue' of the whole mesh", "the lookup table 'warm'"}));
  EXPECT_TRUE(notes.empty());
}

TEST(VtkLegacy, KeepsAnArrayThatOnlyHasTheNameOfTheCellTypes) {
  const TemporaryFolder folder;
  const auto expect_kept = [&](Mesh mesh, std::vector<std::uint8_t> numbers) {
    const DataArray array{"vtk:type", Association::cells, 1, std::move(numbers), {}, {}};
    mesh.data.push_back(array);
    for (const char* const name : {"a.vtk", "a.vtu"}) {
      write_mesh(mesh, folder.path() / name);
      const Mesh back = read_mesh(folder.path() / name);
      const DataArray* const found = find_array(back, "vtk:type", Association::cells);
      ASSERT_NE(found, nullptr) << name;
      EXPECT_EQ(*found, array) << name;
    }
  };
  const Mesh mixed = mixed_mesh();
  expect_kept(mixed, std::vector<std::uint8_t>(mixed.cells.shapes.size(), 1));
  // type 64, a tetrahedron of higher order, fits the first cell
  const Mesh bar = tetrahedral_bar(1);
  std::vector<std::uint8_t> one_fits(bar.cells.shapes.size(), 0);
  one_fits.front() = 64;
  expect_kept(bar, one_fits);
}

TEST(VtkLegacy, WritesTextThatKeepsEveryDigitAndSection) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.vtk", kSmall));
  write_mesh(mesh, folder.path() / "b.vtk");
  EXPECT_EQ(content_of(folder.path() / "b.vtk"), R"(# vtk DataFile Version 3.0
two cells
ASCII
DATASET UNSTRUCTURED_GRID
FIELD FieldData 1
TimeValue 1 1 double
0.25
POINTS 5 double
0 0 0
1 0 0
0 1 0
0 0 1
0.1 0.2 0.3
CELLS 2 9
4 0 1 2 3
3 1 2 4
CELL_TYPES 2
10
5
POINT_DATA 5
SCALARS heat float 1
LOOKUP_TABLE warm
1 2.5 nan -inf 5
VECTORS wind double
1 2 3 4 5 6 7 8 9
10 11 12 13 14 0.1
LOOKUP_TABLE warm 2
0 0 0 1
1 0.5 0 1
CELL_DATA 2
FIELD FieldData 2
part%20one 1 2 int
7 -8
who 1 2 string
a%20b


)");
}

TEST(VtkLegacy, WhatVtkReadsIsRead) {
  const TemporaryFolder folder;
  struct Spelling {
    const char* what;
    std::string text;
    std::string note;  ///< empty for none
  };
  const auto spelt = [](std::string_view old, std::string_view fresh) {
    return with(with(kSmall, "1 2.5 nan -inf", "1 2.5 3 4"), old, fresh);
  };
  for (const Spelling& spelling : std::vector<Spelling>{
           {"components glued to the type", spelt("heat float 1", "heat float1"),
            "the array 'heat' is of type 'float1', which is read as float"},
           {"a type in bits", spelt("heat float 1", "heat FLOAT32"),
            "the array 'heat' is of type 'FLOAT32', which is read as float"},
           {"components on the next line", spelt("heat float 1", "heat float\n1"), ""},
           {"keywords in lower case", spelt("POINT_DATA 5\nSCALARS", "point_data 5\nscalars"), ""},
           {"no version", spelt(" 3.0", ""),
            "the first line gives no version; the file is read as version 3.0"},
           {"a version of one number", spelt("3.0", "3"),
            "the first line gives no version; the file is read as version 3.0"},
           {"words after the version", spelt("3.0", "3.0 of today"), ""},
           {"other metadata", spelt("CELL_DATA", "METADATA\nORIGIN here\n\nCELL_DATA"),
            "METADATA has 'ORIGIN', which is left out"},
       }) {
    SCOPED_TRACE(spelling.what);
    const auto path = folder.file("a.vtk", spelling.text);
    Notes notes;
    const Mesh mesh = read_mesh(path, {.notes = &notes});
    EXPECT_EQ(notes, spelling.note.empty() ? Notes{} : Notes{spelling.note});
    EXPECT_EQ(find_array(mesh, "heat", Association::vertices)->values,
              Values(std::vector<float>{1, 2.5, 3, 4, 5}));
    expect_same_grid(read_with_vtk<vtkUnstructuredGridReader>(path), mesh);
    write_mesh(mesh, folder.path() / "b.vtk");
    EXPECT_NE(content_of(folder.path() / "b.vtk").find("SCALARS heat float 1\n"), std::string::npos);
  }
}

TEST(VtkLegacy, ArraysOfOneNameGetDifferentOnes) {
  const TemporaryFolder folder;
  Notes notes;
  const Mesh mesh =
      read_mesh(folder.file("a.vtk", with(kSmall, "VECTORS wind", "VECTORS heat")), {.notes = &notes});
  EXPECT_EQ(notes, (Notes{"the array 'heat' is given twice; the second is called 'heat (2)'"}));
  EXPECT_EQ(find_array(mesh, "heat", Association::vertices)->components, 1);
  EXPECT_EQ(find_array(mesh, "heat (2)", Association::vertices)->components, 3);
  write_mesh(mesh, folder.path() / "b.vtk");
  EXPECT_NE(content_of(folder.path() / "b.vtk").find("VECTORS heat%20(2) double"), std::string::npos);
}

TEST(VtkLegacy, BrokenFilesGiveOneClearError) {
  const auto broken = [](std::string_view old, std::string_view fresh) { return with(kSmall, old, fresh); };
  const auto grid = [&](const char* kind) { return broken("UNSTRUCTURED_GRID", kind); };
  const std::string binary_head = "# vtk DataFile Version 4.2\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\n";
  const std::string new_head =
      "# vtk DataFile Version 5.1\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n";
  expect_broken(
      "b.vtk",
      {{"another file", "solid cube\n", "looks like STL, not like VTK"},
       {"garbage", std::string("\x00\x9f\x92\xff\n\xfe", 6), ":1: is not a legacy VTK file"},
       {"a version to come", broken("3.0", "7.0"), ":1: the version 7.0 is unknown"},
       {"neither text nor binary", broken("ASCII", "UNICODE"), ":3: the third line is 'unicode'"},
       {"a structured grid", grid("STRUCTURED_GRID"), ":4: the dataset STRUCTURED_GRID is structured"},
       {"an image", grid("STRUCTURED_POINTS"), "cannot be reordered"},
       {"a rectilinear grid", grid("RECTILINEAR_GRID"), "cannot be reordered"},
       {"a table", grid("TABLE"), ":4: expected a mesh, found 'table'"},
       {"only a head", binary_head, "the file has no POINTS"},
       {"no points", broken("POINTS 5 double", "DOTS 5 double"), ":8: the section 'DOTS' is unknown"},
       {"10¹² points", broken("POINTS 5", "POINTS 1000000000000"),
        ":8: the number of points is 1000000000000"},
       {"a billion points", broken("POINTS 5", "POINTS 1000000000"),
        ":8: the array 'POINTS' of 3000000000 numbers"},
       {"a negative number of points", broken("POINTS 5", "POINTS -5"), ":8: the number of points is -5"},
       {"points twice", broken("CELLS 2 9", "POINTS 1 float\n0 0 0\nPOINTS 1 float\n"),
        ":11: a second section POINTS"},
       {"an unknown number type", broken("5 double", "5 quad"), ":8: the array 'POINTS' is of type 'quad'"},
       {"points of texts", broken("5 double", "5 string"), ":8: the points are of type string"},
       {"a word among numbers", broken("0 1 0\n", "0 l 0\n"), ":9: the array 'POINTS' is 'l'"},
       {"NaN coordinate", broken("0.1 0.2", "nan 0.2"), ":10: the array 'POINTS' is not finite"},
       {"infinite coordinate", broken("0.1 0.2", "-inf 0.2"), ":10:"},
       {"a huge coordinate", broken("0.1 0.2", "1e999 0.2"), ":10:"},
       {"a float that is too large", broken("1 2.5", "1e300 2.5"), ":20:"},
       {"too few points", broken("0 0 1  0.1 0.2 0.3", ""), ":11: the array 'POINTS' is 'CELLS'"},
       {"too many points", broken("0.2 0.3", "0.2 0.3 7"), ":10: the section '7' is unknown"},
       {"10¹² cells", broken("CELLS 2 9", "CELLS 1000000000000 9"), ":11: the number of CELLS"},
       {"cells of 10⁹ numbers", broken("CELLS 2 9", "CELLS 2 1000000000"),
        ":11: CELLS of 1000000000 numbers"},
       {"more cells than numbers", broken("CELLS 2 9", "CELLS 10 9"), ":11: CELLS has 10 cells in 9 numbers"},
       {"a cell of too many vertices", broken("3 1 2 4", "9 1 2 4"),
        ":13: cell 1 (counted from 0) of CELLS has 9 vertices where 3 numbers are left"},
       {"a negative number of vertices", broken("3 1 2 4", "-3 1 2 4"), ":13: cell 1"},
       {"numbers left over", broken("CELLS 2 9", "CELLS 1 9"), ":12: CELLS has 4 numbers more"},
       {"numbers that are missing", broken("CELLS 2 9", "CELLS 2 8"), ":13: cell 1"},
       {"a point that is not there", broken("3 1 2 4", "3 1 2 5"),
        ":13: cell 1 (counted from 0) names the point 5; points run from 0 to 4"},
       {"a negative point", broken("3 1 2 4", "3 1 -2 4"), ":13: cell 1 (counted from 0) names the point -2"},
       {"too few types", broken("CELL_TYPES 2\n10\n5", "CELL_TYPES 1\n10"),
        ":14: there are 1 CELL_TYPES for 2 cells"},
       {"no types", broken("CELL_TYPES 2\n10\n5\n", ""), "there are 0 CELL_TYPES for 2 cells"},
       {"a type that nobody has", broken("10\n5", "10\n99"), ":14: cell 1 (counted from 0) has the type 99"},
       {"a convex set of points", broken("10\n5", "10\n41"),
        ":14: cell 1 (counted from 0) has the type 41; VTK's types 1 to 16, 21 to 37, 42, 60 to 62"},
       {"a type beyond a byte", broken("10\n5", "10\n1005"), ":16: cell 1"},
       {"a polyhedron of a triangle's numbers", broken("10\n5", "10\n42"),
        ":11: cell 1 (counted from 0), a polyhedron, has faces that do not fit its 3 numbers"},
       {"a triangle of four vertices", broken("10\n5", "5\n5"),
        ":14: cell 0 (counted from 0) is a VTK_TRIANGLE of 4"},
       {"no cells", broken("CELLS 2 9\n4 0 1 2 3\n3 1 2 4\nCELL_TYPES 2\n10\n5", "CELLS 0 0\nCELL_TYPES 0"),
        ""},
       {"data for other points", broken("POINT_DATA 5", "POINT_DATA 4"),
        ":17: POINT_DATA is for 4 points; the file has 5"},
       {"data for other cells", broken("CELL_DATA 2", "CELL_DATA 3"),
        ":26: CELL_DATA is for 3 cells; the file has 2"},
       {"an array of too many tuples", broken("one 1 2 int", "one 1 3 int"),
        ":28: the array 'part one' has 3 tuples; 2 are needed"},
       {"10¹² components", broken("one 1 2 int", "one 1000000000000 2 int"),
        ":28: the components of 'part one'"},
       {"no components", broken("one 1 2 int", "one 0 2 int"), ":28: the array 'part one' has 0 components"},
       {"no lookup table", broken("LOOKUP_TABLE warm\n", ""), ":19: SCALARS 'heat' has no LOOKUP_TABLE"},
       {"an absurd lookup table", broken("LOOKUP_TABLE warm 2", "LOOKUP_TABLE warm 1000000000"),
        "the lookup table of"},
       {"an integer that is too large", broken("7 -8", "7 3000000000"),
        ":29: the array 'part one' is 3000000000"},
       {"an array that is missing", broken("FIELD more 2", "FIELD more 3"), "unexpected end of file"},
       {"10⁹ arrays", broken("FIELD more 2", "FIELD more 1000000000"), "unexpected end of file"},
       {"a cell section of another dataset", broken("CELLS 2 9", "POLYGONS 2 9"),
        ":11: the section 'POLYGONS' is unknown"},
       {"words after the end", kSmall + "x y z", ":33: the section 'x' is unknown"},
       {"binary points that end", binary_head + "POINTS 2 float\n1234", "byte"},
       {"binary cells that run out",
        binary_head + "POINTS 1 float\n" + std::string(12, '\0') + "\nCELLS 1 2\n" +
            std::string("\0\0\0\x7f\0\0\0\0", 8) + "\n",
        "has 127 vertices where 1 numbers are left"},
       {"binary NaN",
        binary_head + "POINTS 1 float\n" + std::string("\x7f\xc0\0\0\0\0\0\0\0\0\0\0", 12) + "\n",
        "point 0 (counted from 0) has a coordinate that is not finite"},
       {"offsets that fall",
        new_head + "CELLS 3 6\nOFFSETS vtktypeint64\n0 7 6\nCONNECTIVITY vtktypeint64\n0 1 2 0 1 "
                   "2\nCELL_TYPES 2\n5\n5\n",
        ":7: the OFFSETS of CELLS do not ascend"},
       {"offsets that do not end",
        new_head + "CELLS 3 6\nOFFSETS vtktypeint64\n0 3 5\nCONNECTIVITY vtktypeint64\n0 1 2 0 1 "
                   "2\nCELL_TYPES 2\n5\n5\n",
        ":7: the OFFSETS of CELLS do not ascend"},
       {"no connectivity", new_head + "CELLS 2 3\nOFFSETS vtktypeint64\n0 3\nCELL_TYPES 1\n5\n",
        ":10: CONNECTIVITY is missing"},
       {"connectivity of real numbers",
        new_head + "CELLS 2 3\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY float\n0 1 2\nCELL_TYPES 1\n5\n",
        ":7: the CONNECTIVITY of CELLS is not a list of integers"},
       {"a point beyond 32 bits beside a polyhedron",
        new_head + "CELLS 3 14\nOFFSETS vtktypeint64\n0 3 14\nCONNECTIVITY vtktypeint64\n0 1 4294967297\n"
                   "2 4 0 1 2 0 4 0 1 2 0\nCELL_TYPES 2\n5\n42\n",
        "names the point -1"},
       {"a large point",
        new_head + "CELLS 2 3\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1 "
                   "4294967296\nCELL_TYPES 1\n5\n",
        "cell 0 (counted from 0) names the point"}});
}

TEST(VtkLegacy, FolderOrEmptyFileIsAnError) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "c.vtk");
  EXPECT_NE(read_error(folder.path() / "c.vtk").find("is a folder"), std::string::npos);
  EXPECT_NE(read_error(folder.file("d.vtk", "")).find("is empty"), std::string::npos);
}

TEST(VtkLegacy, MixedLineEndsAreRead) {
  std::string text = with(kSmall, "nan", "3");
  const TemporaryFolder folder;
  const Mesh plain = read_mesh(folder.file("a.vtk", text));
  int i = 0;
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) {
    if (++i % 2 == 0) text.insert(at, "\r");
  }
  expect_same(read_mesh(folder.file("b.vtk", text)), plain);
}

TEST(VtkLegacy, EveryCellTypeIsWrittenAndReadInEveryVersion) {
  for (const auto& [shape, vertices] : types_of_vtk()) {
    SCOPED_TRACE(type_name(shape, vertices));
    expect_write_and_read(cells_of_type(shape, vertices, 3), "cells.vtk");
  }
  expect_write_and_read(mixed_mesh(), "mixed.vtk");
}

TEST(VtkLegacy, FacesOfCellsFromGmshAreOutwardInVtkAndBack) {
  const TemporaryFolder folder;
  const auto gmsh = folder.file("a.msh", kVolumesOfGmsh);
  const Mesh mesh = read_mesh(gmsh);
  expect_wedges_of_gmsh(mesh);
  write_mesh(mesh, folder.path() / "b.vtk");
  expect_faces_outward(read_with_vtk<vtkUnstructuredGridReader>(folder.path() / "b.vtk"));
  const Mesh back = read_mesh(folder.path() / "b.vtk");
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
}

TEST(VtkLegacy, WedgesOfVtkArriveInGmshTheRightWayRoundAndStayInVtk) {
  const TemporaryFolder folder;
  const auto grid = grid_of_wedges();
  expect_faces_outward(grid);
  for (const int version : {42, 51}) {
    SCOPED_TRACE(version);
    write_with_vtk(grid, folder.path() / "a.vtk", version == 42, version);
    const Mesh mesh = read_mesh(folder.path() / "a.vtk");
    expect_wedges_of_gmsh(mesh);
    write_mesh(mesh, folder.path() / "b.msh");
    const std::string written = content_of(folder.path() / "b.msh");
    EXPECT_NE(written.find("\n1 1 3 2 4 6 5\n"), std::string::npos) << written;
    EXPECT_NE(written.find("\n2 7 9 8 10 12 11\n"), std::string::npos) << written;

    write_mesh(mesh, folder.path() / "c.vtk");
    const auto back = read_with_vtk<vtkUnstructuredGridReader>(folder.path() / "c.vtk");
    EXPECT_EQ(points_of_cells(back), points_of_cells(grid));
    EXPECT_EQ(back->GetCellType(0), VTK_WEDGE);
    EXPECT_EQ(back->GetCellType(1), VTK_LAGRANGE_WEDGE);
    write_mesh(read_mesh(folder.path() / "c.vtk"), folder.path() / "d.vtk");
    EXPECT_EQ(content_of(folder.path() / "d.vtk"), content_of(folder.path() / "c.vtk"));
  }
}

TEST(VtkLegacy, WedgesOfLaterVersionsOfVtkAreKnownByTheirVolumes) {
  const TemporaryFolder folder;
  const auto grid = grid_of_wedges(true);
  write_with_vtk(grid, folder.path() / "a.vtk", true, 51);
  const Mesh mesh = read_mesh(folder.path() / "a.vtk");
  expect_wedges_of_gmsh(mesh);
  write_mesh(mesh, folder.path() / "c.vtk");
  EXPECT_EQ(points_of_cells(read_with_vtk<vtkUnstructuredGridReader>(folder.path() / "c.vtk")),
            points_of_cells(grid));
  // in a mirrored mesh all volumes are negative
  vtkPoints* const points = grid->GetPoints();
  for (vtkIdType p = 0; p < points->GetNumberOfPoints(); ++p) {
    points->SetPoint(p, -points->GetPoint(p)[0], points->GetPoint(p)[1], points->GetPoint(p)[2]);
  }
  const std::array<vtkIdType, 4> tetrahedron{0, 2, 1, 3};
  grid->InsertNextCell(VTK_TETRA, 4, tetrahedron.data());
  write_with_vtk(grid, folder.path() / "a.vtk", true, 51);
  EXPECT_EQ(read_mesh(folder.path() / "a.vtk").cells[0][1], 2);
}

TEST(VtkLegacy, FilesOfVtkAreReadAndVtkReadsOurs) {
  const auto grid = grid_with_everything();
  const TemporaryFolder folder;
  for (const int version : {42, 51}) {
    for (const bool binary : {false, true}) {
      SCOPED_TRACE(fmt::format("version {} {}", version, binary ? "binary" : "text"));
      const auto path = folder.path() / "vtk.vtk";
      write_with_vtk(grid, path, binary, version);
      Notes notes;
      const Mesh mesh = read_mesh(path, {.notes = &notes});
      EXPECT_EQ(notes, (Notes{"the array 'bits' holds bits, which are stored as bytes"}));
      if (binary) expect_same_grid(grid, mesh);  // VTK writes 11 digits as text

      const auto own = folder.path() / "own.vtk";
      write_mesh(mesh, own);
      expect_same(read_mesh(own), mesh);
      EXPECT_EQ(content_of(own).substr(0, 60), content_of(path).substr(0, 60));
      const auto back = read_with_vtk<vtkUnstructuredGridReader>(own);
      expect_same_grid(back, mesh);
      vtkCellData* data = back->GetCellData();
      vtkCellData* expected = grid->GetCellData();
      ASSERT_EQ(data->GetNumberOfArrays(), expected->GetNumberOfArrays());
      for (const char* name : {"chars", "wide & %odd", "ids", "texts", "tensors", "normals", "label"}) {
        SCOPED_TRACE(name);
        vtkAbstractArray* a = data->GetAbstractArray(name);
        vtkAbstractArray* b = expected->GetAbstractArray(name);
        ASSERT_NE(a, nullptr);
        EXPECT_STREQ(a->GetClassName(), b->GetClassName() == std::string("vtkUnsignedLongLongArray")
                                            ? "vtkTypeUInt64Array"
                                            : b->GetClassName());
        ASSERT_EQ(a->GetNumberOfValues(), b->GetNumberOfValues());
        for (vtkIdType i = 0; i < a->GetNumberOfValues(); ++i)
          EXPECT_EQ(a->GetVariantValue(i).ToString(), b->GetVariantValue(i).ToString());
      }
      EXPECT_EQ(data->GetArray("bits")->GetTuple1(3), 1);
      EXPECT_EQ(data->GetArray("bits")->GetTuple1(4), 0);
      EXPECT_STREQ(data->GetGlobalIds()->GetName(), "ids");
      EXPECT_STREQ(data->GetTensors()->GetName(), "tensors");
      EXPECT_STREQ(data->GetNormals()->GetName(), "normals");
      EXPECT_STREQ(data->GetTensors()->GetComponentName(8), "z z");
      EXPECT_STREQ(data->GetTensors()->GetInformation()->Get(vtkDataArray::UNITS_LABEL()), "MPa");
      EXPECT_EQ(back->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), 0.25);
    }
  }
}

TEST(VtkLegacy, PolydataKeepItsSectionsAsBlocks) {
  const TemporaryFolder folder;
  const auto path = folder.file("p.vtk", kPolydata);
  const Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::vertex, Shape::poly_vertex, Shape::polyline,
                                            Shape::triangle, Shape::quad, Shape::triangle_strip}));
  EXPECT_EQ(mesh.cell_blocks, (std::vector<Index>{0, 2, 3, 5}));
  EXPECT_EQ(std::vector<Index>(mesh.cells[0].begin(), mesh.cells[0].end()), (std::vector<Index>{5}));
  expect_order_and_back(path);
  write_mesh(mesh, folder.path() / "own.vtk");
  EXPECT_NE(content_of(folder.path() / "own.vtk").find("DATASET POLYDATA"), std::string::npos);
  const auto grid = read_with_vtk<vtkPolyDataReader>(folder.path() / "own.vtk");
  EXPECT_EQ(grid->GetNumberOfVerts(), 2);
  EXPECT_EQ(grid->GetNumberOfLines(), 1);
  EXPECT_EQ(grid->GetNumberOfPolys(), 2);
  EXPECT_EQ(grid->GetNumberOfStrips(), 1);
  EXPECT_EQ(grid->GetCellData()->GetScalars()->GetTuple1(5), 6);

  for (const int version : {42, 51}) {
    const vtkNew<vtkPolyDataWriter> writer;
    writer->SetInputData(grid);
    writer->SetFileName((folder.path() / "v.vtk").c_str());
    writer->SetFileVersion(version);
    writer->SetFileTypeToBinary();
    ASSERT_EQ(writer->Write(), 1);
    const Mesh again = read_mesh(folder.path() / "v.vtk");
    expect_same(again, mesh);
    expect_write_and_read(again, "w.vtk");
  }

  // cells that no section holds
  Mesh more = mesh;
  more.cells.push_back(Shape::tetrahedron, std::vector<Index>{0, 1, 2, 3});
  more.data.clear();
  Notes notes;
  write_mesh(more, folder.path() / "u.vtk", &notes);
  EXPECT_EQ(notes.size(), 1U);
  EXPECT_EQ(read_mesh(folder.path() / "u.vtk").cells, more.cells);
}

TEST(VtkLegacy, ColoursTexturesAndOldTypesStay) {
  const std::string text = with(kSmall, "VECTORS wind", R"(COLOR_SCALARS paint 2
0 0.5 1 0.25 0 0 0 0 0 0.1
TEXTURE_COORDINATES uv 2 float
1 2 3 4 5 6 7 8 9 10
TENSORS6 strain float
1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6
EDGE_FLAGS edge unsigned_char
0 1 0 1 0
PEDIGREE_IDS from string
a
b
c%0A
d
e
GLOBAL_IDS number long
5 4 3 2 10000000000
VECTORS wind)");
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.vtk", with(text, "nan", "3")));
  write_mesh(mesh, folder.path() / "b.vtk");
  expect_same(read_mesh(folder.path() / "b.vtk"), mesh);
  const std::string written = content_of(folder.path() / "b.vtk");
  for (const char* part :
       {"COLOR_SCALARS paint 2\n0 0.5 1 0.25", "TEXTURE_COORDINATES uv 2 float\n", "TENSORS6 strain float\n",
        "EDGE_FLAGS edge unsigned_char\n", "PEDIGREE_IDS from string\na\nb\nc%0A\n",
        "GLOBAL_IDS number long\n5 4 3 2 10000000000\n"}) {
    EXPECT_NE(written.find(part), std::string::npos) << part;
  }
}

TEST(VtkLegacy, BecomesVtuAndBackWithRolesAndFields) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.vtk", with(kSmall, "nan", "3")));
  Notes notes;
  write_mesh(mesh, folder.path() / "b.vtu", &notes);
  EXPECT_EQ(notes, (Notes{"not written (VTU cannot hold it): the lookup table 'warm'"}));
  const Mesh back = read_mesh(folder.path() / "b.vtu");
  expect_same(back, mesh);
  write_mesh(back, folder.path() / "c.vtk");
  expect_same(read_mesh(folder.path() / "c.vtk"), mesh);
  const auto grid = read_with_vtk<vtkUnstructuredGridReader>(folder.path() / "c.vtk");
  EXPECT_STREQ(grid->GetPointData()->GetScalars()->GetName(), "heat");
  EXPECT_STREQ(grid->GetPointData()->GetVectors()->GetName(), "wind");
  EXPECT_EQ(grid->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), 0.25);
}

TEST(VtkLegacy, HexahedraOfHigherOrderAreInTheOrderOfTheirVersion) {
  std::string points;
  std::string ids;
  for (int i = 0; i < 64; ++i) {
    points += fmt::format("{} {} {}\n", i, i * i, 1.0 / (i + 1));
    ids += fmt::format(" {}", i);
  }
  const TemporaryFolder folder;
  for (const char* version : {"4.2", "5.1"}) {
    SCOPED_TRACE(version);
    const std::string cells =
        version[0] == '4' ? "CELLS 1 65\n64" + ids
                          : "CELLS 2 64\nOFFSETS vtktypeint64\n0 64\nCONNECTIVITY vtktypeint64\n" + ids;
    const auto path =
        folder.file("h.vtk", fmt::format("# vtk DataFile Version {}\nh\nASCII\nDATASET "
                                         "UNSTRUCTURED_GRID\nPOINTS 64 double\n{}{}\nCELL_TYPES 1\n72\n",
                                         version, points, cells));
    const Mesh mesh = read_mesh(path);
    const auto grid = read_with_vtk<vtkUnstructuredGridReader>(path);
    for (int i = 0; i < 64; ++i)
      EXPECT_EQ(grid->GetCell(0)->GetPointId(i), mesh.cells.vertices[static_cast<std::size_t>(i)]);
    expect_order_and_back(path);
    write_mesh(mesh, folder.path() / "own.vtk");
    const auto own = read_with_vtk<vtkUnstructuredGridReader>(folder.path() / "own.vtk");
    EXPECT_EQ(own->GetCell(0)->GetPointId(28), mesh.cells.vertices[28]);
  }
}

TEST(VtkLegacy, CutFilesAreNoticed) {
  const TemporaryFolder folder;
  expect_truncation_is_noticed("cut.vtk", kSmall);
  // the loss of whole sections of a POLYDATA file is noticed only if data follow
  const auto sections = kPolydata.find("POLYGONS");
  const auto data = kPolydata.find("CELL_DATA");
  const auto one = kPolydata.find("VERTICES");
  expect_truncation_is_noticed("cut.vtk", kPolydata.substr(0, one));
  for (std::size_t size = sections; size + 1 < data; ++size) {
    const std::string cut = kPolydata.substr(0, size) + "\n" + kPolydata.substr(data);
    EXPECT_THROW((void)read_mesh(folder.file("cut.vtk", cut)), InputError) << size;
  }
  write_mesh(tetrahedral_bar(1), folder.path() / "bar.vtk");
  expect_truncation_is_noticed("cut.vtk", content_of(folder.path() / "bar.vtk"));
  const auto grid = read_with_vtk<vtkUnstructuredGridReader>(folder.path() / "bar.vtk");
  for (const int version : {42, 51}) {
    for (const bool binary : {false, true}) {
      write_with_vtk(grid, folder.path() / "e.vtk", binary, version);
      expect_truncation_is_noticed("cut.vtk", content_of(folder.path() / "e.vtk"));
    }
  }
}

TEST(VtkLegacy, PassesOverZeroBytesAndBlanksAfterBinaryData) {
  const TemporaryFolder folder;
  write_mesh(tetrahedral_bar(1), folder.path() / "bar.vtk");
  const auto grid = read_with_vtk<vtkUnstructuredGridReader>(folder.path() / "bar.vtk");
  for (const int version : {42, 51}) {
    write_with_vtk(grid, folder.path() / "e.vtk", true, version);
    const Mesh expected = read_mesh(folder.path() / "e.vtk");
    const std::string content = content_of(folder.path() / "e.vtk");
    for (const std::string_view padding : {std::string_view("\0", 1), std::string_view("\n\0\0 \n\0", 6),
                                           std::string_view("\x1A"), std::string_view("\n \f\r\n")})
      expect_same(read_mesh(folder.file("padded.vtk", content + std::string(padding))), expected);
    EXPECT_NE(read_error(folder.file("more.vtk", content + std::string("\0\0CELLS", 7))), "");
  }
}

TEST(VtkLegacy, DamagedFilesGiveAMeshOrAnError) {
  const TemporaryFolder folder;
  const auto grid = grid_with_everything();
  std::vector<std::string> files{kSmall, kPolydata};
  for (const int version : {42, 51}) {
    for (const bool binary : {false, true}) {
      write_with_vtk(grid, folder.path() / "e.vtk", binary, version);
      files.push_back(content_of(folder.path() / "e.vtk"));
    }
  }
  std::mt19937 random(20240608);
  for (const std::string& content : files) {
    for (int round = 0; round < 250; ++round) {
      std::string damaged = content;
      for (int flips = 0; flips <= round % 4; ++flips) {
        damaged[random() % damaged.size()] =
            static_cast<char>(round % 2 == 0 ? random() % 256 : '0' + random() % 10);
      }
      try {
        check_mesh(read_mesh(folder.file("damaged.vtk", damaged)));
      } catch (const InputError&) {  // that is right, too
      }
    }
  }
}

TEST(VtkLegacy, RealMeshesComeBackFromAnyOrder) {
  const TemporaryFolder folder;
  write_mesh(mixed_mesh(), folder.path() / "mixed.vtk");
  expect_order_and_back(folder.path() / "mixed.vtk");
  expect_order_and_back(folder.file("small.vtk", with(kSmall, "nan", "3")));
  for (const std::string name : {"ring.node", "arch.msh"}) {
    const std::filesystem::path path = folder.path() / (name + ".vtk");
    write_mesh(read_mesh(data_mesh(name)), path);
    expect_order_and_back(path);
  }
}

TEST(VtkLegacy, FullDiskIsAnErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit limit{700, old_limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::string message;
  try {
    write_mesh(tetrahedral_bar(100), folder.path() / "bar.vtk");
  } catch (const InputError& error) {
    message = error.what();
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old_limit), 0);
  (void)std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(message.find("bar.vtk: cannot be written to the end: it would exceed the limit"),
            std::string::npos)
      << message;
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace meshorder::test
