// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"

#include "base/input_file.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/round_trip.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <sstream>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

/// Cells of all linear volumes and surfaces, interleaved.
Mesh interleaved(const std::vector<Shape>& shapes) {
  const Mesh all = test::mixed_mesh();
  Mesh mesh;
  mesh.points = all.points;
  for (Index c = 0; c < all.cell_count(); ++c) {
    const bool linear = all.cells.vertex_count(c) == corners(all.cells.shapes[c], 0);
    const bool wanted = std::find(shapes.begin(), shapes.end(), all.cells.shapes[c]) != shapes.end();
    if (linear && wanted) mesh.cells.push_back(all.cells.shapes[c], all.cells[c]);
  }
  return mesh;
}

TEST(Format, IsFoundByItsExtensionInAnyCase) {
  EXPECT_EQ(format_of("a.MSH").name, format_of("b.msh").name);
  EXPECT_THROW((void)format_of("a.txt"), InputError);
  EXPECT_THROW((void)format_of("mesh"), InputError);
}

TEST(Format, EachHasAReaderAndAWriter) {
  for (const Format& format : all_formats()) {
    EXPECT_NE(format.read, nullptr) << format.name;
    EXPECT_NE(format.write, nullptr) << format.name;
    EXPECT_NE(format.holds, nullptr) << format.name;
  }
}

