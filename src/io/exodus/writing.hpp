// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/cell_division.hpp"
#include "io/exodus/exodus.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder::exodus {

/// The plan for a block of the file.
struct BlockPlan {
  CellPart cells;
  const BlockRecord* record = nullptr;  ///< record in the file that the mesh came from; null: new block
  std::int64_t id = 0;
  std::string name = {};

  [[nodiscard]] bool is_full() const noexcept { return cells.count > 0; }
  /// Returns the name of the elements' type.
  [[nodiscard]] std::string_view type() const;
};

/// The plan of where the blocks and arrays of a mesh go in a file; completed step by step.
struct Planning {
  /// Returns the array of that name and adds it to `placed`; null if it does not exist or cannot be written.
  const DataArray* take(std::string_view name, Association association);
  /// As `take`, for an array of one component; null for other arrays.
  const DataArray* take_column(std::string_view name, Association association);
  /// Returns the block of a cell; `blocks` must be known. O(log blocks).
  [[nodiscard]] BlockPlan& block_of(Index cell);

  const Mesh& mesh;
  const ExodusMetadata& metadata;
  Notes& notes;
  std::vector<BlockPlan> blocks = {};
  std::set<const DataArray*> placed = {};
};

/// A file that is being written.
struct Writing : Planning {
  Writing(const Mesh& written, const ExodusMetadata& of_file, NcOutput& out, Notes& warnings)
      : Planning{written, of_file, warnings}, file(out) {}

  /// Declares a variable; adds the attributes that the variable had in the file that the mesh came from.
  NcSink declare(const std::string& variable, NcType type, const std::vector<std::string>& dimensions,
                 std::vector<Attribute> attributes = {});
  /// Declares a table of names, with rows of `metadata.name_length` bytes.
  void write_names(const std::string& variable, const std::string& count,
                   const std::vector<std::string>& names);
  /// Declares a variable of whole numbers: with 32 bits if all numbers fit and `type` is not kInt64, else
  /// with 64 bits.
  void write_integers(const std::string& variable, const std::string& dimension,
                      std::vector<std::int64_t> values, const std::vector<Attribute>& attributes = {},
                      NcType type = kInt);

  NcOutput& file;
  std::size_t steps = 0;
};

/// Returns the type in which to write values: `of_file` if it can hold each value, else double precision.
/// `of_file`: their type in the file that the mesh came from.
NcType written_type(NcType of_file, const Values& values);

/// Returns whether all values are integers, or real numbers that are whole and at most 2^52 in magnitude.
bool are_whole(const Values& values);

/// Returns the values, which satisfy `are_whole`, as whole numbers.
std::vector<std::int64_t> whole_values(const Values& values);

/// An attribute of elements or nodes as it is written.
struct Column {
  std::string name;
  const DataArray* array;
};
using Columns = std::vector<Column>;

/// Appends the names of blocks, sets, attributes, maps or variables.
template <class Plan>
void add_names(const std::vector<Plan>& plans, std::vector<std::string>& names) {
  for (const Plan& plan : plans) names.push_back(plan.name);
}

template <class Plan>
std::vector<std::string> names_of(const std::vector<Plan>& plans) {
  std::vector<std::string> names;
  add_names(plans, names);
  return names;
}

/// Declares the status, ids, properties and names of blocks or sets. The names of the netCDF variables begin
/// with `prefix`; `count` is their dimension. `labels`: values of `kLabelProperty`; empty: no such property.
template <class Plan>
void write_plans(Writing& writing, const std::string& prefix, const std::string& count,
                 const std::vector<Plan>& plans, const std::vector<std::string>& properties, bool has_names,
                 const std::vector<std::int64_t>& labels = {}) {
  std::vector<std::int64_t> ids;
  std::vector<std::int64_t> status;
  for (const Plan& plan : plans) {
    ids.push_back(plan.id);
    status.push_back(plan.is_full() ? 1 : 0);
    has_names = has_names || !plan.name.empty();
  }
  int number = 0;
  const auto write_property = [&](const std::vector<std::int64_t>& values, std::string_view name) {
    writing.write_integers(fmt::format("{}_prop{}", prefix, ++number), count, values,
                           {text_attribute("name", std::string(name))});
  };
  writing.write_integers(prefix + "_status", count, status);
  write_property(ids, "ID");
  for (std::size_t p = 0; p < properties.size(); ++p) {
    std::vector<std::int64_t> values;
    values.reserve(plans.size());
    for (const Plan& plan : plans) values.push_back(plan.record != nullptr ? plan.record->properties[p] : 0);
    write_property(values, properties[p]);
  }
  if (!labels.empty()) write_property(labels, kLabelProperty);
  if (has_names) writing.write_names(prefix + "_names", count, names_of(plans));
}

