// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of VTKHDF's unstructured grids.
//
// Format: "VTKHDF File Format",
// https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/index.html. Files of version 1.0 are
// written, which VTK 9.1 and later read; files of 2.x are read if they have the same layout.

#include "io/file_layout.hpp"
#include "io/format.hpp"
#include "io/vtk/vtk.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::vtkhdf {

inline constexpr std::string_view kRoot = "/VTKHDF";
inline constexpr std::string_view kType = "UnstructuredGrid";
/// Attribute with the number of values in a row of a field, if not 1. VTK 9.1 reads only fields of one
/// dimension.
inline constexpr std::string_view kComponents = "NumberOfComponents";

/// Returns the group of the arrays on vertices or cells.
inline std::string data_group(Association association) {
  return std::string(kRoot) + (association == Association::vertices ? "/PointData" : "/CellData");
}

/// The counts of a partition.
struct Partition {
  std::int64_t points = 0;
  std::int64_t cells = 0;
  std::int64_t entries = 0;  ///< length of the connectivity
};

/// A file of one partition as a list of parts: arrays on points and cells, then points, connectivity, offsets
/// and types.
struct RawGrid {
  FileLayout layout;
  vtk::VtkMetadata metadata;  ///< fields and roles
};

/// Finds the bytes of the values in a file on disk. Returns nullopt if only libhdf5 can read the file, or if
/// `read` would note something: for several partitions, chunks or another byte order, texts on points or
/// cells, and contents that the format does not define. O(datasets + size of the fields).
///
/// @throws InputError as `read` for faults of counts and shapes; the values of parts are not read
std::optional<RawGrid> find_raw(const FilePath& path);

/// Writes a file of several partitions to a path on disk, with fields, roles and counts. Allocates space for
/// the values of its datasets, which the caller must then write.
///
/// @param path      path of the file
/// @param name      name of the file in messages
/// @param layout    arrays of all partitions; its parts receive the positions of their values in the file
/// @param metadata  fields, and roles of arrays of the layout; other roles are left out
/// @param notes     receives notes on arrays and fields that have another name in the file
/// @throws InputError if the file cannot be written
void write_without_values(const std::filesystem::path& path, const std::string& name,
                          const std::vector<Partition>& partitions, FileLayout& layout,
                          const vtk::VtkMetadata& metadata, Notes& notes);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

/// Notes the parts of a mesh of another format that VTKHDF cannot hold: names of components,
/// information, lookup tables, and texts on vertices and cells, at which VTK's reader fails.
void note_lacking(const vtk::WriteContext& from, Notes& notes);

}  // namespace meshorder::vtkhdf
