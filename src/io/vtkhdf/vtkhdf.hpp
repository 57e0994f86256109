// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of VTKHDF's unstructured grids.
//
// Format: "VTKHDF File Format",
// https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/index.html. Written is version 1.0,
// which VTK 9.1 and all later ones read; of 2.x what has the same layout is read.

#include "io/format.hpp"
#include "io/vtk/vtk.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace meshorder::vtkhdf {

inline constexpr std::string_view kRoot = "/VTKHDF";
inline constexpr std::string_view kType = "UnstructuredGrid";
/// Attribute of a field whose values are rows of several numbers: VTK 9.1 reads fields of one dimension only.
inline constexpr std::string_view kComponents = "NumberOfComponents";

/// Returns the group of the arrays on vertices or cells.
inline std::string data_group(Association association) {
  return std::string(kRoot) + (association == Association::vertices ? "/PointData" : "/CellData");
}

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

/// Notes the parts of a mesh of another format that VTKHDF has no place for: texts on vertices and cells,
/// which VTK's reader stops at, names of components, information, lookup tables.
void note_lacking(const vtk::WriteContext& from, Notes& notes);

}  // namespace meshorder::vtkhdf
