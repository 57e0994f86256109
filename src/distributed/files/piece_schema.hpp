// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"
#include "io/vtk/vtk.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::vtk {
struct VtuElement;
}

namespace meshorder::distributed {

/// An array of the pieces.
struct PieceArray {
  enum class Section : std::uint8_t { points_data, cells_data, points, cells };
  enum class Source : std::uint8_t {
    rows,          ///< an array of numbers of the mesh
    texts,         ///< an array of texts of the mesh
    global_ids,    ///< new numbers in the whole mesh, from 0 on
    ghost_type,    ///< VTK's ghost flags: 1 for vertices and cells of other parts
    part,          ///< the part that owns a vertex or cell
    connectivity,  ///< places of the cells' vertices
    offsets,       ///< ends of the cells in the connectivity
  };
  Section section;
  Source source;
  std::string name;
  std::size_t number;      ///< of rows and texts: place among the arrays of the mesh's file
  std::uint8_t type;       ///< number type: index of an alternative of Values
  Offset row;              ///< bytes of a row; for texts, of a place in the list of texts
  std::string attributes;  ///< XML attributes, beginning with a blank, without those that locate the values
  std::string inside;      ///< XML elements inside the array's element

  [[nodiscard]] bool is_on_vertices() const {
    return section == Section::points_data || section == Section::points;
  }
};

/// The properties that all pieces of a mesh have in common, made from the XML of its file.
class PieceSchema {
 public:
  /// @param xml     of a .vtu file of one piece, as in `GridRows`
  /// @param fields  its <FieldData>
  /// @param ghosts  layers of ghost cells
  PieceSchema(const std::string& xml, std::string fields, int ghosts);

  /// Returns the arrays in the order in which a piece has them.
  [[nodiscard]] const std::vector<PieceArray>& arrays() const noexcept { return arrays_; }
  /// Returns the bytes of the word before an array, which holds the array's size: 4 or 8.
  [[nodiscard]] Offset word() const noexcept { return word_; }
  /// Returns the special roles (such as scalars or vectors) that arrays have in the pieces.
  [[nodiscard]] const std::vector<vtk::ArrayRole>& roles() const noexcept { return roles_; }
  /// Returns whether the nodes of higher-order hexahedra are in the order of VTK 9.
  [[nodiscard]] bool has_order_of_vtk_9() const noexcept { return has_order_of_vtk_9_; }
  /// Returns "on points 'part'" and so on: the arrays of the mesh that the pieces replace by their own arrays
  /// of the same names.
  [[nodiscard]] const std::vector<std::string>& replaced() const noexcept { return replaced_; }

  /// Returns the XML of a piece up to its appended data.
  ///
  /// @param sizes  bytes of each array
  [[nodiscard]] std::string head(GlobalIndex vertices, GlobalIndex cells,
                                 const std::vector<Offset>& sizes) const;
  /// Returns a .vtu file of the fields, without a piece.
  [[nodiscard]] std::string fields_alone() const;
  /// Returns the file that names the pieces.
  [[nodiscard]] std::string index(const std::vector<std::string>& files) const;

  static constexpr std::string_view kEnd = "\n  </AppendedData>\n</VTKFile>\n";

 private:
  void add_roles(const vtk::VtuElement& section, PieceArray::Section kind);
  [[nodiscard]] std::string opening(const char* type) const;
  /// Writes the elements of a section's arrays.
  template <class Write>
  void write_section(PieceArray::Section section, const Write& write) const;

  std::string version_;
  std::string fields_;
  std::string points_data_;  ///< attributes
  std::string cells_data_;
  std::vector<PieceArray> arrays_;
  std::vector<std::string> replaced_;
  std::vector<vtk::ArrayRole> roles_;
  bool has_order_of_vtk_9_ = false;
  Offset word_ = 8;
  int ghosts_;
};

}  // namespace meshorder::distributed
