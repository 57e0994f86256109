// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include "io/vtk/metadata.hpp"

#include <array>
#include <filesystem>
#include <string_view>

namespace meshorder {

/// The attributes of a legacy file by their keywords, with the components that each must have (0: any).
struct VtkLegacyAttribute {
  std::string_view keyword;
  VtkRole role;
  int components;
};

inline constexpr std::array kVtkLegacyAttributes{
    VtkLegacyAttribute{"SCALARS", VtkRole::scalars, 0},
    VtkLegacyAttribute{"COLOR_SCALARS", VtkRole::color_scalars, 0},
    VtkLegacyAttribute{"VECTORS", VtkRole::vectors, 3},
    VtkLegacyAttribute{"NORMALS", VtkRole::normals, 3},
    VtkLegacyAttribute{"TEXTURE_COORDINATES", VtkRole::texture_coordinates, 0},
    VtkLegacyAttribute{"TENSORS", VtkRole::tensors, 9},
    VtkLegacyAttribute{"TENSORS6", VtkRole::tensors, 6},
    VtkLegacyAttribute{"GLOBAL_IDS", VtkRole::global_ids, 1},
    VtkLegacyAttribute{"PEDIGREE_IDS", VtkRole::pedigree_ids, 1},
    VtkLegacyAttribute{"EDGE_FLAGS", VtkRole::edge_flag, 1},
};

/// The sections of cells of a POLYDATA file, in the order in which cell data counts them.
inline constexpr std::array<std::string_view, 4> kVtkPolydataSections{"VERTICES", "LINES", "POLYGONS",
                                                                      "TRIANGLE_STRIPS"};

/// The name under which facts on the coordinates are kept.
inline constexpr std::string_view kVtkPoints = "POINTS";

/// Reads a legacy file of VTK.
Mesh read_vtk_legacy(const std::filesystem::path& path, Notes& notes);

}  // namespace meshorder
