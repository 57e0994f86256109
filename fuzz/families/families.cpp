// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/families/families.hpp"

#include "fuzz/families/mesh_files.hpp"

#include <algorithm>
#include <vector>

namespace meshorder::fuzz {

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
      list.push_back({family.name, check_mesh_family, family.mutate, family.by_library});
    }
    return list;
  }();
  return all;
}

const Family* find_family(std::string_view name) {
  const auto found = std::find_if(families().begin(), families().end(),
                                  [&](const Family& family) { return family.name == name; });
  return found == families().end() ? nullptr : &*found;
}

}  // namespace meshorder::fuzz