TEST(Format, ExtensionsAreUnique) {
  std::vector<std::string> all;
  for (const FormatInfo& format : formats()) {
    all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

/// Extensions of formats whose files are text.
constexpr std::array<std::string_view, 12> kTexts{".msh", ".mesh", ".vtk", ".vtu", ".off", ".obj",
                                                  ".ply", ".stl",  ".unv", ".inp", ".bdf", ".avs"};

TEST(Format, PassesOverAByteOrderMark) {
  const TemporaryFolder folder;
  const Mesh mesh = test::cells_of_type(Shape::triangle, 3, 2);
  for (const std::string_view extension : kTexts) {
    const std::filesystem::path plain = folder.path() / ("plain" + std::string(extension));
    write_mesh(mesh, plain);
    const std::string text = test::content_of(plain);
    const std::string name = "marked" + std::string(extension);
    const Mesh expected = read_mesh(plain);
    const Mesh marked = read_mesh(folder.file(name, "\xEF\xBB\xBF" + text));
    EXPECT_EQ(marked.points, expected.points) << name;
    EXPECT_EQ(marked.cells, expected.cells) << name;
    write_mesh(marked, folder.path() / name);
    EXPECT_EQ(test::content_of(folder.path() / name), text) << "written without it";

    std::string wide = "\xFF\xFE";
    for (const char c : text) wide.append({c, '\0'});
    EXPECT_THAT(test::read_error(folder.file(name, wide)), HasSubstr("is text in UTF-16; save it in UTF-8"));
  }
  EXPECT_EQ(format_of_bytes("\xEF\xBB\xBFMeshVersionFormatted 2")->name, "Medit");
  EXPECT_THAT(test::read_error(folder.file("only.obj", "\xEF\xBB\xBF")), HasSubstr("has no text"));
  EXPECT_THAT(test::read_error(folder.file("short.obj", "\xFF\xFE")), HasSubstr("short.obj"));
}

TEST(Format, PassesOverZeroBytesAfterTheText) {
  const TemporaryFolder folder;
  std::vector<std::string> texts(kTexts.begin(), kTexts.end());
  texts.insert(texts.end(), {".veg", ".node", ".mtx", ".graph"});
  for (const std::string& extension : texts) {
    const bool is_matrix = extension == ".mtx" || extension == ".graph";
    const bool is_solid = extension == ".node" || extension == ".veg";
    const std::string name = "padded" + extension;
    const std::filesystem::path plain = folder.path() / ("plain" + extension);
    write_mesh(is_matrix  ? test::cells_of_type(Shape::line, 2, 2)
               : is_solid ? test::cells_of_type(Shape::tetrahedron, 4, 2)
                          : test::cells_of_type(Shape::triangle, 3, 2),
               plain);
    if (test::content_of(plain).find('\0') != std::string::npos) continue;  // is binary
    const Mesh expected = read_mesh(plain);
    for (const std::string_view padding : {std::string_view("\0", 1), std::string_view("\r\n\0\0\0", 5),
                                           std::string_view("\x1A"), std::string_view("\0 \n\0\n", 5)}) {
      if (extension == ".node")
        (void)folder.file("padded.ele", test::content_of(folder.path() / "plain.ele").append(padding));
      const Mesh padded = read_mesh(folder.file(name, test::content_of(plain).append(padding)));
      EXPECT_EQ(padded.points, expected.points) << name;
      EXPECT_EQ(padded.cells, expected.cells) << name;
      write_mesh(padded, folder.path() / name);
      const std::string written = test::content_of(folder.path() / name);
      EXPECT_EQ(written.find_first_of(std::string_view("\0\x1A", 2)), std::string::npos) << name;
    }
  }
  EXPECT_THAT(test::read_error(folder.file("zeros.obj", std::string(100, '\0'))), HasSubstr("has no text"));
  EXPECT_THAT(test::read_error(folder.file("within.obj", std::string("v 0 0 0\n\0v 1 0 0\n\0", 18))),
              HasSubstr(":2: the statement '?v' is unknown"));
}

TEST(Format, SeparatesWordsAtFormFeedsAndVerticalTabsToo) {
  const TemporaryFolder folder;
  std::vector<std::string> texts(kTexts.begin(), kTexts.end());
  texts.insert(texts.end(), {".su2", ".veg", ".mtx", ".graph"});
  for (const std::string& extension : texts) {
    const bool is_matrix = extension == ".mtx" || extension == ".graph";
    const std::filesystem::path plain = folder.path() / ("plain" + extension);
    const bool is_solid = extension == ".veg" || extension == ".su2";
    write_mesh(is_matrix  ? test::cells_of_type(Shape::line, 2, 2)
               : is_solid ? test::cells_of_type(Shape::tetrahedron, 4, 2)
                          : test::cells_of_type(Shape::triangle, 3, 2),
               plain);
    std::string text = test::content_of(plain);
    if (text.find('\0') != std::string::npos) continue;  // is binary
    const Mesh expected = read_mesh(plain);
    for (const char blank : {'\f', '\v'}) {
      std::ranges::replace(text, ' ', blank);
      Mesh mesh;
      EXPECT_NO_THROW(mesh = read_mesh(folder.file("other" + extension, text))) << extension;
      EXPECT_EQ(mesh.points, expected.points) << extension;
      EXPECT_EQ(mesh.cells, expected.cells) << extension;
      std::ranges::replace(text, blank, ' ');
    }
  }
}

TEST(Format, NamesTheFormatOfTheContentWhereTheNameIsThatOfAnother) {
  const TemporaryFolder folder;
  const Mesh mesh = test::cells_of_type(Shape::tetrahedron, 4, 2);
  write_mesh(mesh, folder.path() / "a.vtu");
  const std::string vtu = test::content_of(folder.path() / "a.vtu");
  const std::string nastran = "ID A,B\nSOL 101\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nENDDATA\n";
  struct Case {
    std::string name;
    std::string text;
    std::string expected;
  };
  const std::vector<Case> cases{
      {"a.inp", nastran, "looks like Nastran, not like Abaqus; name it .bdf"},
      {"a.unv", nastran, "looks like Nastran, not like UNV; name it .bdf"},
      {"a.vtk", vtu, "looks like VTU, not like VTK; name it .vtu"},
      {"a.off", "solid a\nendsolid a\n", "looks like STL, not like OFF; name it .stl"},
      {"a.dat", nastran, "looks like Nastran, but its name does not end so; name it .bdf"},
      {"noname", vtu, "looks like VTU, but its name does not end so; name it .vtu"},
      {"a.xml", "<mesh/>", "may be a mesh of legacy FEniCS"},
      {"b.vtk", "<VTKFile type=\"PolyData\"/>", "b.vtk:1: "},
      {"a.veg", "*PROPERTY\n", "a.veg:2: the file has no *VERTICES"},
      {"b.inp", "$ comment\nNODE 1\n", "b.inp:1: expected a keyword"},
      {"c.dat", "*KEYWORD\n*NODE\n", "unknown extension '.dat'"},
      {"d.dat", "nothing known", "unknown extension '.dat'"},
  };
  for (const Case& one : cases) {
    EXPECT_THAT(test::read_error(folder.file(one.name, one.text)), HasSubstr(one.expected)) << one.name;
  }
}

TEST(Format, SaysThatAFileIsAPointerOfGitLfs) {
  const TemporaryFolder folder;
  const std::string text = "version https://git-lfs.github.com/spec/v1\noid sha256:01ab\nsize 12345\n";
  for (const Format& format : all_formats()) {
    const std::string fault =
        test::read_error(folder.file("pointer" + std::string(format.extensions.front()), text));
    EXPECT_THAT(fault, HasSubstr("is a pointer of Git LFS, not the file; get the file by `git lfs pull`"));
  }
  // the descriptor of a file that is refused is closed
  const std::filesystem::path pointer = folder.file("mesh.ele", text);
  const auto open_files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  };
  const auto before = open_files();
  EXPECT_THROW((void)InputFile(pointer), InputError);
  EXPECT_EQ(open_files(), before);
  EXPECT_THAT(test::read_error(folder.file("mesh.node", "1 3 0 0\n1 0 0 0\n")),
              testing::AllOf(HasSubstr("mesh.ele"), HasSubstr("Git LFS")));
  ReadOptions options;
  options.format = "OFF";
  std::istringstream stream(text);
  try {
    (void)read_mesh(stream, options);
    FAIL() << "a pointer was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("Git LFS"));
  }
  EXPECT_THAT(test::read_error(folder.file("similar.off", "version https://example.org")),
              Not(HasSubstr("Git LFS")));
}

TEST(ArrangeCells, MakesAConvertedFileHoldTheOrderThatWasComputed) {
  const std::vector<std::pair<std::string, std::vector<Shape>>> targets{
      {".node", {Shape::tetrahedron, Shape::triangle, Shape::line}},
      {".mesh",
       {Shape::tetrahedron, Shape::hexahedron, Shape::wedge, Shape::triangle, Shape::quad, Shape::line}},
      {".msh",
       {Shape::tetrahedron, Shape::hexahedron, Shape::wedge, Shape::triangle, Shape::quad, Shape::line}},
      {".vtu",
       {Shape::tetrahedron, Shape::hexahedron, Shape::pyramid, Shape::quad, Shape::line, Shape::vertex}},
      {".vtk",
       {Shape::tetrahedron, Shape::hexahedron, Shape::pyramid, Shape::quad, Shape::line, Shape::vertex}},
      {".veg", {Shape::tetrahedron}},
      {".off", {Shape::triangle, Shape::quad}},
      {".ply", {Shape::triangle, Shape::quad}},
      {".obj", {Shape::triangle, Shape::quad}},
  };
  for (const auto& [extension, shapes] : targets) {
    SCOPED_TRACE(extension);
    const TemporaryFolder folder;
    Mesh mesh = interleaved(shapes);
    const Mesh original = mesh;
    mesh.format = extension == ".vtu" ? "vtk" : "vtu";
    const Permutation arranged =
        arrange_cells(mesh, format_of("a" + extension)).value_or(Permutation::identity(mesh.cell_count()));
    for (Index c = 0; c < original.cell_count(); ++c) {
      EXPECT_EQ(mesh.cells.shapes[arranged.old_to_new()[c]], original.cells.shapes[c]);
    }
    apply_reordering(mesh, test::shuffled(mesh.vertex_count(), 1), test::shuffled_cells(mesh, 2));
    const auto path = folder.path() / ("a" + extension);
    write_mesh(mesh, path);
    const Mesh read = read_mesh(path);
    EXPECT_EQ(read.points, mesh.points);
    EXPECT_EQ(read.cells, mesh.cells);
  }
}

TEST(ReadMesh, ReportsDegenerateCellsAndKeepsThem) {
  const TemporaryFolder folder;
  Mesh mesh = test::tetrahedral_bar(1);
  mesh.cells[2][3] = mesh.cells[2][0];
  write_mesh(mesh, folder.path() / "a.vtu");
  Notes notes;
  EXPECT_EQ(read_mesh(folder.path() / "a.vtu", {.notes = &notes}).cells, mesh.cells);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes.back().find("1 cell names a vertex twice"), std::string::npos) << notes.back();
}

