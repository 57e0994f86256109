// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of XDMF 2 and 3.
//
// Format: the XDMF project's "XDMF Model and Format", https://www.xdmf.org/index.php/XDMF_Model_and_Format.
// The numbers of topology types are those of XDMF's own library (XdmfTopologyType.cpp). Nodes of cells are in
// VTK's order: VTK's readers do not reorder them (IO/Xdmf2/vtkXdmfHeavyData.cxx).

#include "io/file_layout.hpp"
#include "io/format.hpp"
#include "io/xdmf/data_item.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::xdmf {

// ---- types of cells

struct TopologyType {
  std::string_view name;
  int number;  ///< number in mixed topologies
  int vtk;     ///< VTK's number of the type
  Shape shape;
  int nodes;  ///< 0: any number, which mixed topologies give for each cell
};

inline constexpr int kPolyvertex = 1;
inline constexpr int kPolyline = 2;
inline constexpr int kMixed = 0x70;

/// Returns the type with a name, in upper or lower case, or with a short name of XDMF 2; null if there is
/// none.
const TopologyType* topology_type(std::string_view name);
/// Returns the type of that number, null if there is none.
const TopologyType* topology_type(std::int64_t number);
/// Returns the type of cells of this shape, null if there is none.
const TopologyType* topology_type_of(Shape shape, int vertices);
/// Returns VTK's type number for cells of a type with `nodes` nodes.
int vtk_type(const TopologyType& type, std::int64_t nodes);

/// Returns whether XDMF has a type for these cells. The node numbering above second order is known only for
/// meshes from XDMF.
bool holds(const Mesh& mesh, Shape shape, int vertices);

// ---- contents of a file

/// The cells of one Topology.
struct TopologyPart {
  std::string name;  ///< name of its Grid
  std::string set;   ///< set of its cells, in the order of the file; empty for the first part, and
                     ///< for a Grid that `layout_of` added
  int below = 0;  ///< of a Grid that `layout_of` added: highest dimension of the mesh's cells minus that of
                  ///< the Grid's cells
  bool has_own_cells = true;  ///< false: all its cells are cells of earlier parts
  bool is_ascending = true;   ///< whether its cells are in the order of the mesh
  std::size_t grid = 0;       ///< number of its Grid; see `Document::number`
};

/// The meaning of a DataItem's values.
struct Field {
  using Role = FilePart::Role;
  Role role;  ///< points, connectivity, data or members
  DataPlace place;
  int part = 0;  ///< number of the part, for cells
  Association association = Association::vertices;
  std::string name = {};  ///< name of the array or the set
  int axis = -1;          ///< axis of the coordinates in this array; −1: the array has all axes
  int base = 0;           ///< number of the first point in a topology
};

/// Data of XDMF's files beyond the mesh.
struct XdmfLayout final : FormatMetadata {
  std::string stem;                         ///< stem of the name of the .xdmf file
  std::string xml;                          ///< XML of the file, without values
  std::map<std::string, std::string> hdf5;  ///< bytes of files without values, by their names in the XML
  std::vector<TopologyPart> parts;
  std::vector<Field> fields;
  std::vector<std::string> words;  ///< see `contents`
  bool inward_wedges = false;      ///< linear wedges in the order of VTK 9.7
  bool is_made = false;            ///< whether `layout_of` made this layout

  [[nodiscard]] std::vector<std::string> contents() const override { return words; }
};

/// Returns an object that makes the files of a layout whose values are all in one HDF5 file.
std::shared_ptr<const SplitFile> with_data(std::shared_ptr<const XdmfLayout> layout);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

/// Returns the layout of a file for a mesh from another format: a Grid for the cells of the highest
/// dimension, and a Grid for the cells of each lower dimension.
XdmfLayout layout_of(const Mesh& mesh, const FilePath& path);

/// Name of the element <Information> that marks a Grid which `layout_of` added: readers make no set of this
/// Grid.
inline constexpr std::string_view kAdded = "cells of a lower dimension";
/// Returns `TopologyPart::below` for the name of a Grid that `layout_of` added; 0 for any other name.
int below_of(std::string_view grid);

/// Returns the cells of each part, in the order of the file.
std::vector<std::vector<Index>> cells_of_parts(const Mesh& mesh, const XdmfLayout& layout);

/// Returns the position of each cell in a file of `layout_of`: by dimension, highest first. `blocks` receives
/// the position of each dimension's first cell.
Permutation places(const Mesh& mesh, std::vector<Index>& blocks);

}  // namespace meshorder::xdmf
