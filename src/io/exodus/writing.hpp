// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/exodus/exodus.hpp"
#include "mesh/values.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder::exodus {

/// A block as it is written.
struct BlockPlan {
  Block cells;
  const BlockRecord* record = nullptr;  ///< its record, if the file that the mesh came from had the block
  std::int64_t id = 0;
  std::string name = {};
};

/// A file that is being written, and the results so far.
struct Writing {
  Writing(const Mesh& written, const ExodusMetadata& of_file, NcOutput& out, Notes& warnings)
      : mesh(written), metadata(of_file), file(out), notes(warnings) {}

  /// Returns the array of that name and adds it to `placed`; null if it does not exist or cannot be written.
  const DataArray* take(std::string_view name, Association association);
  /// As `take`, for an array of one component; null for other arrays.
  const DataArray* take_column(std::string_view name, Association association);

  /// Declares a variable; adds the attributes that it had in the file that the mesh came from.
  NcSink declare(const std::string& variable, NcType type, const std::vector<std::string>& dimensions,
                 std::vector<Attribute> attributes = {});
  /// Declares a table of names, with rows of the metadata's `name_length`.
  void write_names(const std::string& variable, const std::string& count,
                   const std::vector<std::string>& names);
  /// Declares a variable of whole numbers: with 32 bits if all numbers fit and `type` is not kInt64, else
  /// with 64 bits.
  void write_integers(const std::string& variable, const std::string& dimension,
                      std::vector<std::int64_t> values, const std::vector<Attribute>& attributes = {},
                      NcType type = kInt);

  const Mesh& mesh;
  const ExodusMetadata& metadata;
  NcOutput& file;
  Notes& notes;
  std::vector<BlockPlan> blocks;
  std::set<const DataArray*> placed;
  std::size_t steps = 0;
};

/// Returns the type in which to write values: `of_file`, their type in the file that the mesh came from, if
/// it can hold each value, else double precision.
NcType written_type(NcType of_file, const Values& values);

/// Returns whether all values are integers, or real numbers that are whole and at most 2^52 in size.
bool are_whole(const Values& values);

/// Returns the values as whole numbers, row by row. They must be of an integer type or satisfy `are_whole`;
/// strings become 0.
std::vector<std::int64_t> whole_values(const Values& values);

/// Converts a number to another type; a string becomes 0.
template <class To, class From>
To number_as(const From& value) {
  if constexpr (std::is_arithmetic_v<From>) {
    return static_cast<To>(value);
  } else {
    return To{};
  }
}

/// Declares the status, ids and properties of blocks or sets. The names of the variables begin with `prefix`,
/// `count` is their dimension; `is_full(plan)` returns whether a plan has members. Returns the names of the
/// blocks or sets.
template <class Plan, class IsFull>
std::vector<std::string> write_plans(Writing& writing, const std::string& prefix, const std::string& count,
                                     const std::vector<Plan>& plans,
                                     const std::vector<std::string>& properties, const IsFull& is_full) {
  std::vector<std::int64_t> ids;
  std::vector<std::int64_t> status;
  std::vector<std::string> names;
  for (const Plan& plan : plans) {
    ids.push_back(plan.id);
    status.push_back(is_full(plan) ? 1 : 0);
    names.push_back(plan.name);
  }
  writing.write_integers(prefix + "_status", count, status);
  writing.write_integers(prefix + "_prop1", count, ids, {text_attribute("name", "ID")});
  for (std::size_t p = 0; p < properties.size(); ++p) {
    std::vector<std::int64_t> values;
    values.reserve(plans.size());
    for (const Plan& plan : plans) values.push_back(plan.record != nullptr ? plan.record->properties[p] : 0);
    writing.write_integers(prefix + "_prop" + std::to_string(p + 2), count, values,
                           {text_attribute("name", properties[p])});
  }
  return names;
}

inline constexpr Index kRowsAtOnce = 1 << 16;

