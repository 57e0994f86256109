// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include "support/vtk_grids.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <array>
#include <csignal>
#include <limits>
#include <random>

namespace meshorder::test {
namespace {

/// A tetrahedron and a triangle as text, on lines that the tests of broken files name.
const std::string kSmallVtu = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
  <UnstructuredGrid>
    <FieldData>
      <DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">0.25</DataArray>
    </FieldData>
    <Piece NumberOfPoints="5" NumberOfCells="2">
      <PointData Scalars="heat">
        <DataArray type="Float32" Name="heat" format="ascii">1 2.5 NaN -inf 5</DataArray>
      </PointData>
      <CellData>
        <DataArray type="Int64" IdType="1" Name="part" format="ascii">7 -8</DataArray>
        <DataArray type="String" Name="who" format="ascii">97 98 0 0</DataArray>
      </CellData>
      <Points>
        <DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">
          0 0 0  1 0 0  0 1 0
          0 0 1  0.1 0.2 0.3
        </DataArray>
      </Points>
      <Cells>
        <DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 1 2 4</DataArray>
        <DataArray type="Int64" Name="offsets" format="ascii">4 7</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">10 5</DataArray>
      </Cells>
    </Piece>
  </UnstructuredGrid>
</VTKFile>
)";

/// The compressors of VTK's own writer: none, LZ4, zlib, LZMA.
constexpr std::array kCompressorsOfVtk{VtuEncoding::Compressor::none, VtuEncoding::Compressor::lz4,
                                       VtuEncoding::Compressor::zlib, VtuEncoding::Compressor::lzma};

/// The encoding of a grid by VTK's own writer.
struct Encoding {
  std::string name;
  int mode;        // 0 text, 1 base64, 2 appended
  bool base64;     // appended as base64
  int compressor;  // of kCompressorsOfVtk
  bool big_endian;
  bool wide;
};

/// Returns all encodings that this build can read.
std::vector<Encoding> all_encodings() {
  std::vector<Encoding> result;
  for (const int compressor : {0, 1, 2, 3}) {
    if (!vtk::VtuCompressor::available(kCompressorsOfVtk[static_cast<std::size_t>(compressor)])) continue;
    for (const bool big_endian : {false, true}) {
      for (const bool wide : {false, true}) {
        const std::string name =
            fmt::format("{}{}{}", compressor, big_endian ? "big" : "", wide ? "wide" : "");
        result.push_back({"text" + name, 0, false, compressor, big_endian, wide});
        result.push_back({"base64" + name, 1, false, compressor, big_endian, wide});
        result.push_back({"appended64" + name, 2, true, compressor, big_endian, wide});
        result.push_back({"raw" + name, 2, false, compressor, big_endian, wide});
      }
    }
  }
  return result;
}

void write_with_vtk(vtkUnstructuredGrid* grid, const std::filesystem::path& path, const Encoding& encoding) {
  const vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetFileName(path.c_str());
  writer->SetDataMode(encoding.mode);
  writer->SetEncodeAppendedData(encoding.base64);
  constexpr std::array kTypes{vtkXMLWriterBase::NONE, vtkXMLWriterBase::LZ4, vtkXMLWriterBase::ZLIB,
                              vtkXMLWriterBase::LZMA};
  writer->SetCompressorType(kTypes[static_cast<std::size_t>(encoding.compressor)]);
  writer->SetByteOrder(encoding.big_endian ? vtkXMLWriterBase::BigEndian : vtkXMLWriterBase::LittleEndian);
  writer->SetHeaderType(encoding.wide ? vtkXMLWriterBase::UInt64 : vtkXMLWriterBase::UInt32);
  writer->SetBlockSize(256);
  ASSERT_EQ(writer->Write(), 1);
}

vtkSmartPointer<vtkUnstructuredGrid> read_with_vtk(const std::filesystem::path& path) {
  const vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

/// The encoding in a file: the first tag, the format of its first array, and the encoding of appended data.
std::string encoding_of(const std::filesystem::path& path) {
  const std::string content = content_of(path);
  const auto part = [&](const char* from, const char* to) {
    const auto begin = content.find(from);
    return begin == std::string::npos ? ""
                                      : content.substr(begin, content.find(to, begin + 8) - begin) + "; ";
  };
  return part("<VTKFile", ">") + part("format=\"", "\"") + part("<AppendedData", ">");
}

void expect_same_arrays(vtkUnstructuredGrid* grid, const Mesh& mesh) {
  for (const DataArray& array : mesh.data) {
    SCOPED_TRACE(array.name);
    vtkDataSetAttributes* data = array.association == Association::vertices
                                     ? static_cast<vtkDataSetAttributes*>(grid->GetPointData())
                                     : grid->GetCellData();
    vtkDataArray* own = data->GetArray(array.name.c_str());
    ASSERT_NE(own, nullptr);
    ASSERT_EQ(own->GetNumberOfComponents(), array.components);
    ASSERT_EQ(own->GetNumberOfTuples(), row_count(array));
    std::visit(
        [&](const auto& values) {
          using Number = typename std::decay_t<decltype(values)>::value_type;
          if constexpr (!std::is_same_v<Number, std::string>) {
            for (std::size_t i = 0; i < values.size(); ++i)
              EXPECT_EQ(own->GetVariantValue(static_cast<vtkIdType>(i)).ToDouble(),
                        static_cast<double>(values[i]));
          }
        },
        array.values);
  }
}

}  // namespace

TEST(Vtu, TheFirstPieceThatIsNotEmptyDecides) {
  const TemporaryFolder folder;
  const auto file = [](const char* version, const std::string& piece) {
    return std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"") + version +
           "\" byte_order=\"LittleEndian\"><UnstructuredGrid><FieldData><DataArray type=\"Float64\" "
           "Name=\"time\" "
           "NumberOfTuples=\"1\" format=\"ascii\">0.5</DataArray></FieldData>" +
           piece + "</UnstructuredGrid></VTKFile>\n";
  };
  std::string points;
  std::string corners;
  for (int v = 0; v < 20; ++v) {
    points += std::to_string(v) + " 0 " + std::to_string(v * v) + " ";
    corners += std::to_string(v) + " ";
  }
  const auto array = [](const char* type, const std::string& attributes, const std::string& values) {
    return std::string("<DataArray type=\"") + type + "\" " + attributes + " format=\"ascii\">" + values +
           "</DataArray>";
  };
  const std::string whole = "<Piece NumberOfPoints=\"20\" NumberOfCells=\"1\"><Points>" +
                            array("Float64", "NumberOfComponents=\"3\"", points) + "</Points><Cells>" +
                            array("Int64", "Name=\"connectivity\"", corners) +
                            array("Int64", "Name=\"offsets\"", "20") +
                            array("UInt8", "Name=\"types\"", "25") + "</Cells></Piece>";
  (void)folder.file("empty.vtu", file("0.1", "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>"));
  for (const char* const version : {"0.1", "2.2"}) {
    const Mesh expected = read_mesh(folder.file("whole.vtu", file(version, whole)));
    const Mesh found = read_mesh(folder.file(
        "a.pvtu",
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\" "
        "byte_order=\"LittleEndian\">"
        "<PUnstructuredGrid GhostLevel=\"0\"><Piece Source=\"empty.vtu\"/><Piece Source=\"whole.vtu\"/>"
        "</PUnstructuredGrid></VTKFile>\n"));
    EXPECT_EQ(found.cells, expected.cells) << version;
    EXPECT_EQ(found.format_metadata->contents(), expected.format_metadata->contents()) << "each field once";
  }
}

