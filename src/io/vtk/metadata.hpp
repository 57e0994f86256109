// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include "mesh/mesh.hpp"

#include <bit>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The uses that VTK knows of arrays of a mesh: the scalars that a viewer colours by, and so on.
enum class VtkRole : std::uint8_t {
  scalars,
  vectors,
  normals,
  texture_coordinates,
  tensors,
  global_ids,
  pedigree_ids,
  edge_flag,
  tangents,
  rational_weights,
  higher_order_degrees,
  color_scalars,  ///< of legacy files alone
};

/// An array in a role. A legacy file can have several of one role; the first counts.
struct VtkRoleOfArray {
  VtkRole role;
  Association association;
  std::string array;
  std::string lookup_table;  ///< legacy scalars: the name of their table
};

/// What a file says of an array beyond DataArray.
struct VtkArrayFacts {
  std::optional<Association> association;  ///< none: of the whole mesh
  std::string array;
  std::string type;  ///< the file's name of a number type that Values does not tell: "vtkIdType", "long"
  std::string information;      ///< legacy: its INFORMATION, line by line
  std::string xml_information;  ///< .vtu: its elements InformationKey
};

/// How a .vtu file stored its arrays.
struct VtuEncoding {
  enum class Mode : std::uint8_t { ascii, base64, appended_base64, appended_raw };
  enum class Compressor : std::uint8_t { none, zlib, lz4, lzma };
  Mode mode = Mode::appended_raw;
  Compressor compressor = Compressor::none;
  std::endian order = std::endian::native;
  bool wide_headers = true;  ///< UInt64 rather than UInt32
};

/// How a legacy file was laid out.
struct VtkLegacyLayout {
  std::string version = "4.2";
  std::string title = "written by meshorder";
  bool binary = true;
  bool polydata = false;
  struct LookupTable {
    Association association;
    std::string name;
    Index size;
    std::string content;  ///< as it stood in the file, text or bytes
  };
  std::vector<LookupTable> lookup_tables;
};

/// What VTK's two formats keep of each other's files and of their own.
struct VtkMetadata : FormatMetadata {
  std::vector<DataArray> fields;  ///< arrays of the whole mesh, in which `on` and `rows` mean nothing
  std::vector<VtkRoleOfArray> roles;
  std::vector<VtkArrayFacts> facts;
  bool float_points = false;
  std::optional<VtuEncoding> vtu;
  std::optional<VtkLegacyLayout> legacy;

  [[nodiscard]] std::vector<std::string> contents() const override;
};

/// The facts of an array, or nullptr.
const VtkArrayFacts* find_facts(const VtkMetadata& metadata, std::optional<Association> association,
                                std::string_view array);

/// Gives the mesh an array that a file holds. Integers called "set:NAME" that mark members (1, or their rank
/// from 1) become the set NAME.
void add_vtk_array(Mesh& mesh, DataArray array);

/// The arrays that are written for a mesh.
struct VtkArrays {
  std::vector<const DataArray*> all;             ///< full arrays with names of their own, in order
  std::vector<std::shared_ptr<DataArray>> made;  ///< owns those that are not the mesh's
};

/// What VTK's formats hold of data, sets and ids: partial arrays are filled up, sets become arrays "set:NAME"
/// and ids arrays "vertex_id" and "cell_id"; all of it noted. O(size of the arrays that are made).
VtkArrays vtk_arrays(const Mesh& mesh, Notes& notes);

/// The residue of a mesh that came from VTK, or an empty one; what another format's residue holds is noted as
/// left out.
const VtkMetadata& vtk_residue(const Mesh& mesh, Notes& notes);

/// Whether the points can be written as floats as their file had them: no coordinate changes by that.
bool points_are_floats(const Mesh& mesh, const VtkMetadata& metadata);

}  // namespace meshorder
