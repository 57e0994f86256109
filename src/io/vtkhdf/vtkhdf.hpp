// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of VTKHDF's unstructured grids.
//
// Format: "VTKHDF File Format",
// https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/index.html. Files of version 1.0 are
// written, which VTK 9.1 and later read; files of 2.x are read if they have the same layout.

#include "io/format.hpp"
#include "io/vtk/vtk.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::vtkhdf {

inline constexpr std::string_view kRoot = "/VTKHDF";
inline constexpr std::string_view kType = "UnstructuredGrid";
/// Attribute of a field whose values are rows of several numbers: VTK 9.1 reads fields of one dimension only.
inline constexpr std::string_view kComponents = "NumberOfComponents";

/// Returns the group of the arrays on vertices or cells.
inline std::string data_group(Association association) {
  return std::string(kRoot) + (association == Association::vertices ? "/PointData" : "/CellData");
}

/// The counts of a partition.
struct Partition {
  std::int64_t points = 0;
  std::int64_t cells = 0;
  std::int64_t entries = 0;  ///< of the connectivity
};

/// A dataset that stores its values one after another, as they are in memory.
struct RawDataset {
  enum class Role : std::uint8_t { points, connectivity, offsets, types, data };

  Role role;
  std::string name;         ///< of an array on points or cells
  Association association;  ///< whether a row is that of a vertex or of a cell
  std::size_t type;         ///< number type, as an alternative of Values
  Index components;
  std::int64_t rows;
  std::uint64_t place;  ///< first byte in the file
};

/// What is needed to read a file of one partition by its bytes.
struct RawGrid {
  std::int64_t vertices = 0;
  std::int64_t cells = 0;
  std::int64_t entries = 0;          ///< of the connectivity
  std::vector<RawDataset> datasets;  ///< one of each role, but of `data` one for each array
  vtk::Metadata metadata;            ///< fields and roles
};

/// Finds the bytes of the values in a file on disk. Returns nothing if only libhdf5 can read the file, or if
/// `read` would note something: for several partitions, chunks or another byte order, for texts on points or
/// cells, and for contents that the format does not define. O(datasets + size of the fields).
///
/// @throws InputError as `read` for faults of counts and shapes; values are not looked at
std::optional<RawGrid> find_raw(const FilePath& path);

/// Writes a file of several partitions to a path on disk, with fields, roles and counts. Allocates space for
/// the values of its datasets, which the caller must then write.
///
/// @param path      of the file
/// @param name      of the file in messages
/// @param datasets  one of each role, any number of `data`; receive the places of their values
/// @param metadata  fields and roles of arrays that are among the datasets; others are left out
/// @param notes     receives notes on arrays and fields that have another name in the file
/// @throws InputError if it cannot be written
void write_without_values(const std::filesystem::path& path, const std::string& name,
                          const std::vector<Partition>& partitions, std::vector<RawDataset>& datasets,
                          const vtk::Metadata& metadata, Notes& notes);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

/// Notes the parts of a mesh of another format that VTKHDF has no place for: texts on vertices and cells, at
/// which VTK's reader fails, names of components, information, lookup tables.
void note_lacking(const vtk::WriteContext& from, Notes& notes);

}  // namespace meshorder::vtkhdf