TEST(Vtu, ReadsPointsCellsAndAllArrays) {
  const TemporaryFolder folder;
  Notes notes;
  const Mesh mesh = read_mesh(folder.file("a.vtu", kSmallVtu), {.notes = &notes});
  EXPECT_EQ(mesh.vertex_count(), 5);
  EXPECT_EQ(mesh.points[4], (Point{0.1, 0.2, 0.3}));
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::tetrahedron, Shape::triangle}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 3, 1, 2, 4}));
  const auto& heat = std::get<std::vector<float>>(find_array(mesh, "heat", Association::vertices)->values);
  EXPECT_EQ(heat[1], 2.5F);
  EXPECT_TRUE(std::isnan(heat[2]));
  EXPECT_EQ(heat[3], -std::numeric_limits<float>::infinity());
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(find_array(mesh, "part", Association::cells)->values),
            (std::vector<std::int64_t>{7, -8}));
  EXPECT_EQ(std::get<std::vector<std::string>>(find_array(mesh, "who", Association::cells)->values),
            (std::vector<std::string>{"ab", ""}));
  EXPECT_EQ(mesh.format_metadata->contents(),
            (std::vector<std::string>{"the field 'TimeValue' of the whole mesh"}));
  EXPECT_TRUE(notes.empty());
}

