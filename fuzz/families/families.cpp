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

/// Changes an input by one of two mutations, which the seed chooses.
template <Mutate One, Mutate Other>
std::string either(std::string input, std::uint32_t seed) {
  return seed % 2 == 0 ? One(std::move(input), seed / 2) : Other(std::move(input), seed / 2);
}

/// Returns the mutation that changes files of a mesh format with knowledge of their structure.
Mutate mutation_of(const MeshFamily& family) {
  if (family.name == "xdmf") return either<mutate_xml, mutate_hdf5>;
  if (family.name == "exodus") return mutate_exodus;
  if (family.by_library) return mutate_hdf5;
  if (family.name == "gmsh") return either<mutate_sections, mutate_words>;
  if (family.name == "ply") return either<mutate_ply, mutate_words>;
  if (family.name == "vtu") return either<mutate_vtu, mutate_xml>;
  return mutate_words;
}

}  // namespace

std::span<const Family> families() {
  static const std::vector<Family> all = [] {
    std::vector<Family> list{
        {"openfoam", check_openfoam, mutate_words},
        {"npy", check_npy},
        {"scenario", check_scenario, mutate_json},
        {"results", check_results, mutate_json},
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
