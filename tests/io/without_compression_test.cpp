// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// A separate program, linked with vtu_compressor.cpp and gzip.cpp as a build without compression libraries
// compiles them.
#include "io/format.hpp"
#include "io/stream/gzip.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_compressor.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace meshorder::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A triangle whose array `heat` is stored as `format` with `content`; its other arrays are text.
std::string triangle(const std::string& compressor, const std::string& format, const std::string& content) {
  return R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian" compressor=")" +
         compressor + R"(">
<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1">
<PointData><DataArray type="Float32" Name="heat" format=")" +
         format + "\">" + content + R"(</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
)";
}

TEST(WithoutCompression, AGzipFileIsRefusedByNameOfLibraryAndOption) {
  EXPECT_EQ(uncompressed("plain", "a"), "plain");
  try {
    (void)uncompressed("\x1f\x8b\x08", "owner.gz");
    ADD_FAILURE() << "not refused";
  } catch (const Unavailable& error) {
    EXPECT_THAT(error.what(), HasSubstr("owner.gz: is compressed"));
    EXPECT_THAT(error.what(), HasSubstr("zlib (MESHORDER_ZLIB=ON)"));
  }
}

TEST(WithoutCompression, ACompressedArrayIsRefusedByNameOfLibraryAndOption) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& compressor) -> std::string {
    const std::string content = triangle(compressor, "binary", "AQAAAAAABAAMAAAADAAAAA==");
    try {
      (void)read_mesh(folder.file("a.vtu", content));
    } catch (const Unavailable& error) {
      return error.what();
    }
    return "read";
  };
  const std::string zlib = message("vtkZLibDataCompressor");
  EXPECT_THAT(zlib,
              HasSubstr("a.vtu:4: the array is compressed by zlib, which this build of meshorder lacks; "));
  EXPECT_THAT(zlib, HasSubstr("MESHORDER_ZLIB=ON"));
  EXPECT_THAT(message("vtkLZ4DataCompressor"), HasSubstr("MESHORDER_LZ4=ON"));
  EXPECT_THAT(message("vtkLZMADataCompressor"), HasSubstr("MESHORDER_LZMA=ON"));
}

TEST(WithoutCompression, ArraysOfTextAreReadWhateverTheCompressor) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.vtu", triangle("vtkZLibDataCompressor", "ascii", "1 2 3")));
  EXPECT_EQ(mesh.vertex_count(), 3);
}

TEST(WithoutCompression, ACompressedMeshIsWrittenWithoutAndThatIsNoted) {
  const TemporaryFolder folder;
  Mesh mesh = tetrahedral_bar(1);
  auto metadata = std::make_shared<vtk::VtkMetadata>();
  metadata->vtu = VtuEncoding{.compressor = VtuEncoding::Compressor::zlib};
  mesh.format_metadata = metadata;
  Notes notes;
  write_mesh(mesh, folder.path() / "a.vtu", &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("MESHORDER_ZLIB=ON")));
  EXPECT_EQ(read_mesh(folder.path() / "a.vtu").cells.vertices, mesh.cells.vertices);
}

}  // namespace
}  // namespace meshorder::test