TEST(Vtu, BrokenFilesGiveOneClearError) {
  const auto broken = [](std::string_view old, std::string_view fresh) {
    return with(kSmallVtu, old, fresh);
  };
  const std::string raw_head =
      R"(<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" header_type="UInt64">
<UnstructuredGrid><Piece NumberOfPoints="1" NumberOfCells="1">
<Points><DataArray type="Float64" NumberOfComponents="3" format="appended" offset="0"/></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="appended" offset="32"/>
<DataArray type="Int32" Name="offsets" format="appended" offset="44"/>
<DataArray type="UInt8" Name="types" format="appended" offset="56"/></Cells></Piece></UnstructuredGrid>
<AppendedData encoding="raw">_)";
  expect_broken(
      "b.vtu",
      {{"no XML", "solid cube\nfacet\n", "looks like STL, not like VTU"},
       {"garbage", std::string("\x00\x9f\x92<\x96\xff>\n\xfe", 9), ":1:"},
       {"a tag that never ends", "<VTKFile type=\"Unstru", "cut short"},
       {"another root", "<html></html>", "VTKFile"},
       {"other content", broken("type=\"UnstructuredGrid\"", "type=\"PolyData\""),
        ":2: the type of the file is PolyData"},
       {"a structured grid", broken("type=\"UnstructuredGrid\"", "type=\"ImageData\""),
        "its order is fixed by the grid"},
       {"unknown byte order", broken("LittleEndian", "MiddleEndian"), ":2: the byte_order"},
       {"unknown header", broken("version=\"0.1\"", "version=\"0.1\" header_type=\"Int8\""),
        ":2: the header_type"},
       {"unknown compressor", broken("version=\"0.1\"", "version=\"0.1\" compressor=\"zip\""),
        ":2: the compressor"},
       {"no grid", "<VTKFile type=\"UnstructuredGrid\"></VTKFile>", "no <UnstructuredGrid>"},
       {"crossing tags", broken("</CellData>", "</Points>"),
        ":14: an end tag has no start; </CellData> is needed"},
       {"a negative count", broken("NumberOfPoints=\"5\"", "NumberOfPoints=\"-5\""),
        ":7: NumberOfPoints is '-5'"},
       {"10¹² points", broken("NumberOfPoints=\"5\"", "NumberOfPoints=\"1000000000000\""),
        ":7: NumberOfPoints"},
       {"a billion points", broken("NumberOfPoints=\"5\"", "NumberOfPoints=\"1000000000\""),
        ":9: the array has 5 values"},
       {"a billion components", broken("NumberOfComponents=\"3\"", "NumberOfComponents=\"1000000000\""),
        ":16: the points have"},
       {"no count", broken(" NumberOfCells=\"2\"", ""), ":7: <Piece> has no NumberOfCells"},
       {"too few values", broken("2.5 NaN", "NaN"), ":9: the array has 4 values; 5 are needed"},
       {"too many values", broken("2.5 NaN", "2.5 2 NaN"), ":9: the array has more than 5"},
       {"a word among numbers", broken("0 1 0\n", "0 l 0\n"),
        ":17: a value is 'l'; the array's type is Float64"},
       {"a value beyond its type", broken(">10 5<", ">10 500<"), ":24: a value is '500'"},
       {"NaN coordinate", broken("0.1 0.2", "nan 0.2"), ":16: point 4"},
       {"infinite coordinate", broken("0.1 0.2", "1e999 0.2"), ":18: a value is '1e999'"},
       {"unknown number type", broken("Float32", "Float31"), ":9: the type is 'Float31'"},
       {"unknown format", broken("format=\"ascii\">7", "format=\"ebcdic\">7"), ":12: the format is 'ebcdic'"},
       {"a text without end", broken("98 0 0", "98 0 99"), ":13: the array has 1 texts"},
       {"no name", broken(" Name=\"heat\"", ""), ":9: <DataArray> has no Name"},
       {"the same name twice", broken("Name=\"who\"", "Name=\"part\""),
        ":13: the array 'part' is given twice"},
       {"no points", broken("<DataArray type=\"Float64\" Name=\"Points\"", "<Nothing type=\"Float64\""), ""},
       {"a point that is not there", broken("1 2 4<", "1 2 5<"),
        ":22: a cell names the point 5; the piece has points 0 to 4"},
       {"a negative point", broken("1 2 4<", "1 -2 4<"), ":22: a cell names the point -2"},
       {"offsets that fall", broken(">4 7<", ">4 3<"), ":23: cell 1"},
       {"offsets beyond the connectivity", broken(">4 7<", ">4 9<"),
        ":22: the array has 7 values; 9 are needed"},
       {"an absurd offset", broken(">4 7<", ">4 1000000000000<"), ":22: the array has 7 values"},
       {"a type that nobody has", broken(">10 5<", ">10 99<"),
        ":24: cell 1 (counted from 0) has the type 99"},
       {"a polyhedron without faces", broken(">10 5<", ">42 5<"),
        ":21: the array faceoffsets is missing in <Cells>; polyhedra have faces and faceoffsets"},
       {"an empty cell", broken(">10 5<", ">0 5<"), ":24: cell 0 (counted from 0) is empty"},
       {"a tetrahedron of three vertices", broken(">4 7<", ">3 7<"),
        ":24: cell 0 (counted from 0) is a VTK_TETRA of 3"},
       {"no types", broken("Name=\"types\"", "Name=\"kinds\""), "the array types is missing"},
       {"no cells",
        with(broken("NumberOfCells=\"2\"", "NumberOfCells=\"0\""),
             ">7 -8</DataArray>\n        <DataArray type=\"String\" Name=\"who\" format=\"ascii\">97 98 0 0<",
             "><"),
        "has no cells"},
       {"time steps", broken("Name=\"heat\"", "Name=\"heat\" TimeStep=\"0 1\""),
        ":9: the file holds several time steps"},
       {"a second time step", broken("Name=\"heat\"", "Name=\"heat\" TimeStep=\"1\""),
        ":9: the file holds several time steps"},
       {"appended data that are not there",
        broken("format=\"ascii\">7 -8", "format=\"appended\" offset=\"0\">"), ":12: the array is appended"},
       {"no base64", broken("format=\"ascii\">7 -8", "format=\"binary\">EAAAAAcA*AAAAAAA+P//////////"),
        ":12: the array is not base64"},
       {"short base64", broken("format=\"ascii\">7 -8", "format=\"binary\">EAAA"),
        ":12: the array's bytes end early"},
       {"raw data that end", raw_head + std::string("\x18\0\0\0\0\0\0\0ab", 10),
        ":3: the array has 24 bytes"},
       {"raw data of an absurd size",
        raw_head + std::string("\x18\0\0\0\0\0\xff\xff", 8) + std::string(100, 'x'), ":3: the array has"},
       {"an offset beyond the end", with(raw_head, "offset=\"0\"", "offset=\"77\""),
        ":3: the offset 77 lies beyond the file"},
       {"a negative offset", with(raw_head, "offset=\"0\"", "offset=\"-1\""),
        ":3: offset is '-1'; a whole number"},
       {"no offset", with(raw_head, "offset=\"0\"", "offset=\" \""), ":3: offset is ' '"},
       {"unknown coding of what is appended", with(raw_head, "\"raw\"", "\"uu\""), ":7: the encoding"},
       {"nothing appended", with(raw_head, ">_", ">"), ":7: <AppendedData> does not begin"}});
}

