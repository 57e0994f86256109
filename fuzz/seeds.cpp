// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Writes the first inputs of all families, one folder for each:
//
//   meshorder_fuzz_seeds FOLDER
#ifdef MESHORDER_HAS_NETCDF
#include "fuzz/exodus_seed.hpp"
#endif
#include "fuzz/families/mesh_formats.hpp"
#include "fuzz/input_files.hpp"
#ifdef MESHORDER_HAS_CGNS
#include "io/cgns/tree.hpp"
#endif
#include "io/format.hpp"
#include "io/gmsh_files.hpp"
#include "io/npy.hpp"
#include "io/vtk/vtk.hpp"
#include "lab/scenario/checkpoint.hpp"
#include "lab/study/results_json.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include "support/sample_results.hpp"
#include <meshorder/error.hpp>

#ifdef MESHORDER_HAS_NETCDF
#include <netcdf.h>
#endif
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <numeric>
#include <random>

namespace meshorder::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostOfSeed = 8192;  // bytes; small seeds are quick to run

class Seeds {
 public:
  explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}

  void add(std::string_view family, std::string_view input) {
    const fs::path folder = folder_ / family;
    fs::create_directories(folder);
    const std::string name = "seed-" + std::to_string(counts_[std::string(family)]++);
    std::ofstream(folder / name, std::ios::binary)
        .write(input.data(), static_cast<std::streamsize>(input.size()));
  }

 private:
  fs::path folder_;
  std::map<std::string, int> counts_;
};

std::vector<Mesh> sample_meshes() {
  std::vector<Mesh> meshes{test::tetrahedral_bar(1), test::triangles_and_line(2), test::mixed_mesh()};
  for (const auto& types : {test::linear_types(), test::quadratic_types()}) {
    for (const auto& [shape, vertices] : types) meshes.push_back(test::cells_of_type(shape, vertices, 2));
  }
  return meshes;
}

void add_meshes(Seeds& seeds) {
  for (const MeshFamily& family : mesh_families()) {
    const std::string format = format_of(fs::path(family.file)).key();
    for (const Mesh& mesh : sample_meshes()) {
      try {
        const std::string input = input_of(write_mesh_to_memory(mesh, format, family.file).files);
        constexpr std::array kBinary{"exodus", "xdmf", "cgns", "med", "vtkhdf"};
        const bool binary = std::find(kBinary.begin(), kBinary.end(), format) != kBinary.end();
        if (binary || input.size() <= kMostOfSeed) seeds.add(family.name, input);
      } catch (const InputError&) {  // the format does not hold such cells
      }
    }
  }
}

/// Returns a mesh that the writer of .vtu files stores with this encoding.
Mesh stored_so(const VtuEncoding& encoding) {
  Mesh mesh = test::tetrahedral_bar(1);
  mesh.format = "vtu";
  vtk::VtkMetadata metadata;
  metadata.vtu = encoding;
  mesh.format_metadata = std::make_shared<vtk::VtkMetadata>(metadata);
  return mesh;
}

void add_encodings(Seeds& seeds) {
  using Mode = VtuEncoding::Mode;
  using Compressor = VtuEncoding::Compressor;
  for (const Mode mode : {Mode::ascii, Mode::base64, Mode::appended_base64, Mode::appended_raw}) {
    for (const Compressor compressor :
         {Compressor::none, Compressor::zlib, Compressor::lz4, Compressor::lzma}) {
      for (const std::endian order : {std::endian::little, std::endian::big}) {
        const Mesh mesh = stored_so({mode, compressor, order, order == std::endian::little});
        seeds.add("vtu", write_mesh_to_memory(mesh, "vtu", "mesh.vtu").files.front().bytes);
      }
    }
  }
  for (const char* version : {"2.0", "3.0", "4.2", "5.1"}) {
    for (const bool binary : {false, true}) {
      Mesh mesh = test::tetrahedral_bar(1);
      mesh.format = "vtk";
      vtk::VtkMetadata metadata;
      vtk::LegacyLayout& layout = metadata.legacy.emplace();
      layout.version = version;
      layout.binary = binary;
      mesh.format_metadata = std::make_shared<vtk::VtkMetadata>(metadata);
      seeds.add("vtk", write_mesh_to_memory(mesh, "vtk", "mesh.vtk").files.front().bytes);
    }
  }
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    seeds.add("gmsh", test::gmsh_40_binary(order));
    seeds.add("gmsh", test::gmsh_41_binary(order));
    seeds.add("gmsh", test::gmsh_22_binary(order));
  }
  seeds.add("gmsh", test::kGmsh1);
  seeds.add("gmsh", test::gmsh_40());
  seeds.add("gmsh", test::kGmsh41);
  seeds.add("gmsh", test::kGmsh22);
}

#ifdef MESHORDER_HAS_NETCDF
void add_exodus(Seeds& seeds) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "mesh.exo";
  constexpr exodus::Storage kNetcdf4{.kind = NC_FORMAT_NETCDF4, .deflate = 1, .shuffle = true};
  for (const exodus::Storage& storage :
       {exodus::plain_storage(false), exodus::plain_storage(true), kNetcdf4}) {
    write_exodus_seed(path, storage);
    seeds.add("exodus", test::content_of(path));
  }
}
#endif

