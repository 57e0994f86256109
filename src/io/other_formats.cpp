// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"

#include <algorithm>
#include <array>

namespace meshorder {
namespace {

constexpr std::string_view kStructured = "is structured";
constexpr std::string_view kGridOrder = "its order is fixed by the grid; nothing to reorder";
constexpr std::string_view kByMeshio =
    "the command of the Python package reads it with meshio (pip install meshio)";
constexpr std::string_view kOneGrid = "save it as one .vtu, in ParaView with Append Datasets and Save Data";

constexpr std::array kOtherFormats{
    OtherFormat{".vtp", "holds VTK's PolyData", "save it as .ply or .vtu, in ParaView with Save Data"},
    OtherFormat{".vtm", "lists several datasets", kOneGrid},
    OtherFormat{".vtmb", "lists several datasets", kOneGrid},
    OtherFormat{".pvd", "lists the steps of a time series", "give one of its .vtu files"},
    OtherFormat{".vti", kStructured, kGridOrder},
    OtherFormat{".vts", kStructured, kGridOrder},
    OtherFormat{".vtr", kStructured, kGridOrder},
    OtherFormat{".mdpa", "is a mesh of Kratos", kByMeshio},
    OtherFormat{".h5m", "is a mesh of MOAB", kByMeshio},
    OtherFormat{".ugrid", "is an AFLR3 file", kByMeshio},
    OtherFormat{".f3grid", "is a mesh of FLAC3D", kByMeshio},
    OtherFormat{".tec", "is a Tecplot file", kByMeshio},
    OtherFormat{".step", "is geometry without a mesh",
                "mesh it first, for example with gmsh IN -3 -o OUT.msh"},
    OtherFormat{".stp", "is geometry without a mesh",
                "mesh it first, for example with gmsh IN -3 -o OUT.msh"},
    OtherFormat{".geo", "is geometry without a mesh",
                "mesh it first, for example with gmsh IN -3 -o OUT.msh"},
    OtherFormat{".xml", "may be a mesh of legacy FEniCS", kByMeshio},
};

}  // namespace

const OtherFormat* other_format(std::string_view extension) {
  const auto* const found =
      std::find_if(kOtherFormats.begin(), kOtherFormats.end(),
                   [&](const OtherFormat& format) { return format.extension == extension; });
  return found == kOtherFormats.end() ? nullptr : found;
}

}  // namespace meshorder