TEST(Vtu, FolderOrEmptyFileIsAnError) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "c.vtu");
  EXPECT_NE(read_error(folder.path() / "c.vtu").find("is a folder"), std::string::npos);
  EXPECT_NE(read_error(folder.file("d.vtu", "")).find("is empty"), std::string::npos);
}

TEST(Vtu, ValuesStandAfterCommentsAndInformationToo) {
  const TemporaryFolder folder;
  std::string text = with(kSmallVtu, "NaN -inf", "3 4");
  const Mesh plain = read_mesh(folder.file("a.vtu", text));
  // a comment and information in every array, before its values
  for (std::size_t at = text.find("<DataArray"); at != std::string::npos;
       at = text.find("<DataArray", at + 1)) {
    const std::size_t end = text.find('>', at) + 1;
    text.insert(
        end,
        "\n <!-- by hand -->\n <InformationKey name=\"UNITS\" location=\"vtkDataArray\">9</InformationKey>"
        "\n <!-- 1 2 3 -->");
  }
  expect_same(read_mesh(folder.file("b.vtu", text)), plain);
}

TEST(Vtu, AnEmptyNumberOfComponentsIsOne) {
  const TemporaryFolder folder;
  const std::string text = with(kSmallVtu, "NaN -inf", "3 4");
  expect_same(
      read_mesh(folder.file("a.vtu", with(text, "Name=\"heat\"", "Name=\"heat\" NumberOfComponents=\"\""))),
      read_mesh(folder.file("b.vtu", text)));
}

TEST(Vtu, NumbersInAttributesMayHaveBlanksAndASign) {
  const TemporaryFolder folder;
  const std::string text =
      with(with(kSmallVtu, "NaN -inf", "3 4"), "Name=\"heat\"", "Name=\"heat\" TimeStep=\"0\"");
  Mesh mesh = read_mesh(folder.file("a.vtu", text));
  write_mesh(mesh, folder.path() / "ascii.vtu");
  mesh.format_metadata.reset();
  write_mesh(mesh, folder.path() / "appended.vtu");  // its arrays have offsets
  const std::string appended = content_of(folder.path() / "appended.vtu");
  const std::vector<std::pair<std::string, std::string>> attributes{
      {"NumberOfPoints", text}, {"NumberOfCells", text}, {"NumberOfComponents", text},
      {"NumberOfTuples", text}, {"version", text},       {"TimeStep", text},
      {"IdType", text},         {"offset", appended}};
  for (const auto& [attribute, whole] : attributes) {
    for (const std::string_view before : {"    ", "\n\t", "\r\n+"}) {
      if (before.ends_with('+') &&
          (attribute == "version" || attribute == "IdType" || attribute == "TimeStep"))
        continue;
      std::string changed = whole;
      const std::string begin = " " + attribute + "=\"";
      for (std::size_t at = changed.find(begin); at != std::string::npos; at = changed.find(begin, at + 1)) {
        changed.insert(at + begin.size(), before);
        changed.insert(changed.find('"', at + begin.size()), " \t");
      }
      ASSERT_NE(changed, whole) << attribute;
      const Mesh found = read_mesh(folder.file("b.vtu", changed));
      expect_same(found, mesh);
      write_mesh(found, folder.path() / "c.vtu");
      EXPECT_EQ(content_of(folder.path() / "c.vtu"),
                attribute == "offset" ? appended : content_of(folder.path() / "ascii.vtu"))
          << attribute;
    }
  }
}

TEST(Vtu, AFileOfOneTimeStepIsRead) {
  const TemporaryFolder folder;
  const std::string text = with(with(kSmallVtu, "<UnstructuredGrid>", "<UnstructuredGrid TimeValues=\"0 \">"),
                                "Name=\"heat\"", "Name=\"heat\" TimeStep=\"0\"");
  Notes notes;
  const Mesh mesh = read_mesh(folder.file("a.vtu", text), {.notes = &notes});
  EXPECT_EQ(mesh.cell_count(), 2);
  EXPECT_EQ(notes, Notes{"the time of the only step is left out"});
}