#ifdef MESHORDER_HAS_CGNS
/// Adds a file of CGNS's older kind (ADF), which meshorder reads and writes again, but does not make from
/// other formats.
void add_adf(Seeds& seeds) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "mesh.cgns";
  write_mesh(test::tetrahedral_bar(1), path);
  cgns::Tree tree = cgns::read_tree(path);
  tree.storage = cgns::Storage::adf;
  cgns::write_tree(tree, path, [](cgns::Node& /*node*/) {});
  seeds.add("cgns", test::content_of(path));
}
#endif

void add_laboratory(Seeds& seeds) {
  for (const char* name : {"falling", "constrained", "stretch", "unsquash", "bowl", "bounce"}) {
    seeds.add("scenario", test::content_of(fs::path(MESHORDER_SCENARIOS) / (std::string(name) + ".json")));
  }
  StudyResults results = test::sample_results();
  seeds.add("results", to_json(results).dump());
  results.scenarios.resize(1);
  results.orderings.resize(2);
  seeds.add("results", to_json(results).dump());

  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "file";
  const std::vector<Point> points{{0, 0, 0}, {1, 0.5, -2}};
  Checkpoint checkpoint{{1, 2, 3}, {}, {}};
  write_checkpoint(checkpoint, path);
  seeds.add("checkpoint", test::content_of(path));
  checkpoint.state.positions = points;
  checkpoint.state.velocities = points;
  checkpoint.state.memory = {1, 2, 3};
  checkpoint.record.steps.resize(2);
  checkpoint.record.balances.resize(3);
  checkpoint.record.warnings = {{"it slips", 1, 2}};
  write_checkpoint(checkpoint, path);
  seeds.add("checkpoint", test::content_of(path));

  for (const int frames : {0, 1, 3}) {
    MotionFile motion(path, index_size(points));
    for (int f = 0; f < frames; ++f) motion.add(points);
    motion.commit();
    seeds.add("motion", test::content_of(path));
  }
}

void add_maps(Seeds& seeds) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "map.npy";
  for (const Index size : {0, 1, 7}) {
    std::vector<std::int32_t> narrow(static_cast<std::size_t>(size));
    std::iota(narrow.rbegin(), narrow.rend(), 0);
    write_npy(narrow, path);
    seeds.add("npy", test::content_of(path));
    write_npy(std::vector<std::int64_t>(narrow.begin(), narrow.end()), path);
    seeds.add("npy", test::content_of(path));
  }
}

/// Adds two cubes side by side; the point at (x, y, z) has the number x + 3y + 6z.
void add_openfoam(Seeds& seeds) {
  const auto file = [](std::string_view class_name, std::string_view list) {
    return "FoamFile\n{\n    format ascii;\n    class " + std::string(class_name) + ";\n}\n" +
           std::string(list);
  };
  const std::string points =
      "12(\n(0 0 0)(1 0 0)(2 0 0)(0 1 0)(1 1 0)(2 1 0)\n(0 0 1)(1 0 1)(2 0 1)(0 1 1)(1 1 1)(2 1 1)\n)";
  const std::string owner = "11(0 0 0 0 0 0 1 1 1 1 1)";
  const std::vector<MemoryFile> nested{
      {"owner", file("labelList", owner)},
      {"neighbour", file("labelList", "1(1)")},
      {"points", file("vectorField", points)},
      {"faces", file("faceList",
                     "11(4(1 4 10 7) 4(0 6 9 3) 4(0 1 7 6) 4(3 9 10 4) 4(0 3 4 1) 4(6 7 10 9)\n"
                     "4(2 5 11 8) 4(1 2 8 7) 4(4 10 11 5) 4(1 4 5 2) 4(7 8 11 10))")},
      {"boundary", file("polyBoundaryMesh", "1(walls { type wall; nFaces 10; startFace 1; })")}};
  seeds.add("openfoam", input_of(nested));
  std::vector<MemoryFile> compact = nested;
  compact[3].bytes = file("faceCompactList",
                          "12(0 4 8 12 16 20 24 28 32 36 40 44)\n"
                          "44(1 4 10 7 0 6 9 3 0 1 7 6 3 9 10 4 0 3 4 1 6 7 10 9\n"
                          "2 5 11 8 1 2 8 7 4 10 11 5 1 4 5 2 7 8 11 10)");
  seeds.add("openfoam", input_of(compact));
  std::vector<MemoryFile> uniform = nested;
  uniform[0].bytes = file("labelList", "3{0}");
  uniform[1].bytes = file("labelList", "0()");
  uniform[4].bytes = file("polyBoundaryMesh", "1(walls { nFaces 3; startFace 0; })");
  seeds.add("openfoam", input_of(uniform));
}

void add_arrays(Seeds& seeds) {
  std::mt19937 random(1);
  for (const char* family : {"graphs", "cells"}) {
    for (std::size_t size = 16; size <= 1024; size *= 2) {
      std::string bytes(size, '\0');
      for (char& byte : bytes) byte = static_cast<char>(random() % 200);
      seeds.add(family, bytes);
    }
  }
  seeds.add("planted", "$MeshFormat\n");
}

}  // namespace
}  // namespace meshorder::fuzz

int main(int argc, char** argv) {
  using namespace meshorder::fuzz;
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  try {
    Seeds seeds(argv[1]);
    add_meshes(seeds);
    add_encodings(seeds);
#ifdef MESHORDER_HAS_NETCDF
    add_exodus(seeds);
#endif
#ifdef MESHORDER_HAS_CGNS
    add_adf(seeds);
#endif
    add_laboratory(seeds);
    add_maps(seeds);
    add_openfoam(seeds);
    add_arrays(seeds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
