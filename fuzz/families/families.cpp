// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/families/families.hpp"

#include "fuzz/families/mesh_formats.hpp"
#include "fuzz/families/scratch.hpp"
#include "fuzz/input_files.hpp"
#include "fuzz/round_trip.hpp"
#include "io/format.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::fuzz {
namespace {

using Mutate = std::string (*)(std::string input, std::uint32_t seed);

/// An XDMF file: its XML or the values that stand beside it.
std::string mutate_xdmf(std::string input, std::uint32_t seed) {
  if (seed % 2 == 0) return mutate_hdf5(std::move(input), seed / 2);
  return mutate_xml(std::move(input), seed / 2);
}

/// Returns what changes files of a mesh format knowing their structure; null if nothing does.
Mutate mutation_of(const MeshFamily& family) {
  if (family.name == "xdmf") return mutate_xdmf;
  if (family.by_library) return mutate_hdf5;
  if (family.name == "gmsh") return mutate_sections;
  if (family.name == "ply") return mutate_ply;
  if (family.name == "vtu") return mutate_vtu;
  return nullptr;
}

}  // namespace

std::span<const Family> families() {
  static const std::vector<Family> all = [] {
    std::vector<Family> list{
        {"openfoam", check_openfoam},
        {"npy", check_npy},
        {"scenario", check_scenario},
        {"results", check_results},
        {"checkpoint", check_checkpoint, mutate_checkpoint},
        {"motion", check_motion},
        {"graphs", check_graphs},
        {"cells", check_cells},
        {"planted", check_planted},
    };
    for (const MeshFamily& family : mesh_families()) {
      list.push_back({family.name, check_mesh_family, mutation_of(family), family.by_library});
    }
    return list;
  }();
  return all;
}

void check_mesh_family(std::string_view family, Family::Bytes input) {
  const auto found = std::find_if(mesh_families().begin(), mesh_families().end(),
                                  [&](const MeshFamily& one) { return one.name == family; });
  const std::string file(found->file);
  check_mesh_files(format_of(file).key(), input_files(text_of(input), file));
}

}  // namespace meshorder::fuzz