TEST(Vtu, MixedLineEndsAreRead) {
  std::string text = kSmallVtu;
  int i = 0;
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) {
    if (++i % 2 == 0) text.insert(at, "\r");
  }
  const TemporaryFolder folder;
  expect_same(read_mesh(folder.file("a.vtu", with(text, "NaN -inf", "3 4"))),
              read_mesh(folder.file("b.vtu", with(kSmallVtu, "NaN -inf", "3 4"))));
}

TEST(Vtu, EveryCellTypeIsWrittenAndRead) {
  for (const auto& [shape, vertices] : types_of_vtk()) {
    SCOPED_TRACE(type_name(shape, vertices));
    expect_write_and_read(cells_of_type(shape, vertices, 3), "cells.vtu");
  }
  expect_write_and_read(mixed_mesh(), "mixed.vtu");
}

TEST(Vtu, FacesOfCellsFromGmshAreOutwardInVtkAndBack) {
  const TemporaryFolder folder;
  const auto gmsh = folder.file("a.msh", kVolumesOfGmsh);
  const Mesh mesh = read_mesh(gmsh);
  expect_wedges_of_gmsh(mesh);
  write_mesh(mesh, folder.path() / "b.vtu");
  expect_faces_outward(read_with_vtk(folder.path() / "b.vtu"));
  const Mesh back = read_mesh(folder.path() / "b.vtu");
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
}

TEST(Vtu, WedgesOfVtkArriveInGmshTheRightWayRoundAndStayInVtk) {
  const TemporaryFolder folder;
  const auto grid = grid_of_wedges();
  expect_faces_outward(grid);
  for (const Encoding& encoding : all_encodings()) {
    SCOPED_TRACE(encoding.name);
    write_with_vtk(grid, folder.path() / "a.vtu", encoding);
    const Mesh mesh = read_mesh(folder.path() / "a.vtu");
    expect_wedges_of_gmsh(mesh);
    write_mesh(mesh, folder.path() / "b.msh");
    const std::string written = content_of(folder.path() / "b.msh");
    EXPECT_NE(written.find("\n1 1 3 2 4 6 5\n"), std::string::npos) << written;
    EXPECT_NE(written.find("\n2 7 9 8 10 12 11\n"), std::string::npos) << written;

    write_mesh(mesh, folder.path() / "c.vtu");
    const auto back = read_with_vtk(folder.path() / "c.vtu");
    EXPECT_EQ(points_of_cells(back), points_of_cells(grid));
    EXPECT_EQ(back->GetCellType(0), VTK_WEDGE);
    EXPECT_EQ(back->GetCellType(1), VTK_LAGRANGE_WEDGE);
    write_mesh(read_mesh(folder.path() / "c.vtu"), folder.path() / "d.vtu");
    EXPECT_EQ(content_of(folder.path() / "d.vtu"), content_of(folder.path() / "c.vtu"));
  }
}

TEST(Vtu, WedgesOfLaterVersionsOfVtkAreKnownByTheirVolumes) {
  const TemporaryFolder folder;
  const auto grid = grid_of_wedges(true);
  write_with_vtk(grid, folder.path() / "a.vtu", all_encodings().front());
  const Mesh mesh = read_mesh(folder.path() / "a.vtu");
  expect_wedges_of_gmsh(mesh);
  write_mesh(mesh, folder.path() / "c.vtu");
  EXPECT_EQ(points_of_cells(read_with_vtk(folder.path() / "c.vtu")), points_of_cells(grid));
  // in a mirrored mesh all volumes are negative
  vtkPoints* const points = grid->GetPoints();
  for (vtkIdType p = 0; p < points->GetNumberOfPoints(); ++p) {
    points->SetPoint(p, -points->GetPoint(p)[0], points->GetPoint(p)[1], points->GetPoint(p)[2]);
  }
  const std::array<vtkIdType, 4> tetrahedron{0, 2, 1, 3};
  grid->InsertNextCell(VTK_TETRA, 4, tetrahedron.data());
  write_with_vtk(grid, folder.path() / "a.vtu", all_encodings().front());
  EXPECT_EQ(read_mesh(folder.path() / "a.vtu").cells[0][1], 2);
}

TEST(Vtu, VtkReadsWhatWeWrite) {
  const TemporaryFolder folder;
  const Mesh mesh = mixed_mesh();
  write_mesh(mesh, folder.path() / "mixed.vtu");
  const auto grid = read_with_vtk(folder.path() / "mixed.vtu");
  expect_same_grid(grid, mesh);
  expect_same_arrays(grid, mesh);
  EXPECT_EQ(grid->GetCellType(4), VTK_TETRA);
  EXPECT_EQ(grid->GetPointData()->GetArray("stress")->GetNumberOfComponents(), 3);
  EXPECT_EQ(grid->GetPointData()->GetArray("stress")->GetComponent(7, 1), 1.0 / (3 * 7 + 1 + 3.0));
  EXPECT_EQ(grid->GetCellData()->GetArray("set:part")->GetTuple1(0), 1);
  EXPECT_EQ(grid->GetCellData()->GetArray("set:part")->GetTuple1(1), 0);
}

