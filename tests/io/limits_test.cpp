// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Limits for input files: memory for files that claim more data than they hold, and files that they may name.
#include "base/memory.hpp"
#include "io/stream/read_limits.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

namespace meshorder {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;
constexpr std::string_view kRemedy = "if you trust the file, raise the memory limit (--limit-memory)";

constexpr std::string_view kOneTetrahedron =
    "*VERTICES\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4\n";

/// A .vtu file of one triangle, with additions to its grid and to its cells' data.
std::string triangle(std::string_view in_grid, std::string_view cell_data = "") {
  return fmt::format(
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\"><UnstructuredGrid>\n{}\n<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\">"
      "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 "
      "0</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 "
      "2</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray><DataArray "
      "type=\"Int32\" Name=\"types\" format=\"ascii\">5</DataArray></Cells><CellData>{}</CellData></Piece>"
      "</UnstructuredGrid>",
      in_grid, cell_data);
}

/// The error message from reading a file with these options; empty if it is read.
std::string fault(const std::filesystem::path& path, const ReadOptions& options = {}) {
  try {
    (void)read_mesh(path, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Memory, SizesAreReadAndWritten) {
  EXPECT_EQ(parse_size("4G"), std::uint64_t{4} << 30);
  EXPECT_EQ(parse_size("48k"), 48U << 10);
  EXPECT_EQ(parse_size("7"), 7U);
  for (const char* const text : {"", "G", "4GB", "-1", "1.5G", "99999999999999999999", "99999999999G"}) {
    EXPECT_FALSE(parse_size(text)) << text;
  }
  EXPECT_EQ(size_text(555), "555 bytes");
  EXPECT_EQ(size_text(3 * kMebibyte / 2), "1.5 MiB");
  EXPECT_EQ(size_text(UINT64_MAX), "16 EiB");
  EXPECT_EQ(bytes_for(UINT64_MAX / 2, 4), UINT64_MAX);
  EXPECT_GT(usable_memory(), kMebibyte);
  EXPECT_FALSE(memory_limit().is_given);
  EXPECT_LT(memory_limit().bytes, usable_memory());
}

TEST(ReadLimits, AddUpClaimsAndGrowWithTheFiles) {
  const FilePath file("a.msh");
  const ReadScope scope(file);
  count_file(file, kMebibyte);
  // each claim counts four times
  EXPECT_EQ(refused_claim(75 * kMebibyte, "a list"), "");
  EXPECT_EQ(refused_claim(25 * kMebibyte, "a list"),
            "a list would take 100 MiB in addition to 300 MiB, more than the limit of 356 MiB");
  EXPECT_EQ(refused_claim(std::numeric_limits<std::uint64_t>::max(), "a list").substr(0, 17),
            "a list would take");
  EXPECT_EQ(refused_for_a_while(56 * kMebibyte, "a chunk"), "");
  EXPECT_NE(refused_for_a_while(56 * kMebibyte + 1, "a chunk"), "");
  EXPECT_EQ(refused_claim(14 * kMebibyte, "a list"), "");
  {
    const FilePath other("b.msh");
    const ReadScope inner(other, kMebibyte);
    EXPECT_EQ(refused_claim(kMebibyte / 4, "a list"), "");
    EXPECT_NE(refused_claim(1, "a list"), "");
  }
  EXPECT_NE(refused_claim(1, "a list"), "");
}

TEST(ReadLimits, AFileThatIsReadAgainIsAClaim) {
  const FilePath file("a.msh");
  const ReadScope scope(file);
  count_file("b", 2 * kMebibyte);
  for (int k = 0; k < 228; ++k) count_file("b", 2 * kMebibyte);
  EXPECT_THROW(count_file("x/../b", 2 * kMebibyte), InputError);
}

TEST(ReadLimits, ComponentsWithoutValuesAreRefused) {
  const TemporaryFolder folder;
  const auto path = folder.file(
      "a.vtu",
      triangle("<FieldData><DataArray type=\"Int32\" Name=\"f\" NumberOfTuples=\"0\" "
               "NumberOfComponents=\"2000000000\" ComponentName0=\"x\" format=\"ascii\"/></FieldData>") +
          "</VTKFile>");
  EXPECT_LT(std::filesystem::file_size(path), 1024U);
  EXPECT_EQ(fault(path),
            fmt::format("{}:2: the array 'f' would take 238.4 GiB, more than the limit of 256.1 MiB; {}",
                        path.string(), kRemedy));
}

TEST(ReadLimits, ArraysThatShareTheirBytesAreAddedUp) {
  const TemporaryFolder folder;
  constexpr std::size_t kBytes = std::size_t{1} << 20;
  std::string arrays;
  for (int k = 0; k < 400; ++k) {
    arrays += fmt::format(
        "<DataArray type=\"Int8\" Name=\"f{}\" NumberOfTuples=\"{}\" format=\"appended\" "
        "offset=\"0\"/>\n",
        k, kBytes);
  }
  std::string size(8, '\0');
  size[2] = '\x10';
  const auto path = folder.file("a.vtu", triangle("<FieldData>" + arrays + "</FieldData>") +
                                             "<AppendedData encoding=\"raw\">_" + size +
                                             std::string(kBytes, '\1') + "</AppendedData></VTKFile>");
  EXPECT_THAT(fault(path), AllOf(HasSubstr("a.vtu:91"), HasSubstr(": the array 'f8"),
                                 HasSubstr("would take 4 MiB in addition to 35"), EndsWith(kRemedy)));
  EXPECT_EQ(fault(path, {.memory_limit = 1600 * kMebibyte}), "");
  EXPECT_NE(fault(path, {.memory_limit = 1599 * kMebibyte}), "");
}

TEST(ReadLimits, SetsOfRangesAreAddedUp) {
  const TemporaryFolder folder;
  std::string nodes = "*NODE\n";
  for (int k = 1; k <= 1000; ++k) nodes += fmt::format("{},0,0,{}\n", k, k);
  const std::string element = "*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n";
  std::string ranges = "*NSET,NSET=s,GENERATE\n";
  for (int k = 0; k < 2000; ++k) ranges += "1,2000000000,1\n";
  // the ranges claim 1,000 nodes × 2,000 lines × 4 bytes, which count four times
  const auto deck = folder.file("a.inp", nodes + element + ranges);
  EXPECT_EQ(fault(deck), "");
  EXPECT_THAT(fault(deck, {.memory_limit = 4 * kMebibyte}),
              HasSubstr("a range of numbers would take 15.62 KiB"));
  std::string chain = "*NSET,NSET=s0\n1,2,3,4\n";
  for (int k = 1; k < 40; ++k) chain += fmt::format("*NSET,NSET=s{0}\ns{1},s{1}\n", k, k - 1);
  const Mesh mesh = read_mesh(folder.file("b.inp", nodes + element + chain));
  ASSERT_EQ(mesh.sets.size(), 40U);
  for (const EntitySet& set : mesh.sets) EXPECT_EQ(set.members, (std::vector<Index>{0, 1, 2, 3}));
}

TEST(ReadLimits, CellsOfManyGroupsAreAddedUp) {
  const TemporaryFolder folder;
  constexpr int kGroups = 300;
  constexpr int kCells = 1000;
  std::string names;
  std::string tags;
  std::string cells;
  for (int k = 1; k <= kGroups; ++k) {
    names += fmt::format("3 {} \"group {}\"\n", k, k);
    tags += fmt::format(" {}", k);
  }
  for (int k = 1; k <= kCells; ++k) cells += fmt::format("{} 1 2 3 4\n", k);
  const auto path = folder.file(
      "a.msh",
      fmt::format("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n{}$EndPhysicalNames\n"
                  "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 {}{} 0\n$EndEntities\n$Nodes\n1 4 1 4\n3 1 0 "
                  "4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n1 {} 1 {}\n3 1 4 "
                  "{}\n{}$EndElements\n",
                  kGroups, names, kGroups, tags, kCells, kCells, kCells, cells));
  EXPECT_EQ(fault(path), "");
  EXPECT_THAT(fault(path, {.memory_limit = kMebibyte}), HasSubstr("items in several groups would take"));
}

TEST(ReadLimits, StreamsWithoutAnEndAreLeft) {
  std::istringstream stream(std::string(3 * kMebibyte, ' '));
  try {
    (void)read_mesh(stream, {.format = "off", .memory_limit = 2 * kMebibyte});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "<memory>: has no end within 2 MiB; if it has one, raise the memory limit (--limit-memory)");
  }
}

TEST(ReadLimits, WhatIsNoFileIsRefused) {
  const TemporaryFolder folder;
  const auto link = [&](const char* name, const char* target) {
    std::filesystem::create_symlink(target, folder.path() / name);
    return folder.path() / name;
  };
  EXPECT_THAT(fault(link("a.off", "/dev/zero")), EndsWith("a.off: is a device; give a file"));
#ifdef MESHORDER_HAS_HDF5
  EXPECT_THAT(fault(link("a.med", "/dev/zero")), EndsWith("a.med: is a device; give a file"));
#endif
  EXPECT_THAT(fault(link("b.off", "/usr")), EndsWith("b.off: is a folder; give a file"));
  // files of /sys claim a page each
  constexpr const char* kShort = "/sys/kernel/mm/transparent_hugepage/enabled";
  if (std::filesystem::exists(kShort)) {
    EXPECT_THAT(fault(link("c.off", kShort)), HasSubstr("c.off: had 4096 bytes and ended after "));
  }
  // a terabyte of zeros without a disk block
  const auto sparse = folder.file("d.off", "");
  std::filesystem::resize_file(sparse, std::uintmax_t{1} << 40);
  EXPECT_THAT(fault(sparse), HasSubstr("d.off: has 1 TiB, more than the limit of "));
}

// ---- included files

TEST(Includes, StayBelowTheFolderOfTheMesh) {
  const TemporaryFolder outside;
  const auto secret = outside.file("secret.txt", "*MATERIAL secret\nENU, 1, 1, .4\n");
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "sub");
  std::filesystem::create_symlink(secret, folder.path() / "link.txt");
  (void)folder.file("sub/inner.txt", "*INCLUDE ../beside.txt\n");
  (void)folder.file("beside.txt", "# here\n");
  const auto of_vega = [&](const std::string& name, const ReadOptions& options = {}) {
    return fault(folder.file("a.veg", fmt::format("{}*INCLUDE {}\n", kOneTetrahedron, name)), options);
  };
  const auto of_deck = [&](const std::string& name, const ReadOptions& options = {}) {
    return fault(folder.file("a.inp",
                             "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n"
                             "1,1,2,3,4\n*INCLUDE,INPUT=" +
                                 name + "\n"),
                 options);
  };
  const auto of_bulk = [&](const std::string& name, const ReadOptions& options = {}) {
    return fault(folder.file("a.bdf",
                             "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n"
                             "GRID,4,,0.,0.,1.\nCTETRA,1,1,1,2,3,4\nINCLUDE '" +
                                 name + "'\nENDDATA\n"),
                 options);
  };
  const std::string remedy = "put it below the mesh's folder, or allow its own with --allow-includes-from";
  const std::string up = "../" + outside.path().filename().string() + "/secret.txt";
  for (const std::string& name : {secret.string(), std::string("link.txt"), up, std::string("/etc/passwd"),
                                  std::string("sub/../../none.txt")}) {
    EXPECT_THAT(of_vega(name), AllOf(HasSubstr("a.veg:11: the included file '"),
                                     HasSubstr("is not in the mesh's folder"), EndsWith(remedy)));
    EXPECT_THAT(of_deck(name), AllOf(HasSubstr("a.inp:8: the included file '"), EndsWith(remedy)));
    EXPECT_THAT(of_bulk(name), AllOf(HasSubstr("a.bdf:7: the included file '"), EndsWith(remedy)));
  }
  EXPECT_EQ(of_vega("sub/inner.txt"), "");
  EXPECT_EQ(of_vega("sub/../beside.txt"), "");
  EXPECT_EQ(of_vega((folder.path() / "beside.txt").string()), "");
  ReadOptions allowed;
  allowed.include_folders = {"/none", outside.path()};
  for (const std::string& name : {secret.string(), std::string("link.txt"), up})
    EXPECT_EQ(of_vega(name, allowed), "");
  EXPECT_THAT(of_vega("/etc/passwd", allowed), EndsWith(remedy));
}

TEST(Includes, ThatAreExchangedForLinksInTimeAreNotRead) {
  namespace fs = std::filesystem;
  const TemporaryFolder outside;
  const auto secret = outside.file("secret.txt", "secret");
  const TemporaryFolder folder;
  const auto plain = folder.file("plain.txt", "plain");
  fs::create_symlink(secret, folder.path() / "link.txt");
  const FilePath mesh(folder.path() / "a.veg");
  const FilePath included = mesh.beside("i.txt");
  std::atomic<bool> is_over = false;
  std::thread others([&] {
    std::error_code ignored;
    for (int k = 0; !is_over; ++k) {
      fs::copy(folder.path() / (k % 2 == 0 ? "plain.txt" : "link.txt"), folder.path() / "next.txt",
               fs::copy_options::copy_symlinks, ignored);
      fs::rename(folder.path() / "next.txt", folder.path() / "i.txt", ignored);
    }
  });
  int plain_ones = 0;
  constexpr int kTimes = 20'000;
  constexpr int kMost = 2'000'000;  // for tries, if the other thread has to wait for a processor
  for (int k = 0; k < kTimes || (plain_ones == 0 && k < kMost); ++k) {
    if (!may_include(mesh, included)) continue;
    try {
      const std::string text = included.read();
      plain_ones += text == "plain" ? 1 : 0;
      EXPECT_NE(text, "secret");
    } catch (const InputError&) {
      continue;  // it was the link
    }
  }
  is_over = true;
  others.join();
  EXPECT_GT(plain_ones, 0);
}

TEST(Includes, StayBelowTheFolderInMemory) {
  const auto with = [](std::string_view name) {
    ReadOptions options{.format = "vega", .name = "meshes/a.veg"};
    options.companion = [](std::string_view) { return std::string("# found\n"); };
    const std::string text = std::string(kOneTetrahedron) + "*INCLUDE " + std::string(name) + "\n";
    try {
      (void)read_mesh(std::as_bytes(std::span(text)), options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(with("b.txt"), "");
  EXPECT_EQ(with("sub/../b.txt"), "");
  for (const char* const name : {"../b.txt", "/etc/passwd", "sub/../../b.txt"}) {
    EXPECT_THAT(with(name), HasSubstr("meshes/a.veg:11: the included file ")) << name;
  }
}

TEST(Includes, AreBoundedInDepthAndInAll) {
  const TemporaryFolder folder;
  for (int k = 0; k < 40; ++k) {
    (void)folder.file(fmt::format("f{}.txt", k), fmt::format("# {}\n*INCLUDE f{}.txt\n", k, k + 1));
  }
  (void)folder.file("f40.txt", "# end\n");
  const auto path = [&](int first) {
    return folder.file("a.veg", std::string(kOneTetrahedron) + fmt::format("*INCLUDE f{}.txt\n", first));
  };
  EXPECT_THAT(fault(path(0)), HasSubstr("f15.txt:2: files are included more than 16 deep"));
  EXPECT_EQ(fault(path(25)), "");
  // one file is included many times
  (void)folder.file("big.txt", "# " + std::string(100'000, 'x') + "\n");
  std::string many(kOneTetrahedron);
  for (int k = 0; k < 100; ++k) many += "*INCLUDE big.txt\n";
  EXPECT_EQ(fault(folder.file("b.veg", many)), "");
  EXPECT_THAT(fault(folder.file("b.veg", many), {.memory_limit = kMebibyte}),
              AllOf(HasSubstr("big.txt: the file, which is read again, would take"), HasSubstr("1 MiB")));
}

}  // namespace
}  // namespace meshorder
