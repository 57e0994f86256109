// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/layout.hpp"
#include "io/file_layout.hpp"
#include "io/vtk/vtk.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::vtk {
struct VtuElement;
}

namespace meshorder::distributed {

/// An array of the pieces: a part whose first byte in each piece is not known yet. If the source is `rows` or
/// `texts`, `number` is the array's index in the mesh's file. For `texts`, `type` is the type of positions in
/// the list of texts.
struct PieceArray : FilePart {
  enum class Source : std::uint8_t {
    rows,          ///< an array of numbers of the mesh
    texts,         ///< an array of texts of the mesh
    global_ids,    ///< new numbers in the whole mesh, from 0 on
    ghost_type,    ///< VTK's ghost flags: 1 for vertices and cells of other parts
    part,          ///< the part that owns a vertex or cell
    connectivity,  ///< positions of the cells' vertices in the piece
    offsets,       ///< ends of the cells in the connectivity
  };
  Source source = Source::rows;
  std::string name;
  std::string attributes;  ///< XML attributes, beginning with a blank, without those that locate the values
  std::string inside;      ///< XML elements inside the array's element

  [[nodiscard]] bool is_on_vertices() const { return association == Association::vertices; }
};

/// The properties that all pieces of a mesh have in common, made from the XML of the mesh's file.
class PieceSchema {
 public:
  /// @param xml     text of a .vtu file of one piece, as in `GridRows`
  /// @param fields  text of the <FieldData>, as in `GridRows`
  /// @param ghosts  number of layers of ghost cells
  PieceSchema(const std::string& xml, std::string fields, int ghosts);

  /// Returns the arrays in the order in which a piece has them.
  [[nodiscard]] const std::vector<PieceArray>& arrays() const noexcept { return arrays_; }
  /// Returns the number of bytes, 4 or 8, in the word that precedes an array and holds the array's size.
  [[nodiscard]] Offset word() const noexcept { return word_; }
  /// Returns the special roles (such as scalars or vectors) that arrays have in the pieces.
  [[nodiscard]] const std::vector<vtk::ArrayRole>& roles() const noexcept { return roles_; }
  /// Returns whether the nodes of higher-order hexahedra are in the order of VTK 9.
  [[nodiscard]] bool has_order_of_vtk_9() const noexcept { return has_order_of_vtk_9_; }
  /// Returns the arrays of the mesh that the pieces replace by their own arrays of the same names, in the
  /// form "on points 'part'".
  [[nodiscard]] const std::vector<std::string>& replaced() const noexcept { return replaced_; }

  /// Returns the XML of a piece up to its appended data.
  ///
  /// @param sizes  bytes of each array
  [[nodiscard]] std::string head(GlobalIndex vertices, GlobalIndex cells,
                                 const std::vector<Offset>& sizes) const;
  /// Returns a .vtu file of the fields, without a piece.
  [[nodiscard]] std::string fields_alone() const;
  /// Returns the text of the .pvtu file that names the pieces.
  [[nodiscard]] std::string index(const std::vector<std::string>& files) const;

  static constexpr std::string_view kEnd = "\n  </AppendedData>\n</VTKFile>\n";

 private:
  void add_roles(const vtk::VtuElement& section, Association association);
  [[nodiscard]] std::string opening(const char* type) const;
  /// Returns the lines of the section of this number, with this indent; `element(tag, array, k)` returns the
  /// element of the k-th array.
  template <class Element>
  [[nodiscard]] std::string section_text(std::size_t section, std::string_view indent,
                                         std::string_view prefix, const Element& element) const;

  std::string version_;
  std::string fields_;
  std::array<std::string, 4> attributes_;  ///< attributes of each section's element
  std::vector<PieceArray> arrays_;
  std::vector<std::string> replaced_;
  std::vector<vtk::ArrayRole> roles_;
  bool has_order_of_vtk_9_ = false;
  Offset word_ = 8;
  int ghosts_;
};

}  // namespace meshorder::distributed