TEST(Vtu, EveryEncodingOfVtkIsReadAndKept) {
  const TemporaryFolder folder;
  write_mesh(mixed_mesh(), folder.path() / "mixed.vtu");
  const auto grid = read_with_vtk(folder.path() / "mixed.vtu");
  for (const Encoding& encoding : all_encodings()) {
    SCOPED_TRACE(encoding.name);
    const auto path = folder.path() / (encoding.name + ".vtu");
    write_with_vtk(grid, path, encoding);
    const Mesh mesh = read_mesh(path);
    expect_same(mesh, mixed_mesh());
    const auto again = folder.path() / ("again-" + encoding.name + ".vtu");
    write_mesh(mesh, again);
    expect_same(read_mesh(again), mixed_mesh());
    EXPECT_EQ(encoding_of(again), encoding_of(path));
    expect_same_grid(read_with_vtk(again), mesh);
    expect_same_arrays(read_with_vtk(again), mesh);
  }
}

TEST(Vtu, RolesFieldsIdsUnitsAndComponentNamesSurvive) {
  const TemporaryFolder folder;
  const auto small = folder.file("small.vtu", with(kSmallVtu, "NaN -inf", "3 4"));
  const auto grid = read_with_vtk(small);
  grid->GetPointData()->GetArray("heat")->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), "K");
  const vtkNew<vtkDoubleArray> velocity;
  velocity->SetName("speed &amp; &lt;course>");  // VTK 9.1 writes names as they are
  velocity->SetNumberOfComponents(3);
  velocity->SetNumberOfTuples(5);
  velocity->Fill(1.0 / 3);
  velocity->SetComponentName(1, "north");
  grid->GetPointData()->SetVectors(velocity);
  grid->GetCellData()->SetGlobalIds(grid->GetCellData()->GetArray("part"));
  write_with_vtk(grid, folder.path() / "a.vtu", {"", 0, false, 0, false, false});

  Mesh mesh = read_mesh(folder.path() / "a.vtu");
  apply_reordering(mesh, shuffled(5, 3), Permutation::identity(2));
  write_mesh(mesh, folder.path() / "b.vtu");
  const auto back = read_with_vtk(folder.path() / "b.vtu");
  EXPECT_STREQ(back->GetPointData()->GetScalars()->GetName(), "heat");
  EXPECT_STREQ(back->GetPointData()->GetVectors()->GetName(), "speed & <course>");
  EXPECT_STREQ(back->GetPointData()->GetVectors()->GetComponentName(1), "north");
  EXPECT_STREQ(back->GetCellData()->GetGlobalIds()->GetName(), "part");
  EXPECT_EQ(back->GetCellData()->GetGlobalIds()->GetDataType(), VTK_ID_TYPE);
  EXPECT_EQ(back->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), 0.25);
  EXPECT_STREQ(back->GetPointData()->GetArray("heat")->GetInformation()->Get(vtkDataArray::UNITS_LABEL()),
               "K");
  EXPECT_EQ(back->GetPointData()->GetArray("heat")->GetDataType(), VTK_FLOAT);
}

TEST(Vtu, FloatPointsStayFloats) {
  const TemporaryFolder folder;
  const std::string text = with(with(kSmallVtu, "<DataArray type=\"Float64\" Name=\"Points\"",
                                     "<DataArray type=\"Float32\" Name=\"Points\""),
                                "NaN -inf", "3 4");
  Mesh mesh = read_mesh(folder.file("a.vtu", text));
  write_mesh(mesh, folder.path() / "b.vtu");
  EXPECT_EQ(read_with_vtk(folder.path() / "b.vtu")->GetPoints()->GetDataType(), VTK_FLOAT);
  expect_same(read_mesh(folder.path() / "b.vtu"), mesh);
  // a coordinate that is no float
  mesh.points[0][0] = 0.1;
  write_mesh(mesh, folder.path() / "c.vtu");
  EXPECT_EQ(read_with_vtk(folder.path() / "c.vtu")->GetPoints()->GetDataType(), VTK_DOUBLE);
}

TEST(Vtu, LagrangeCellsStayLagrange) {
  const TemporaryFolder folder;
  Mesh mesh = cells_of_type(Shape::tetrahedron, 10, 2);
  mesh.data.push_back({"vtk:type", Association::cells, 1, std::vector<std::uint8_t>{71, 24}, {}, {}});
  write_mesh(mesh, folder.path() / "a.vtu");
  const auto grid = read_with_vtk(folder.path() / "a.vtu");
  EXPECT_EQ(grid->GetCellType(0), VTK_LAGRANGE_TETRAHEDRON);
  EXPECT_EQ(grid->GetCellType(1), VTK_QUADRATIC_TETRA);
  EXPECT_EQ(grid->GetCellData()->GetArray("vtk:type"), nullptr);

  Mesh back = read_mesh(folder.path() / "a.vtu");
  apply_reordering(back, Permutation::identity(back.vertex_count()), Permutation::from_old_to_new({1, 0}));
  write_mesh(back, folder.path() / "b.vtu");
  EXPECT_EQ(read_with_vtk(folder.path() / "b.vtu")->GetCellType(1), VTK_LAGRANGE_TETRAHEDRON);
}