TEST(FormatOf, SaysWhatToDoWithFilesOfOtherPrograms) {
  const auto message = [](const std::string& path) {
    try {
      (void)format_of(path);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("a.VTP"),
            "a.VTP: holds VTK's PolyData; save it as .ply or .vtu, in ParaView with Save Data");
  EXPECT_EQ(message("a.vts"), "a.vts: is structured; its order is fixed by the grid; nothing to reorder");
  EXPECT_NE(message("a.geo").find("gmsh IN -3 -o OUT.msh"), std::string::npos);
  // no extension has both advice and a reader
  for (const Format& format : all_formats()) {
    for (const std::string_view extension : format.extensions) EXPECT_EQ(other_format(extension), nullptr);
  }
}

/// The files of a mesh, by name; nothing if the format cannot hold its cells.
std::vector<MemoryFile> files_of(const Mesh& mesh, const Format& format) {
  try {
    return test::written_as(mesh, format).files;
  } catch (const InputError&) {
    return {};
  }
}

void expect_same(const Mesh& found, const Mesh& expected) {
  EXPECT_EQ(found.points, expected.points);
  EXPECT_EQ(found.cells, expected.cells);
  EXPECT_EQ(found.data, expected.data);
  EXPECT_EQ(found.sets, expected.sets);
  EXPECT_EQ(found.vertex_ids, expected.vertex_ids);
  EXPECT_EQ(found.cell_ids, expected.cell_ids);
}

TEST(AllFormats, AFileThatIsReadAndWrittenStaysAsItIs) {
  std::vector<std::pair<std::string, Mesh>> meshes{{"mixed", test::mixed_mesh()},
                                                   {"tetrahedra", test::tetrahedral_bar(3)},
                                                   {"triangles", test::triangles_and_line(2)}};
  for (const auto& [shape, vertices] : test::linear_types()) {
    meshes.emplace_back(type_name(shape, vertices), test::cells_of_type(shape, vertices, 3));
  }
  for (const auto& [shape, vertices] : test::quadratic_types()) {
    meshes.emplace_back(type_name(shape, vertices), test::cells_of_type(shape, vertices, 3));
  }
  for (const Format& format : all_formats()) {
    int written = 0;
    for (const auto& [name, mesh] : meshes) {
      SCOPED_TRACE(format.key() + ": " + name);
      const std::vector<MemoryFile> once = files_of(mesh, format);
      if (once.empty()) continue;
      ++written;
      const std::vector<MemoryFile> twice = files_of(test::read_back(once, format), format);
      ASSERT_EQ(twice.size(), once.size());
      if (format.name == "Exodus" || format.name == "XDMF" || format.name == "CGNS" || format.name == "MED" ||
          format.name == "VTKHDF") {  // the content of an HDF5 file counts, not its bytes
        expect_same(test::read_back(twice, format), test::read_back(once, format));
        continue;
      }
      for (std::size_t f = 0; f < once.size(); ++f) {
        EXPECT_EQ(twice[f].name, once[f].name);
        EXPECT_TRUE(twice[f].bytes == once[f].bytes) << once[f].name;
      }
    }
    EXPECT_GT(written, 0) << format.name;
  }
}

TEST(AllFormats, IdsOfAnyNumbersLeaveAFileThatCanBeRead) {
  for (const Format& format : all_formats()) {
    SCOPED_TRACE(format.key());
    Mesh mesh = test::tetrahedral_bar(2);
    if (!format.holds(mesh, Shape::tetrahedron, 4)) mesh = test::triangles_and_line(4);
    const std::vector<MemoryFile> files = files_of(mesh, format);
    if (files.empty()) continue;  // a format for matrices
    mesh = test::read_back(files, format);
    std::vector<std::int64_t> doubled(mesh.points.size(), 7);
    std::vector<std::int64_t> negative(mesh.points.size());
    std::iota(negative.begin(), negative.end(), std::int64_t{-3});
    for (const std::vector<std::int64_t>& ids : {doubled, negative}) {
      mesh.vertex_ids = ids;
      test::Written written;
      try {
        written = test::written_as(mesh, format);
      } catch (const InputError&) {
        continue;
      }
      const Mesh back = test::read_back(written.files, format);
      EXPECT_EQ(back.points, mesh.points);
      EXPECT_EQ(back.cells, mesh.cells);
    }
  }
}

}  // namespace
}  // namespace meshorder
