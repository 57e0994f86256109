// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of VTKHDF's unstructured grids.
//
// Format: "VTKHDF File Format",
// https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/index.html. Written is version 1.0,
// which VTK 9.1 and all later ones read; of 2.x what has the same layout is read.

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

/// What the datasets of counts say of a partition.
struct Partition {
  std::int64_t points = 0;
  std::int64_t cells = 0;
  std::int64_t entries = 0;  ///< of the connectivity
};

/// A dataset whose values are in the file as they are in memory, one after another.
struct RawDataset {
  enum class Role : std::uint8_t { points, connectivity, offsets, types, data };

  Role role;
  std::string name;         ///< of an array on points or cells
  Association association;  ///< of what has its rows
  std::size_t type;         ///< number type, as an alternative of Values
  Index components;
  std::int64_t rows;
  std::uint64_t place;  ///< first byte in the file
};

/// What there is to know of a file of one partition to read it by its bytes.
struct RawGrid {
  std::int64_t vertices = 0;
  std::int64_t cells = 0;
  std::int64_t entries = 0;          ///< of the connectivity
  std::vector<RawDataset> datasets;  ///< one of each role, and those of data by their associations and names
  vtk::Metadata metadata;            ///< fields and roles
};

/// Finds where the values of a file on disk are. Returns nothing for one that can only be read by libhdf5, or
/// of which `read` would note something: of several partitions, chunks or another order of bytes, with texts
/// on points or cells, or with more than the format has. O(datasets + size of the fields).
///
/// @throws InputError as `read` for faults of counts and shapes; values are not looked at
std::optional<RawGrid> find_raw(const FilePath& path);

/// Writes a file of several partitions over one on disk, with fields, roles and counts, but without the
/// values of its datasets: these have room, and whoever writes them has to fill it.
///
/// @param path      of the file
/// @param name      of the file in messages
/// @param datasets  one of each role but `data`; receive their places
/// @param metadata  fields and roles of arrays that are among the datasets; others are left out
/// @param notes     receives what has another name in the file
/// @throws InputError if it cannot be written
void write_without_values(const std::filesystem::path& path, const std::string& name,
                          const std::vector<Partition>& partitions, std::vector<RawDataset>& datasets,
                          const vtk::Metadata& metadata, Notes& notes);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

/// Notes the parts of a mesh of another format that VTKHDF has no place for: texts on vertices and cells,
/// which VTK's reader stops at, names of components, information, lookup tables.
void note_lacking(const vtk::WriteContext& from, Notes& notes);

}  // namespace meshorder::vtkhdf