TEST(Vtu, CellsOfHigherOrderAreWrittenOnlyInTheOrderOfVtk) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.vtu";
  try {
    write_mesh(cells_of_type(Shape::tetrahedron, 20, 1), path);
    ADD_FAILURE() << "written";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("tetrahedron20"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(folder.names().empty());

  std::string points;
  std::string ids;
  for (int i = 0; i < 64; ++i) {
    points += fmt::format("{} {} {} ", i, i * i, 1.0 / (i + 1));
    ids += fmt::format("{} ", i);
  }
  const auto hexahedron = [&](const char* version) {
    return fmt::format(
        R"(<VTKFile type="UnstructuredGrid" version="{}"><UnstructuredGrid><Piece NumberOfPoints="64" NumberOfCells="1">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{}</DataArray></Points><Cells>
<DataArray type="Int32" Name="connectivity" format="ascii">{}</DataArray><DataArray type="Int32" Name="offsets" format="ascii">64</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">72</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)",
        version, points, ids);
  };
  for (const char* version : {"1.0", "2.2"}) {
    SCOPED_TRACE(version);
    const auto own = folder.file("h.vtu", hexahedron(version));
    const Mesh mesh = read_mesh(own);
    // VTK 9 swapped the last two of the edges along z
    EXPECT_EQ(mesh.cells.vertices[28], version[0] == '1' ? 30 : 28);
    const auto grid = read_with_vtk(own);
    for (int i = 0; i < 64; ++i)
      EXPECT_EQ(grid->GetCell(0)->GetPointId(i), mesh.cells.vertices[static_cast<std::size_t>(i)]);
    write_mesh(mesh, path);
    expect_same(read_mesh(path), mesh);
    EXPECT_EQ(read_with_vtk(path)->GetCell(0)->GetPointId(28), mesh.cells.vertices[28]);
  }
}

TEST(Vtu, PixelsAndVoxelsBecomeQuadsAndHexahedra) {
  const TemporaryFolder folder;
  const std::string text = with(
      with(with(with(kSmallVtu, ">0 1 2 3 1 2 4<", ">0 1 2 3 1 2 4<"), "0 1 2 3 1 2 4", "0 1 2 3 0 1 2 4"),
           ">4 7<", ">4 8<"),
      ">10 5<", ">8 9<");
  Notes notes;
  const Mesh mesh = read_mesh(folder.file("a.vtu", text), {.notes = &notes});
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::quad, Shape::quad}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 3, 2, 0, 1, 2, 4}));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("VTK_PIXEL"), std::string::npos);
}

TEST(Vtu, PiecesBecomeOne) {
  const auto begin = kSmallVtu.find("    <Piece");
  const auto end = kSmallVtu.find("  </UnstructuredGrid>");
  const std::string piece = kSmallVtu.substr(begin, end - begin);
  const std::string empty = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>";
  const TemporaryFolder folder;
  Notes notes;
  const Mesh mesh =
      read_mesh(folder.file("a.vtu", with(kSmallVtu, piece, piece + empty + piece)), {.notes = &notes});
  EXPECT_EQ(mesh.vertex_count(), 10);
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 3, 1, 2, 4, 5, 6, 7, 8, 6, 7, 9}));
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(find_array(mesh, "part", Association::cells)->values),
            (std::vector<std::int64_t>{7, -8, 7, -8}));
  EXPECT_EQ(notes, (Notes{"the 2 pieces of the file became one"}));
  expect_broken("b.vtu", {{"an array that one piece lacks",
                           with(kSmallVtu, piece, piece + with(piece, "Name=\"heat\"", "Name=\"cold\"")),
                           "'heat' is missing in a piece"},
                          {"another type", with(kSmallVtu, piece, piece + with(piece, "Float32", "Float64")),
                           "of another type"}});
}

TEST(Vtu, CutFilesAreNoticedInEveryEncoding) {
  const TemporaryFolder folder;
  const Mesh mesh = tetrahedral_bar(1);
  write_mesh(mesh, folder.path() / "bar.vtu");
  const auto grid = read_with_vtk(folder.path() / "bar.vtu");
  for (const Encoding& encoding : all_encodings()) {
    // each way of storing once, and the blocks of one compressor
    const bool blocks = encoding.compressor != 0;
    if (encoding.big_endian || encoding.wide) continue;
    if (blocks && (encoding.compressor != 2 || encoding.mode == 0 || encoding.base64)) continue;
    SCOPED_TRACE(encoding.name);
    write_with_vtk(grid, folder.path() / "e.vtu", encoding);
    expect_truncation_is_noticed("cut.vtu", content_of(folder.path() / "e.vtu"));
  }
}

TEST(Vtu, DamagedFilesGiveAMeshOrAnError) {
  const TemporaryFolder folder;
  write_mesh(tetrahedral_bar(1), folder.path() / "bar.vtu");
  const auto grid = read_with_vtk(folder.path() / "bar.vtu");
  std::mt19937 random(20240607);
  for (const Encoding& encoding : all_encodings()) {
    SCOPED_TRACE(encoding.name);
    write_with_vtk(grid, folder.path() / "e.vtu", encoding);
    const std::string content = content_of(folder.path() / "e.vtu");
    for (int round = 0; round < 40; ++round) {
      std::string damaged = content;
      for (int flips = 0; flips <= round % 4; ++flips) {
        damaged[random() % damaged.size()] =
            static_cast<char>(round % 2 == 0 ? random() % 256 : '0' + random() % 10);
      }
      try {
        check_mesh(read_mesh(folder.file("damaged.vtu", damaged)));
      } catch (const InputError&) {  // that is right, too
      }
    }
  }
}

