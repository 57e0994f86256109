// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "mesh/cells.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace meshorder {

/// What an array or a set belongs to.
enum class Association : std::uint8_t { vertices, cells };

/// "vertices", "cells".
std::string_view name(Association association);

/// The values of an array in the number type that the file gave them.
using Values = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int8_t>,
                            std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>,
                            std::vector<std::int32_t>, std::vector<std::uint32_t>, std::vector<std::int64_t>,
                            std::vector<std::uint64_t>, std::vector<std::string>>;

/// The name under which every format keeps *the* integer label of a vertex or cell: a Medit reference, a
/// TetGen boundary marker, the first physical group of Gmsh. Conversions find each other by it.
inline constexpr std::string_view kLabel = "label";

/// Numbers that belong to vertices or cells, `components` for each, row after row.
struct DataArray {
  std::string name;
  Association association = Association::vertices;
  Index components = 1;
  Values values;
  /// The vertices or cells that the rows belong to, for arrays that cover only some of them (in any order,
  /// none twice); empty when row i belongs to vertex or cell i.
  std::vector<Index> indices;
  /// Names of the components, where the file gave them; else empty.
  std::vector<std::string> component_names;

  [[nodiscard]] bool is_dense() const noexcept { return indices.empty(); }
  bool operator==(const DataArray&) const = default;
};

/// A named list of vertices or cells, in the order of the file.
struct EntitySet {
  std::string name;
  Association association = Association::cells;
  std::vector<Index> members;

  bool operator==(const EntitySet&) const = default;
};

/// What a format's reader keeps for its own writer and no other format can hold: materials, names, encodings,
/// whole sections of text. Nothing in it may depend on the order of vertices or cells.
struct FormatMetadata {
  FormatMetadata() = default;
  FormatMetadata(const FormatMetadata&) = default;
  FormatMetadata(FormatMetadata&&) = default;
  FormatMetadata& operator=(const FormatMetadata&) = default;
  FormatMetadata& operator=(FormatMetadata&&) = default;
  virtual ~FormatMetadata() = default;
  /// What is lost when another format is written, in a user's words: {"2 materials", "the section
  /// $Periodic"}.
  [[nodiscard]] virtual std::vector<std::string> contents() const = 0;
};

/// A simulation mesh with all that its file attached to it. Plain data: whoever changes one member keeps the
/// others in step; `check_mesh` (mesh/check.hpp) tells whether they are.
struct Mesh {
  std::vector<Point> points;  ///< coordinates; the third is 0 where the file has two
  int dimension = 3;          ///< coordinates that the file gives to a point: 2 or 3
  Cells cells;

  std::vector<DataArray> data;
  std::vector<EntitySet> sets;

  /// The number that the file gives to each vertex and cell, where it is not simply its position (counted
  /// from 0 or 1); else empty. Ids of cells are unique among cells of one type at least.
  std::vector<std::int64_t> vertex_ids;
  std::vector<std::int64_t> cell_ids;

  /// The first cell of each block of cells that the format keeps together (Gmsh 4.1's entities), rising from
  /// 0; empty for one block. Reordering keeps every cell in its block.
  std::vector<Index> cell_blocks;

  std::shared_ptr<const FormatMetadata> format_metadata;

  [[nodiscard]] Index vertex_count() const noexcept { return index_size(points); }
  [[nodiscard]] Index cell_count() const noexcept { return cells.size(); }
};

/// Rows of an array: its values divided by its components. O(1).
Index row_count(const DataArray& array);

/// The array of that name, or nullptr. O(arrays).
const DataArray* find_array(const Mesh& mesh, std::string_view name, Association association);

}  // namespace meshorder
