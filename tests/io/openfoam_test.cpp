// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "io/openfoam/cell_order.hpp"
#include "io/openfoam/poly_mesh.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::openfoam {
namespace {

using test::TemporaryFolder;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string file_of(std::string_view class_name, std::string_view body, std::string_view format = "ascii",
                    std::string_view arch = "") {
  std::string header = "/* a comment */\nFoamFile\n{\n    version     2.0;\n    format      ";
  header.append(format).append(";\n");
  if (!arch.empty()) header.append("    arch        \"").append(arch).append("\";\n");
  header.append("    note        \"nPoints:12; {\";\n    class       ").append(class_name);
  return header.append(";\n    object      it;\n}\n// * * * //\n\n").append(body);
}

std::string patches(std::string_view list) { return file_of("polyBoundaryMesh", list); }

/// The files of a folder `polyMesh`.
struct Files {
  std::string owner;
  std::string neighbour;
  std::string points;
  std::string faces;
  std::string boundary = patches(
      "2(empty { type empty; nFaces 0; startFace 0; }\nwalls\n{\n    type wall;\n    inGroups "
      "1(wall);\n    nFaces 10;\n    startFace 1;\n})");
};

// two cubes side by side; the point at (x, y, z) has the number x + 3y + 6z
const std::vector<Index> kOwners{0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1};
const std::vector<Index> kNeighbours{1};
const std::vector<Index> kFacePoints{1, 4, 10, 7,  0,  6, 9, 3,  0, 1, 7, 6,  3,  9, 10,
                                     4, 0, 3,  4,  1,  6, 7, 10, 9, 2, 5, 11, 8,  1, 2,
                                     8, 7, 4,  10, 11, 5, 1, 4,  5, 2, 7, 8,  11, 10};

Files text_files() {
  std::string owners;
  for (const Index c : kOwners) owners += fmt::format("{}\n", c);
  std::string points;
  for (int p = 0; p < 12; ++p) points += fmt::format("({} {} {})\n", p % 3, p / 3 % 2, p / 6);
  std::string faces;
  for (std::size_t k = 0; k < kFacePoints.size(); k += 4) {
    faces += fmt::format("4({})\n", fmt::join(std::span(kFacePoints).subspan(k, 4), " "));
  }
  return {file_of("labelList", fmt::format("11\n(\n{})\n", owners)), file_of("labelList", "1(1)\n"),
          file_of("vectorField", fmt::format("12\n(\n{})\n", points)),
          file_of("faceList", fmt::format("11\n(\n{})\n", faces))};
}

/// The bytes of numbers in that order.
template <class T, class Values>
std::string bytes_of(const Values& values, std::endian order) {
  std::string result;
  for (const auto value : values) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(static_cast<T>(value));
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    result.append(raw.data(), raw.size());
  }
  return result;
}

template <class Label, class Scalar>
Files binary_files(std::string_view arch, std::endian order) {
  const auto list = [&](const std::vector<Index>& labels) {
    return std::to_string(labels.size()) + "\n(" + bytes_of<Label>(labels, order) + ")";
  };
  std::vector<double> coordinates;
  for (int p = 0; p < 12; ++p) {
    for (const int x : {p % 3, p / 3 % 2, p / 6}) coordinates.push_back(x);
  }
  std::vector<Index> begins;
  for (Index f = 0; f <= 11; ++f) begins.push_back(4 * f);
  return {file_of("labelList", list(kOwners), "binary", arch),
          file_of("labelList", list(kNeighbours), "binary", arch),
          file_of("vectorField", "12\n(" + bytes_of<Scalar>(coordinates, order) + ")", "binary", arch),
          file_of("faceCompactList", list(begins) + "\n" + list(kFacePoints), "binary", arch)};
}

PolyMesh read(const Files& files, Notes& notes) {
  const TemporaryFolder folder;
  (void)folder.file("owner", files.owner);
  (void)folder.file("neighbour", files.neighbour);
  (void)folder.file("points", files.points);
  (void)folder.file("faces", files.faces);
  (void)folder.file("boundary", files.boundary);
  return read_poly_mesh(folder.path(), folder.path(), true, notes);
}

PolyMesh read(const Files& files) {
  Notes notes;
  PolyMesh mesh = read(files, notes);
  EXPECT_THAT(notes, IsEmpty());
  return mesh;
}

