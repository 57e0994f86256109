// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/families/mesh_files.hpp"

#include "fuzz/families/families.hpp"
#include "fuzz/input_files.hpp"
#include "fuzz/round_trip.hpp"
#include "io/format.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace meshorder::fuzz {
namespace {

constexpr std::array kAll{
    MeshFamily{"gmsh", "mesh.msh", mutate_sections},
    MeshFamily{"medit", "mesh.mesh"},
    MeshFamily{"tetgen", "mesh.node"},
    MeshFamily{"vtk", "mesh.vtk"},
    MeshFamily{"vtu", "mesh.vtu", mutate_vtu},
    MeshFamily{"vega", "mesh.veg"},
    MeshFamily{"off", "mesh.off"},
    MeshFamily{"ply", "mesh.ply", mutate_ply},
    MeshFamily{"obj", "mesh.obj"},
    MeshFamily{"stl", "mesh.stl"},
    MeshFamily{"su2", "mesh.su2"},
    MeshFamily{"abaqus", "mesh.inp"},
    MeshFamily{"nastran", "mesh.bdf"},
    MeshFamily{"unv", "mesh.unv"},
    MeshFamily{"matrix", "matrix.mtx"},
    MeshFamily{"graph", "graph.graph"},
    MeshFamily{"exodus", "mesh.exo", mutate_hdf5, true},
    MeshFamily{"xdmf", "mesh.xdmf", mutate_hdf5, true},
    MeshFamily{"cgns", "mesh.cgns", mutate_hdf5, true},
    MeshFamily{"med", "mesh.med", mutate_hdf5, true},
};

bool is_built_in(const MeshFamily& family) {
  try {
    (void)format_of(family.file);
    return true;
  } catch (const Unavailable&) {
    return false;
  }
}

}  // namespace

std::span<const MeshFamily> mesh_families() {
  static const std::vector<MeshFamily> known = [] {
    std::vector<MeshFamily> list;
    std::copy_if(kAll.begin(), kAll.end(), std::back_inserter(list), is_built_in);
    return list;
  }();
  return known;
}

void check_mesh_family(std::string_view family, Family::Bytes input) {
  const auto found = std::find_if(mesh_families().begin(), mesh_families().end(),
                                  [&](const MeshFamily& one) { return one.name == family; });
  const std::string file(found->file);
  check_mesh_files(format_of(file).key(),
                   input_files({reinterpret_cast<const char*>(input.data()), input.size()}, file));
}

}  // namespace meshorder::fuzz