TEST(Vtu, PartialArraysSetsAndIdsAreKeptAsArrays) {
  Mesh mesh = tetrahedral_bar(1);
  mesh.data.push_back({"load", Association::vertices, 2, std::vector<double>{1, 2, 3, 4}, {5, 1}, {}});
  mesh.data.push_back({"mark", Association::cells, 1, std::vector<std::int16_t>{9}, {2}, {}});
  mesh.data.push_back({"mark", Association::cells, 1, std::vector<double>(6, 0.5), {}, {}});
  mesh.sets.push_back({"path", Association::vertices, {7, 0, 3}});
  mesh.sets.push_back({"nothing", Association::cells, {}});
  mesh.vertex_ids = {2, 4, 6, 8, 10, 12, 14, 16};
  const TemporaryFolder folder;
  Notes notes;
  write_mesh(mesh, folder.path() / "a.vtu", &notes);
  const Mesh back = read_mesh(folder.path() / "a.vtu");
  const auto& load = std::get<std::vector<double>>(find_array(back, "load", Association::vertices)->values);
  EXPECT_EQ(load[2], 3);
  EXPECT_EQ(load[11], 2);
  EXPECT_TRUE(std::isnan(load[0]));
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(find_array(back, "mark", Association::cells)->values),
            (std::vector<std::int16_t>{0, 0, 9, 0, 0, 0}));
  EXPECT_EQ(std::get<std::vector<double>>(find_array(back, "mark_2", Association::cells)->values),
            std::vector<double>(6, 0.5));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(find_array(back, "vertex_id", Association::vertices)->values),
            (std::vector<std::int32_t>{2, 4, 6, 8, 10, 12, 14, 16}));
  ASSERT_EQ(back.sets.size(), 4U);
  EXPECT_EQ(back.sets[1], (EntitySet{"path", Association::vertices, {7, 0, 3}}));
  EXPECT_EQ(back.sets[3], (EntitySet{"nothing", Association::cells, {}}));
  const std::string all = fmt::format("{}", fmt::join(notes, "\n"));
  for (const char* part :
       {"'load' is given for some vertices; the others get NaN",
        "'mark' is given for some cells; the others get 0", "'mark' on cells is written as 'mark_2'",
        "the set 'path' of vertices is written as the array 'set:path'",
        "the ids of vertices are written as the array 'vertex_id'"}) {
    EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
  }
}

TEST(Vtu, RealMeshesComeBackFromAnyOrder) {
  const TemporaryFolder folder;
  Mesh mesh = mixed_mesh();
  mesh.sets.push_back({"path", Association::vertices, {7, 0, 3}});
  write_mesh(mesh, folder.path() / "mixed.vtu");
  expect_order_and_back(folder.path() / "mixed.vtu");
  for (const std::string name : {"ring.node", "arch.msh"}) {
    const std::filesystem::path path = folder.path() / (name + ".vtu");
    write_mesh(read_mesh(data_mesh(name)), path);
    expect_order_and_back(path);
  }
}

TEST(Vtu, FullDiskIsAnErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  // a limit on the size of files acts like a full disk
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  for (const rlim_t size : {rlim_t{0}, rlim_t{700}, rlim_t{4096}, rlim_t{100000}}) {
    SCOPED_TRACE(size);
    const rlimit limit{size, old_limit.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    std::string message;
    try {
      write_mesh(tetrahedral_bar(2000), folder.path() / "bar.vtu");
    } catch (const InputError& error) {
      message = error.what();
    }
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old_limit), 0);
    EXPECT_NE(message.find("bar.vtu: cannot be written to the end: it would exceed the limit"),
              std::string::npos)
        << message;
    EXPECT_TRUE(folder.names().empty());
  }
  (void)std::signal(SIGXFSZ, old_handler);
}

TEST(Vtu, UnwritableTargetIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_mesh(tetrahedral_bar(1), folder.path() / "nowhere" / "bar.vtu"), InputError);
  std::filesystem::create_directory(folder.path() / "bar.vtu");
  EXPECT_THROW(write_mesh(tetrahedral_bar(1), folder.path() / "bar.vtu"), InputError);
}

TEST(Vtu, NothingIsPrinted) {
  testing::internal::CaptureStderr();
  const TemporaryFolder folder;
  write_mesh(mixed_mesh(), folder.path() / "a.vtu");
  const auto grid = read_with_vtk(folder.path() / "a.vtu");
  write_with_vtk(grid, folder.path() / "b.vtu", {"", 2, false, 2, false, false});
  std::string content = content_of(folder.path() / "b.vtu");
  for (std::size_t i = content.find("_") + 40; i < content.size(); i += 7) content[i] = 'x';
  EXPECT_THROW((void)read_mesh(folder.file("c.vtu", content)), InputError);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace meshorder::test
