// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <array>
#include <filesystem>
#include <string_view>

namespace meshorder {

/// The attributes that name the array of a role, in the order of VtkRole.
inline constexpr std::array<std::string_view, 11> kVtuRoles{
    "Scalars",     "Vectors",  "Normals",  "TCoords",         "Tensors",           "GlobalIds",
    "PedigreeIds", "EdgeFlag", "Tangents", "RationalWeights", "HigherOrderDegrees"};

/// The attribute that names the compressor, in the order of VtuEncoding::Compressor.
inline constexpr std::array<std::string_view, 4> kVtuCompressors{
    "", "vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"};

/// Reads VTK's XML file of an unstructured grid.
Mesh read_vtu(const std::filesystem::path& path, Notes& notes);

/// Writes one.
void write_vtu(const Mesh& mesh, const std::filesystem::path& path, Notes& notes);

}  // namespace meshorder
