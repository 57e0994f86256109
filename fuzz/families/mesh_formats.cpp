// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/families/mesh_formats.hpp"

#include "io/format.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace meshorder::fuzz {
namespace {

constexpr std::array kAll{
    MeshFamily{"gmsh", "mesh.msh"},        MeshFamily{"medit", "mesh.mesh"},
    MeshFamily{"tetgen", "mesh.node"},     MeshFamily{"vtk", "mesh.vtk"},
    MeshFamily{"vtu", "mesh.vtu"},         MeshFamily{"vega", "mesh.veg"},
    MeshFamily{"off", "mesh.off"},         MeshFamily{"ply", "mesh.ply"},
    MeshFamily{"obj", "mesh.obj"},         MeshFamily{"stl", "mesh.stl"},
    MeshFamily{"su2", "mesh.su2"},         MeshFamily{"abaqus", "mesh.inp"},
    MeshFamily{"ucd", "mesh.avs"},         MeshFamily{"nastran", "mesh.bdf"},
    MeshFamily{"unv", "mesh.unv"},         MeshFamily{"matrix", "matrix.mtx"},
    MeshFamily{"graph", "graph.graph"},    MeshFamily{"exodus", "mesh.exo", true},
    MeshFamily{"xdmf", "mesh.xdmf", true}, MeshFamily{"cgns", "mesh.cgns", true},
    MeshFamily{"med", "mesh.med", true},   MeshFamily{"vtkhdf", "mesh.vtkhdf", true},
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

}  // namespace meshorder::fuzz
