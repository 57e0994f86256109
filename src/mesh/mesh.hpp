// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "base/text.hpp"
#include "mesh/cells.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace meshorder {

/// Whether an array or a set belongs to vertices or to cells.
enum class Association : std::uint8_t { vertices, cells };

template <>
struct EnumNames<Association> {
  static constexpr std::string_view kind = "association";
  static constexpr std::array names{std::pair{Association::vertices, "vertices"},
                                    std::pair{Association::cells, "cells"}};
};

/// The values of an array, in the number type of the file.
using Values = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int8_t>,
                            std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>,
                            std::vector<std::int32_t>, std::vector<std::uint32_t>, std::vector<std::int64_t>,
                            std::vector<std::uint64_t>, std::vector<std::string>>;

/// Name of the array of integer labels, one for each vertex or cell. Formats translate their own label to and
/// from it: a Medit reference, a TetGen boundary marker, the first physical group of Gmsh.
inline constexpr std::string_view kLabel = "label";

/// Values of vertices or cells: a row of `components` values for each.
struct DataArray {
  std::string name;
  Association association = Association::vertices;
  Index components = 1;
  Values values;
  /// The vertex or cell of each row, in any order, none twice, for arrays that cover only some of them; empty
  /// if row i belongs to vertex or cell i.
  std::vector<Index> indices;
  /// Names of the components; empty if the file has none.
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

/// Data that only one format has, kept by its reader for its writer: materials, encodings, whole sections of
/// text. Must not depend on the order of vertices or cells.
struct FormatMetadata {
  FormatMetadata() = default;
  FormatMetadata(const FormatMetadata&) = default;
  FormatMetadata(FormatMetadata&&) = default;
  FormatMetadata& operator=(const FormatMetadata&) = default;
  FormatMetadata& operator=(FormatMetadata&&) = default;
  virtual ~FormatMetadata() = default;
  /// Lists, in a user's words, the parts that another format loses: {"2 materials", "Gmsh's $Periodic"}.
  [[nodiscard]] virtual std::vector<std::string> contents() const = 0;
};

/// A simulation mesh with the arrays, sets and ids of its file. Plain data: `check_mesh` tells whether the
/// members are consistent.
struct Mesh {
  std::vector<Point> points;  ///< coordinates of the vertices; the third is 0 in the plane
  int dimension = 3;          ///< coordinates of a point in the file: 2 or 3
  Cells cells;

  std::vector<DataArray> data;
  std::vector<EntitySet> sets;

  /// The file's number of each vertex and cell; empty if that is its position, counted from 0 or 1. Ids of
  /// cells are unique at least among cells of one type.
  std::vector<std::int64_t> vertex_ids;
  std::vector<std::int64_t> cell_ids;

  /// The first cell of each block of cells that the format keeps together (Gmsh 4.1's entities), ascending
  /// from 0; empty for one block. Reordering keeps every cell in its block.
  std::vector<Index> cell_blocks;

  std::shared_ptr<const FormatMetadata> format_metadata;

  [[nodiscard]] Index vertex_count() const noexcept { return index_size(points); }
  [[nodiscard]] Index cell_count() const noexcept { return cells.size(); }
};

/// Returns the number of rows of an array: its values divided by its components. O(1).
Index row_count(const DataArray& array);

/// Returns the array of that name, or nullptr. O(arrays).
const DataArray* find_array(const Mesh& mesh, std::string_view name, Association association);

/// Throws InvalidArgument that names the first fault, unless every cell has existing vertices, coordinates
/// are finite, every array has one row for each vertex or cell (or for each of its existing indices), members
/// of sets exist, and ids and blocks fit. O(size of the mesh).
void check_mesh(const Mesh& mesh);

/// Returns the cells that name a vertex twice, ascending. O(vertex entries).
std::vector<Index> degenerate_cells(const Mesh& mesh);

}  // namespace meshorder