std::string fault_of(const Files& files) {
  try {
    (void)read(files);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_two_cubes(const PolyMesh& mesh) {
  EXPECT_THAT(mesh.graph.offsets, ElementsAre(0, 1, 2));
  EXPECT_THAT(mesh.graph.neighbours, ElementsAre(1, 0));
  EXPECT_EQ(mesh.internal_faces, 1);
  EXPECT_THAT(mesh.centres, ElementsAre(Point{0.5, 0.5, 0.5}, Point{1.5, 0.5, 0.5}));
}

TEST(OpenFoam, ReadsText) { expect_two_cubes(read(text_files())); }

TEST(OpenFoam, ReadsBinaryOfAllArchitectures) {
  constexpr auto kLittle = std::endian::little;
  constexpr auto kBig = std::endian::big;
  expect_two_cubes(read(binary_files<std::int32_t, double>("LSB;label=32;scalar=64", kLittle)));
  expect_two_cubes(read(binary_files<std::int64_t, double>("LSB;label=64;scalar=64", kLittle)));
  expect_two_cubes(read(binary_files<std::int32_t, float>("LSB;label=32;scalar=32", kLittle)));
  expect_two_cubes(read(binary_files<std::int64_t, float>("MSB;label=64;scalar=32", kBig)));
  expect_two_cubes(read(binary_files<std::int32_t, double>("", kLittle)));
}

TEST(OpenFoam, ReadsOtherFormsOfLists) {
  Files files = text_files();
  files.owner = file_of("labelList", "11 (0 0 0//first\n0 0 0 1 1 1/* then */1 1)");
  files.neighbour = file_of("labelList", "11\n(1 -1 -1 -1 -1 -1 -1 -1 -1 -1 -1)");
  files.faces = with(files.faces, "4(1 4 10 7)", "4\n(\n1\n4\n10\n7\n)");
  files.points = with(files.points, "(1 0 0)", "( 1.0 0e5 -1e-400 )");
  expect_two_cubes(read(files));
}

TEST(OpenFoam, ReadsOneCellAndNone) {
  Files files = text_files();
  files.owner = file_of("labelList", "6{0}");
  files.neighbour = file_of("labelList", "0()");
  files.boundary = patches("1(walls { nFaces 6; startFace 0; })");
  files.faces =
      file_of("faceList", "6(4(0 6 9 3) 4(0 1 7 6) 4(3 9 10 4) 4(0 3 4 1) 4(6 7 10 9) 4(1 4 10 7))");
  PolyMesh mesh = read(files);
  EXPECT_EQ(mesh.graph.size(), 1);
  EXPECT_THAT(mesh.graph.neighbours, IsEmpty());
  EXPECT_THAT(mesh.centres, ElementsAre(Point{0.5, 0.5, 0.5}));

  files.owner = files.neighbour = file_of("labelList", "0");
  files.boundary = patches("0()");
  files.points = file_of("vectorField", "0()");
  files.faces = file_of("faceList", "0()");
  mesh = read(files);
  EXPECT_EQ(mesh.graph.size(), 0);
  EXPECT_THAT(mesh.centres, IsEmpty());
}

TEST(OpenFoam, CellsThatShareSeveralFacesAreJoinedOnce) {
  Files files = text_files();
  files.owner = file_of("labelList", "4(0 0 1 1)");
  files.neighbour = file_of("labelList", "2(1 1)");
  files.boundary = patches("1(walls { nFaces 2; startFace 2; })");
  files.faces = file_of("faceList", "4(3(0 1 2) 3(1 2 3) 3(2 3 4) 3(3 4 5))");
  const PolyMesh mesh = read(files);
  EXPECT_EQ(mesh.internal_faces, 2);
  EXPECT_EQ(mesh.graph.edge_count(), 1);
}

TEST(OpenFoam, RefusesBrokenFilesWithTheirPlace) {
  struct Broken {
    std::string Files::*file;
    std::string content;
    std::string expected;
  };
  const Files good = text_files();
  const std::string huge = std::to_string(std::numeric_limits<std::int64_t>::max());
  for (const auto& [file, content, expected] : std::vector<Broken>{
           {&Files::owner, with(good.owner, "0\n0\n0\n", "0\n0\n11\n"),
            "owner:16: the owner is 11; 0 to 10 are possible"},
           {&Files::owner, with(good.owner, "0\n0\n0\n", "0\n-1\n0\n"), "owner:15: the owner is -1"},
           {&Files::owner, with(good.owner, "0\n0\n0\n", "0\nx\n0\n"), "owner:15: the owner is 'x'"},
           {&Files::owner, with(good.owner, "0\n0\n0\n", "0\n1.5\n0\n"), "owner:15: the owner is '1.5'"},
           {&Files::owner, with(good.owner, "0\n0\n0\n", "0\n" + huge + "0\n0\n"),
            "a smaller number is needed"},
           {&Files::owner, with(good.owner, "0\n0\n0\n", "2\n2\n2\n"),
            "neighbour: face 0 has the owner 2 and the neighbour 1"},
           {&Files::owner, with(good.owner, "1\n1\n1\n1\n", "3\n3\n3\n3\n"), "cell 2 of 4 has no face"},
           {&Files::owner, with(good.owner, "11\n(", "12\n("),
            "owner:25: the list of owners ends after 11; the count at the top says 12"},
           {&Files::owner, with(good.owner, "11\n(", "10\n("),
            "owner:24: expected ')' of the list of owners"},
           {&Files::owner, with(good.owner, "11\n(", "-11\n("), "owner:12: the number of owners is -11; it"},
           {&Files::owner, with(good.owner, "11\n(", "2000000000\n("),
            "owner:12: the number of owners is 2000000000, but only 27 bytes"},
           {&Files::owner, with(good.owner, "11\n(", huge + "\n("), "at most 2147483647 are possible"},
           {&Files::owner, file_of("labelList", "2000000000{0}"), "2000000000 owners are the same"},
           {&Files::owner, file_of("labelList", "(0 1)"), "the number of owners is '(0'"},
           {&Files::owner, file_of("labelList", ""), "the file ends before the number of owners"},
           {&Files::owner, with(good.owner, "ascii", "xml"), "owner:5: the format is 'xml'"},
           {&Files::owner, with(good.owner, "FoamFile", "Foam"), "owner:1: is not an OpenFOAM file"},
           {&Files::owner, "FoamFile { version 2.0; class", "the file ends within its header"},
           {&Files::owner, "", "is empty"},
           {&Files::owner, file_of("decomposedBlockData", "11(0)"), "-fileHandler uncollated"},
           {&Files::neighbour, file_of("labelList", "1(11)"), "neighbour:12: the neighbour is 11; -1 to 10"},
           {&Files::neighbour, file_of("labelList", "1(0)"), "face 0 has cell 0 on both sides"},
           {&Files::neighbour, file_of("labelList", "2(-1 1)"), "face 0 has no neighbour"},
           {&Files::neighbour, file_of("labelList", "12{1}"), "lists 12 faces"},
           {&Files::owner, with(good.owner, "\n0\n0\n0\n", "\n1\n0\n0\n"), "face 0 has cell 1 on both sides"},
           {&Files::owner, with(good.owner, "labelList", "faceList"),
            "owner:7: the class is 'faceList'; labelList is expected"},
           {&Files::owner, with(good.owner, "class       labelList;", ""), "the header names no class"},
           {&Files::neighbour, with(good.neighbour, "labelList", "vectorField"), "neighbour:7: the class is"},
           {&Files::owner, with(good.owner, "ascii", "binary"),
            "the header says `format binary`, but the numbers are text; correct `format`"},
           {&Files::boundary, patches("1(walls { nFaces 9; startFace 1; })"),
            "boundary: the patches cover faces 1 to 9, but the boundary has faces 1 to 10"},
           {&Files::boundary, patches("1(walls { nFaces 10;\nstartFace 2; })"),
            "boundary:13: the patch 'walls' begins at face 2, but face 1 is next"},
           {&Files::boundary, patches("2(a { nFaces 5; startFace 1; } b { nFaces 5; startFace 5; })"),
            "the patch 'b' begins at face 5, but face 6 is next"},
           {&Files::boundary, patches("1(walls { inner { nFaces 10; } startFace 1; })"),
            "the patch 'walls' gives no number for nFaces"},
           {&Files::boundary, patches("1(walls { nFaces 10; startFace -1; })"),
            "gives no number for startFace"},
           {&Files::boundary, patches("walls { nFaces 10; startFace 1; }"), "expected a list of patches"},
           {&Files::boundary, patches("1(walls nFaces 10;)"), "expected '{' after the patch 'walls'"},
           {&Files::boundary, patches("1(walls { nFaces 10;"), "the file ends within the list of patches"},
           {&Files::points, with(good.points, "(1 0 0)", "(nan 0 0)"), "points:15: a coordinate is 'nan'"},
           {&Files::points, with(good.points, "(1 0 0)", "(1e999 0 0)"),
            "points:15: a coordinate is '1e999'"},
           {&Files::points, with(good.points, "(1 0 0)", "(1 0)"), "points:15: a coordinate is ')'"},
           {&Files::points, with(good.points, "(1 0 0)", "1 0 0"), "points:15: expected '(' of a point"},
           {&Files::points, with(good.points, "12\n(", "13\n("),
            "points:12: the number of points is 13, but only 101 bytes"},
           {&Files::faces, with(good.faces, "4(1 4 10 7)", "4(1 4 12 7)"),
            "faces:14: the point is 12; 0 to 11"},
           {&Files::faces, with(good.faces, "4(1 4 10 7)", "3(1 4 10 7)"),
            "faces:14: expected ')' of the list of points"},
           {&Files::faces, with(good.faces, "4(1 4 10 7)", "0()"), "faces:14: face 0 has no points"},
           {&Files::faces, with(good.faces, "11\n(", "10\n("), "expected ')' of the list of faces"},
           {&Files::faces, file_of("faceList", "1(4(1 4 10 7))"), "there are fewer faces than owners"},
           {&Files::faces, with(with(good.faces, "11\n(", "12\n("), "4(1 4", "4(1 4 10 7) 4(1 4"),
            "there are more faces than owners"},
           {&Files::faces, file_of("faceCompactList", "2(0 5) 4(1 4 10 7)"),
            "face 0 has the points 0 to 5 of 4"},
           {&Files::faces, file_of("faceCompactList", "3(0 3 1) 4(1 4 10 7)"), "offsets must ascend"},
       }) {
    Files files = good;
    files.*file = content;
    EXPECT_THAT(fault_of(files), HasSubstr(expected)) << content;
  }
}

TEST(OpenFoam, RefusesOwnersWithHigherNumbersThanNeighbours) {
  Files files = text_files();
  files.owner = file_of("labelList", "11(1 0 0 0 0 0 1 1 1 1 1)");
  files.neighbour = file_of("labelList", "1(0)");
  EXPECT_THAT(fault_of(files),
              HasSubstr("neighbour: face 0 has the owner 1 and the neighbour 0; the owner of"));
}

TEST(OpenFoam, RefusesMissingFiles) {
  for (const std::string name : {"owner", "neighbour", "points", "faces", "boundary"}) {
    const TemporaryFolder folder;
    for (const std::string other : {"owner", "neighbour", "points", "faces", "boundary"}) {
      if (other != name) (void)folder.file(other, "unread");
    }
    Notes notes;
    try {
      (void)read_poly_mesh(folder.path(), folder.path(), false, notes);
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(name + ": is missing"));
    }
  }
}

TEST(OpenFoam, NotesCountsOfAHeaderThatAreOthers) {
  const auto notes_with = [](const std::string& note) {
    Files files = text_files();
    files.owner = with(files.owner, "nPoints:12; {", note);
    Notes notes;
    (void)read(files, notes);
    return notes;
  };
  EXPECT_THAT(notes_with("nPoints:12  nCells:2  nFaces:11  nInternalFaces: 1"), IsEmpty());
  EXPECT_THAT(notes_with("nCells: many nFaces:"), IsEmpty());
  EXPECT_THAT(notes_with("nCells:3 nFaces:11 nInternalFaces:2"),
              ElementsAre(HasSubstr(
                  "owner: the counts in the header are those of another mesh: nCells is 3, the files "
                  "have 2, nInternalFaces is 2, the files have 1; run checkMesh")));
}

TEST(OpenFoam, BoundariesThatReferElsewhereAreNotChecked) {
  Files files = text_files();
  files.boundary = patches("(walls { nFaces $n; startFace 1; })");
  expect_two_cubes(read(files));
}

TEST(OpenFoam, RefusesBrokenBinaryFilesWithTheirByte) {
  const Files good = binary_files<std::int32_t, double>("LSB;label=32;scalar=64", std::endian::little);
  Files files = good;
  files.owner[files.owner.find("11\n(") + 4 + 3] = '\x7f';  // the highest byte of the first owner
  EXPECT_THAT(fault_of(files), HasSubstr("owner: byte " + std::to_string(good.owner.find("11\n(") + 4) +
                                         ": the owner is 2130706432"));
  files = good;
  files.owner = with(good.owner, "binary", "ascii");
  EXPECT_THAT(fault_of(files), HasSubstr("the header says `format ascii`, but the numbers are binary"));
  files = good;
  files.owner = with(good.owner, "label=32", "label=64");
  EXPECT_THAT(fault_of(files), HasSubstr("bytes follow"));
  files = good;
  files.neighbour =
      file_of("labelList", "1\n(" + bytes_of<std::int64_t>(kNeighbours, std::endian::little) + ")", "binary");
  EXPECT_THAT(fault_of(files), HasSubstr("`arch` in the header"));
  files = good;
  const std::size_t first = good.points.find("12\n(") + 4;
  files.points.replace(
      first, 8, bytes_of<double>(std::array{std::numeric_limits<double>::quiet_NaN()}, std::endian::little));
  EXPECT_THAT(fault_of(files),
              HasSubstr("points: byte " + std::to_string(first) + ": a coordinate is not finite"));
}

TEST(OpenFoam, NoticesEveryCut) {
  for (const Files& good :
       {text_files(), binary_files<std::int64_t, float>("LSB;label=64;scalar=32", std::endian::little)}) {
    for (const auto file : {&Files::owner, &Files::neighbour, &Files::points, &Files::faces}) {
      const std::size_t whole = (good.*file).rfind(')');
      const std::size_t step = (good.*file).rfind("* //") / 10;  // larger steps through the header
      for (std::size_t size = 0; size <= whole; size += size < 10 * step ? step : 3) {
        Files files = good;
        (files.*file).resize(size);
        EXPECT_NE(fault_of(files), "") << size << " of\n" << good.*file;
      }
    }
  }
}

TEST(OpenFoam, WritesTheOldCellsInTheirNewOrder) {
  const TemporaryFolder folder;
  OutputFile file(folder.path() / "cellOrder");
  write_cell_order(Permutation::from_new_to_old({2, 0, 1}), file);
  file.commit();
  const std::string text = test::content_of(folder.path() / "cellOrder");
  EXPECT_THAT(text, HasSubstr("class       labelList;"));
  EXPECT_THAT(text, HasSubstr("\n3\n(\n2\n0\n1\n)\n"));
}

TEST(OpenFoam, KnowsADictionaryThatTakesItsOrder) {
  const TemporaryFolder folder;
  OutputFile file(folder.path() / "own");
  write_dictionary(file);
  file.commit();
  EXPECT_TRUE(takes_cell_order(folder.path() / "own"));
  const auto takes = [&](std::string_view entries) {
    return takes_cell_order(folder.file("dictionary", file_of("dictionary", entries)));
  };
  EXPECT_TRUE(takes("writeMaps true; // mine\nmanualCoeffs\n{\n dataFile cellOrder;\n}\nmethod manual;"));
  EXPECT_TRUE(
      takes("method manual; manualCoeffs { dataFile \"cellOrder\"; } blockCoeffs { method scotch; }"));
  EXPECT_TRUE(takes("note \"\"; method manual; manualCoeffs { dataFile \"cellOrder\"; }"));
  EXPECT_FALSE(takes("manualCoeffs { dataFile \"cellOrder\"; } blockCoeffs { method manual; }"));
  EXPECT_FALSE(takes("method CuthillMcKee; manualCoeffs { dataFile \"cellOrder\"; }"));
  EXPECT_FALSE(takes("method manual; manualCoeffs { dataFile \"cellMap\"; }"));
  EXPECT_FALSE(takes("// method manual; manualCoeffs { dataFile \"cellOrder\"; }"));
}

TEST(OpenFoam, OtherReadersNameTheSubcommand) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "cavity.v2";
  std::filesystem::create_directories(path / "constant" / "fluid" / "polyMesh");
  EXPECT_TRUE(is_case(path));
  EXPECT_FALSE(is_case(folder.path()));
  for (const std::filesystem::path& given : {path, path / "cavity.foam"}) {
    EXPECT_THAT(test::read_error(given),
                HasSubstr("is an OpenFOAM case; order its cells with meshorder openfoam " + path.string()));
  }
  EXPECT_THAT(test::read_error(folder.path() / "a.foam"), HasSubstr("unknown extension '.foam'"));
}

}  // namespace
}  // namespace meshorder::openfoam
