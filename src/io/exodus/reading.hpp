// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/exodus/exodus.hpp"
#include "io/mesh_part.hpp"
#include "io/names.hpp"

#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace meshorder::exodus {

/// Consecutive rows of a netCDF variable.
struct Rows {
  std::size_t first;
  std::size_t count;
};

/// A file that is being read, completely or in part, and the results so far.
struct Reading {
  /// @param wanted  the ranges to read; null: the whole mesh. Must outlive this object
  Reading(const FilePath& path, const MeshRanges* wanted, Notes& warnings)
      : file(path), ranges_wanted(wanted), metadata(std::make_shared<ExodusMetadata>()), notes(warnings) {}

  /// Returns the variable of that name and marks it as understood; null if there is none.
  const Variable* take(const std::string& name);
  /// Returns `count` texts of a table of names; empty texts if the table does not exist.
  std::vector<std::string> take_names(const std::string& name, std::size_t count);
  /// Throws InputError unless the variable has these lengths along its dimensions.
  void require_shape(const Variable& variable, const std::vector<std::size_t>& expected) const;

  /// Adds an array, under a name that no other array has, and returns that name.
  std::string add_array(DataArray array, MeshPart::ArrayRows rows = {});
  /// Adds an array on the elements of `blocks`, none of which is empty; `values` lists the values block by
  /// block. Returns the array's name.
  std::string add_array(std::string name, Values values, const std::vector<std::size_t>& blocks);
  /// Adds a set, under a name that no other set has, and returns that name.
  std::string add_set(EntitySet set, MeshPart::SetRows rows = {});

  [[nodiscard]] bool is_whole() const noexcept { return ranges_wanted == nullptr; }
  /// Returns the range of the vertices or cells that are read.
  [[nodiscard]] MeshRange range(Association association) const {
    return association == Association::vertices ? part.ranges.vertices : part.ranges.cells;
  }
  /// Returns the number of vertices or cells of the whole mesh.
  [[nodiscard]] Index count(Association association) const {
    return association == Association::vertices ? nodes : elements;
  }
  /// Returns which rows to read if a variable has a row for each vertex or cell.
  [[nodiscard]] Rows rows(Association association) const {
    const MeshRange own = range(association);
    return {static_cast<std::size_t>(own.first), static_cast<std::size_t>(own.size())};
  }
  /// Returns the range of those cells of a block that are read.
  [[nodiscard]] MeshRange own_of_block(std::size_t b) const {
    return MeshRange{block_ends[b], block_ends[b + 1]}.common(part.ranges.cells);
  }
  /// Returns which rows to read if a variable has a row for each cell of a block.
  [[nodiscard]] Rows rows_of_block(std::size_t b) const {
    const MeshRange own = own_of_block(b);
    return {static_cast<std::size_t>(own.first - block_ends[b]), static_cast<std::size_t>(own.size())};
  }
  /// Returns the number of a block's cells in the whole mesh.
  [[nodiscard]] std::size_t size_of_block(std::size_t b) const {
    return static_cast<std::size_t>(block_ends[b + 1] - block_ends[b]);
  }
  /// Returns the block of a cell of the whole mesh. O(log blocks).
  [[nodiscard]] const BlockRecord& block_of(Index cell) const;
  /// Returns how many values of a list to read at a time; unlimited if the whole mesh is read.
  [[nodiscard]] std::size_t values_at_once() const noexcept {
    return is_whole() ? std::numeric_limits<std::size_t>::max() : std::size_t{1} << 18;
  }

  NcInput file;
  const MeshRanges* ranges_wanted;
  MeshPart part;
  std::shared_ptr<ExodusMetadata> metadata;
  Notes& notes;
  std::set<std::string> taken;
  Index nodes = 0;                   ///< number of nodes of the whole mesh
  Index elements = 0;                ///< number of elements of the whole mesh
  std::vector<Index> block_ends{0};  ///< block b has the cells block_ends[b] to block_ends[b + 1] − 1

 private:
  UniqueNames arrays_;
  UniqueNames sets_;
};

/// Returns the ids of blocks, sets or maps; 1, 2, … if the file has no ids or gives an id twice.
std::vector<std::int64_t> read_ids(Reading& reading, const std::string& variable, std::size_t objects);

/// Reads the ids, names and properties of blocks or sets. The names of their variables begin with `prefix`.
/// Returns the names of the properties except ID.
template <class Record>
std::vector<std::string> read_records(Reading& reading, const std::string& prefix,
                                      std::vector<Record>& records, bool& has_names) {
  const std::size_t count = records.size();
  const std::vector<std::int64_t> ids = read_ids(reading, prefix + "_prop1", count);
  has_names = reading.file.find(prefix + "_names") != nullptr;
  const std::vector<std::string> names = reading.take_names(prefix + "_names", count);
  (void)reading.take(prefix + "_status");
  for (std::size_t i = 0; i < count; ++i) {
    records[i].id = ids[i];
    records[i].name = names[i];
  }
  std::vector<std::string> properties;
  for (int k = 2;; ++k) {
    const Variable* const variable = reading.take(prefix + "_prop" + std::to_string(k));
    if (variable == nullptr) return properties;
    reading.require_shape(*variable, {count});
    const std::vector<std::int64_t> values = reading.file.integers(*variable);
    for (std::size_t i = 0; i < count; ++i) records[i].properties.push_back(values[i]);
    properties.push_back(reading.file.text(*variable, "name"));
  }
}

/// Reads the sets of nodes, sides and elements, and their variables at all steps.
void read_sets(Reading& reading);

/// Read the variables of nodes and of elements at all steps.
void read_nodal(Reading& reading);
void read_elemental(Reading& reading);

}  // namespace meshorder::exodus
