// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/exodus/exodus.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace meshorder::exodus {

/// A block as it is written.
struct BlockPlan {
  Block cells;
  const BlockRecord* record = nullptr;  ///< of the file that the mesh came from, if it had the block
  std::int64_t id = 0;
  std::string name = {};
};

/// A file that is being written, and what is known of it.
struct Writing {
  Writing(const Mesh& written, const Metadata& of_file, NcOutput& out, Notes& warnings)
      : mesh(written), metadata(of_file), file(out), notes(warnings) {}

  /// Returns the array of that name and notes that it has a place; null if it cannot be written.
  const DataArray* take(std::string_view name, Association association);

  /// Declares a variable with the attributes that it had in the file that the mesh came from.
  NcSink declare(const std::string& variable, NcType type, const std::vector<std::string>& dimensions,
                 std::vector<Attribute> attributes = {});
  /// Declares a table of names, with their longest length.
  void write_names(const std::string& variable, const std::string& count,
                   const std::vector<std::string>& names);
  /// Declares whole numbers, of 32 bits where all fit.
  void write_integers(const std::string& variable, const std::string& dimension,
                      std::vector<std::int64_t> values, const std::vector<Attribute>& attributes = {},
                      NcType type = kInt);

  const Mesh& mesh;
  const Metadata& metadata;
  NcOutput& file;
  Notes& notes;
  std::vector<BlockPlan> blocks;
  std::set<const DataArray*> placed;
  std::size_t steps = 0;
};

/// Returns the type in which to write values whose type in the mesh's file was `of_file`: this one if it
/// holds each of them, else double precision.
NcType written_type(NcType of_file, const Values& values);

/// Returns whether values are whole numbers of up to 53 bits, whatever their type.
bool are_whole(const Values& values);

/// Returns the numbers of a type with `components` values for each row as whole numbers; the array must be of
/// an integer type or `are_whole`.
std::vector<std::int64_t> whole_values(const Values& values);

/// Returns the row of an array that belongs to each of `count` vertices or cells, −1 where there is none;
/// none at all for a dense array, of which row i belongs to vertex or cell i.
std::vector<Index> row_table(const DataArray& array, Index count);

/// Converts a number to another type; a string becomes 0.
template <class To, class From>
To number_as(const From& value) {
  if constexpr (std::is_arithmetic_v<From>) {
    return static_cast<To>(value);
  } else {
    return To{};
  }
}

inline constexpr Index kRowsAtOnce = 1 << 16;

/// Calls `put(first, count)` for one part of `count` rows after another, so that the copy that is written
/// stays small.
template <class Put>
void in_parts(Index count, const Put& put) {
  for (Index first = 0; first < count; first += std::min(kRowsAtOnce, count - first)) {
    put(first, std::min(kRowsAtOnce, count - first));
  }
}

/// Attributes of elements or nodes, with their names.
using Columns = std::vector<std::pair<std::string, const DataArray*>>;

/// Divides the cells, which are in their places, into blocks.
void plan_blocks(Writing& writing, bool is_own);

/// Gives blocks the names of the sets that have all of their cells and no others, and returns the other sets
/// of cells.
std::vector<const EntitySet*> name_blocks(Writing& writing);

/// Returns the attributes of a block: those that it had in its file, then those of arrays that are named so
/// and have a value for it.
Columns attributes_of(Writing& writing, const BlockPlan& block);

/// Declares the blocks with their elements and attributes, one of `attributes` for each block.
void write_blocks(Writing& writing, const std::vector<Columns>& attributes);

/// A set as it is written.
struct SetPlan {
  std::int64_t id = 0;
  std::string name = {};
  const SetRecord* record = nullptr;
  std::vector<std::int32_t> members = {};  ///< from 1
  std::vector<std::int32_t> sides = {};    ///< of each member, where these are elements with sides
  std::vector<Index> ranks = {};           ///< place of each side among those of its element
  const DataArray* factors = nullptr;
  std::vector<int> factor_counts = {};  ///< of sides: factors of each; empty if each member has one
  int factor_width = 1;                 ///< of sides: places in the array for one
  std::vector<std::vector<const DataArray*>> variables =
      {};  ///< by variable and step, as the record has them
};

/// Returns the sets of each kind as they are written, and takes their arrays.
std::vector<std::vector<SetPlan>> plan_sets(Writing& writing,
                                            const std::vector<const EntitySet*>& element_sets);

/// Declares the sets with their factors and variables. `steps` must be known.
void write_sets(Writing& writing, const std::vector<std::vector<SetPlan>>& plans);

/// A variable of nodes or elements as it is written.
struct SeriesPlan {
  std::string name;
  NcType type = kDouble;
  std::vector<const DataArray*> arrays = {};  ///< for each step; null where there is none
  Index component = 0;
  std::vector<bool> present = {};   ///< by block: where the file's table says that there are values
  std::vector<bool> declared = {};  ///< by block, or one for nodes: where the file has a variable for values
};

/// Returns the variables of an association: those of the file that the mesh came from, then arrays that have
/// no other place. Notes arrays that no variable can hold.
std::vector<SeriesPlan> plan_series(Writing& writing, Association association);

void write_nodal(Writing& writing, const std::vector<SeriesPlan>& series);
void write_elemental(Writing& writing, const std::vector<SeriesPlan>& series);

}  // namespace meshorder::exodus
