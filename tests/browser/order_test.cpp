// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The functions that the page in the browser calls, compiled for this machine.
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>

void tell(const char* /*stage*/, double /*share*/) {}

extern "C" {
char* give_file(const char* name, std::size_t size);
void order_file(const char* input, const char* output, const char* vertices, const char* elements);
int part_count();
const char* part_name(int part);
const void* part_data(int part);
std::size_t part_size(int part);
}

namespace meshorder {
namespace {

/// Two hexahedra, the second before the first along the axis.
constexpr const char* kHexahedra =
    "# vtk DataFile Version 3.0\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 12 double\n"
    "0 0 0  1 0 0  2 0 0  0 1 0  1 1 0  2 1 0  0 0 1  1 0 1  2 0 1  0 1 1  1 1 1  2 1 1\n"
    "CELLS 2 18\n8 1 2 5 4 7 8 11 10\n8 0 1 4 3 6 7 10 9\nCELL_TYPES 2\n12 12\n";

/// Orders "mesh.vtk" with these bytes by rcm and lexmax; returns the parts of the answer by their names.
std::map<std::string, std::string> ordered(const std::string& bytes, const char* output) {
  std::copy(bytes.begin(), bytes.end(), give_file("mesh.vtk", bytes.size()));
  order_file("mesh.vtk", output, "rcm", "lexmax");
  std::map<std::string, std::string> parts;
  for (int i = 0; i < part_count(); ++i)
    parts[part_name(i)].assign(static_cast<const char*>(part_data(i)), part_size(i));
  return parts;
}

TEST(Page, WritesWhatTheLibraryWrites) {
  Mesh mesh = read_mesh(std::as_bytes(std::span(std::string_view(kHexahedra))), {.name = "mesh.vtk"});
  (void)reorder(mesh, {.methods = {.vertices = "rcm", .elements = "lexmax"}, .format = "vtu"});
  const MemoryFiles written = write_mesh_to_memory(mesh, "vtu", "out.vtu");
  auto parts = ordered(kHexahedra, "out.vtu");
  EXPECT_EQ(parts.count("error"), 0U);
  EXPECT_EQ(parts["file:out.vtu"], written.files.front().bytes);
}

TEST(Page, RefusesCellsThatTheOutputCannotHold) {
  const auto parts = ordered(kHexahedra, "out.node");
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_THAT(parts.at("error"), testing::HasSubstr("TetGen cannot hold a cell of type hexahedron; write "));
}

}  // namespace
}  // namespace meshorder