inline constexpr Index kRowsAtOnce = 1 << 16;

/// Calls `put(first, rows)` for consecutive parts of `count` rows: small parts keep copies of values small.
template <class Put>
void in_parts(Index count, const Put& put) {
  for (Index first = 0; first < count; first += std::min(kRowsAtOnce, count - first))
    put(first, std::min(kRowsAtOnce, count - first));
}

/// Returns one component of an array for `count` vertices or cells from `first` on; `missing` for vertices or
/// cells without a row. `table`: see `rows_by_item`.
template <class Number>
std::vector<Number> column(const DataArray& array, Index component, const std::vector<Index>& table,
                           Index first, Index count, Number missing) {
  std::vector<Number> result(static_cast<std::size_t>(count), missing);
  with_numbers(array.values, [&](const auto& values) {
    for (Index k = 0; k < count; ++k) {
      const Offset row = table.empty() ? first + k : table[first + k];
      if (row >= 0) result[k] = static_cast<Number>(values[row * array.components + component]);
    }
  });
  return result;
}

/// Declares a table of attributes with a row for each of `count` vertices or cells from `first` on, and 0 for
/// missing values.
void write_columns(Writing& writing, const std::string& variable, NcType type,
                   const std::vector<std::string>& dimensions, const Columns& columns, Index first,
                   Index count);

/// Calls `put(missing)`; `missing` marks missing values in a netCDF variable of the type. `put` writes
/// `array`, which may be null, as numbers of the type of `missing`.
template <class Put>
void put_as(NcType type, const DataArray* array, const Put& put) {
  const bool is_wide = array != nullptr && std::holds_alternative<std::vector<std::uint64_t>>(array->values);
  if (type == kFloat) return put(missing_value<float>());
  if (!is_whole(type)) return put(missing_value<double>());
  if (is_wide) return put(std::uint64_t{0});
  put(std::int64_t{0});
}

/// Divides the cells, which already are in the order of the file, into `planning.blocks`.
void plan_blocks(Planning& planning, bool is_own);

/// Names each block after a set that has exactly the block's cells, unless the set was an element set in the
/// file. Returns all other sets of cells.
std::vector<const EntitySet*> name_blocks(Planning& planning);

/// Returns the attributes of a block. A block of the file that the mesh came from keeps the file's
/// attributes; a new block gets the arrays "attribute NAME" that have a value in the block.
Columns attributes_of(Planning& planning, const BlockPlan& block);

/// Declares the blocks with their elements and attributes. `attributes` has an entry for each block.
void write_blocks(Writing& writing, const std::vector<Columns>& attributes);

/// The plan for a set of the file.
struct SetPlan {
  std::int64_t id = 0;
  std::string name = {};
  const SetRecord* record = nullptr;
  std::vector<std::int32_t> members = {};  ///< numbers of nodes or elements, from 1
  std::vector<std::int32_t> sides = {};    ///< side sets: the side of each member, from 1
  std::vector<Index> ranks = {};           ///< rank of each side among the sides of its element in the set
  const DataArray* factors = nullptr;
  std::vector<int> factor_counts = {};  ///< side sets: number of factors of each side; empty if all are 1
  int factor_width = 1;                 ///< side sets: number of the array's components for a side
  std::vector<std::vector<const DataArray*>> variables = {};  ///< by variable and step, as in `record`

  [[nodiscard]] bool is_full() const noexcept { return !members.empty(); }
  [[nodiscard]] std::size_t factor_count() const;
};

/// Returns the sets of each kind as they are written, and adds their arrays to `placed`.
std::vector<std::vector<SetPlan>> plan_sets(Planning& planning,
                                            const std::vector<const EntitySet*>& element_sets);

/// Declares the sets with their factors and variables. `writing.steps` must be set.
void write_sets(Writing& writing, const std::vector<std::vector<SetPlan>>& plans);

/// The plan for a nodal or element variable.
struct SeriesPlan {
  std::string name;
  NcType type = kDouble;
  std::vector<const DataArray*> arrays = {};  ///< array of each step; null if the step has none
  Index component = 0;
  std::vector<bool> present = {};   ///< as in Series
  std::vector<bool> declared = {};  ///< as in Series
};

/// Returns the nodal or element variables: those of the file that the mesh came from, then one for each
/// component of each array that is not in `placed`. Notes arrays that no variable can hold.
std::vector<SeriesPlan> plan_series(Planning& planning, Association association);

void write_nodal(Writing& writing, const std::vector<SeriesPlan>& series);
void write_elemental(Writing& writing, const std::vector<SeriesPlan>& series);

}  // namespace meshorder::exodus