/// Divides `count` rows into parts and calls `put(first, rows)` for each. This keeps copies of values small.
template <class Put>
void in_parts(Index count, const Put& put) {
  for (Index first = 0; first < count; first += std::min(kRowsAtOnce, count - first)) {
    put(first, std::min(kRowsAtOnce, count - first));
  }
}

/// Attributes of elements or nodes: their names and arrays.
using Columns = std::vector<std::pair<std::string, const DataArray*>>;

/// Returns the names of attributes, in their sequence.
inline std::vector<std::string> names_of(const Columns& columns) {
  std::vector<std::string> names;
  for (const auto& [name, array] : columns) names.push_back(name);
  return names;
}

/// Returns one component of an array for `count` vertices or cells from `first` on; `missing` for each one
/// without a row. `table`: see `rows_by_item`.
template <class Number>
std::vector<Number> column(const DataArray& array, Index component, const std::vector<Index>& table,
                           Index first, Index count, Number missing) {
  std::vector<Number> result(static_cast<std::size_t>(count), missing);
  std::visit(
      [&](const auto& values) {
        for (Index k = 0; k < count; ++k) {
          const Offset row = table.empty() ? first + k : table[first + k];
          if (row < 0) continue;
          result[k] = number_as<Number>(values[static_cast<std::size_t>(row * array.components + component)]);
        }
      },
      array.values);
  return result;
}

/// Divides the cells, which already are in the order of the file, into `writing.blocks`.
void plan_blocks(Writing& writing, bool is_own);

/// Gives a block the name of a set with exactly the cells of the block, unless the set was an element set in
/// the file. Returns the other sets of cells.
std::vector<const EntitySet*> name_blocks(Writing& writing);

/// Returns the attributes of a block. A block of the file that the mesh came from keeps the file's
/// attributes; a new block gets the arrays "attribute NAME" that have a value in it.
Columns attributes_of(Writing& writing, const BlockPlan& block);

/// Declares the blocks with their elements and attributes. `attributes` has an entry for each block.
void write_blocks(Writing& writing, const std::vector<Columns>& attributes);

/// A set as it is written.
struct SetPlan {
  std::int64_t id = 0;
  std::string name = {};
  const SetRecord* record = nullptr;
  std::vector<std::int32_t> members = {};  ///< numbers of nodes or elements, from 1
  std::vector<std::int32_t> sides = {};    ///< side sets: the side of each member, from 1
  std::vector<Index> ranks = {};           ///< place of each side among the sides of its element in the set
  const DataArray* factors = nullptr;
  std::vector<int> factor_counts = {};  ///< side sets: number of factors of each side; empty if all are 1
  int factor_width = 1;                 ///< side sets: components of the array for one side
  std::vector<std::vector<const DataArray*>> variables =
      {};  ///< by variable and step, as the record has them
};

/// Returns the sets of each kind as they are written, and adds their arrays to `placed`.
std::vector<std::vector<SetPlan>> plan_sets(Writing& writing,
                                            const std::vector<const EntitySet*>& element_sets);

/// Declares the sets with their factors and variables. `steps` must be known.
void write_sets(Writing& writing, const std::vector<std::vector<SetPlan>>& plans);

/// A variable of nodes or elements as it is written.
struct SeriesPlan {
  std::string name;
  NcType type = kDouble;
  std::vector<const DataArray*> arrays = {};  ///< for each step; null if the step has no array
  Index component = 0;
  std::vector<bool> present = {};   ///< as in Series
  std::vector<bool> declared = {};  ///< as in Series
};

/// Returns the variables of nodes or elements: the variables of the file that the mesh came from, then one
/// variable for each component of the arrays that have no other place. Notes arrays that no variable can
/// hold.
std::vector<SeriesPlan> plan_series(Writing& writing, Association association);

void write_nodal(Writing& writing, const std::vector<SeriesPlan>& series);
void write_elemental(Writing& writing, const std::vector<SeriesPlan>& series);

}  // namespace meshorder::exodus
