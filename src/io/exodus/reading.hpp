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

/// A file that is being read, completely or in part, and the results so far.
struct Reading {
  /// @param wanted  the ranges to read; null: the whole mesh. Must outlive this object
  Reading(const FilePath& path, const MeshRanges* wanted, Notes& warnings)
      : file(path), ranges_wanted(wanted), metadata(std::make_shared<ExodusMetadata>()), notes(warnings) {}

  /// Returns the variable of that name, null if there is none, and marks it as understood.
  const Variable* take(const std::string& name);
  /// Returns `count` texts of a table of names; empty texts if the table does not exist.
  std::vector<std::string> take_names(const std::string& name, std::size_t count);
  /// Throws InputError unless the variable has these lengths along its dimensions.
  void require_shape(const Variable& variable, const std::vector<std::size_t>& expected) const;

  /// Adds an array, under a name that no other array has, and returns that name.
  std::string add_array(DataArray array, MeshPart::ArrayRows rows = {});
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
  /// Returns the range of a block's cells that are read.
  [[nodiscard]] MeshRange own_of_block(std::size_t b) const {
    return MeshRange{block_ends[b], block_ends[b + 1]}.common(part.ranges.cells);
  }
  /// Returns the block of a cell of the whole mesh. O(log blocks).
  [[nodiscard]] const BlockRecord& block_of(Index cell) const;
  /// Returns the largest number of values of a list to read at a time; unlimited if the whole mesh is read.
  [[nodiscard]] std::size_t values_at_once() const noexcept {
    return is_whole() ? std::numeric_limits<std::size_t>::max() : std::size_t{1} << 18;
  }

  NcInput file;
  const MeshRanges* ranges_wanted;
  MeshPart part;
  std::shared_ptr<ExodusMetadata> metadata;
  Notes& notes;
  std::set<std::string> taken;
  Index nodes = 0;                   ///< of the whole mesh
  Index elements = 0;                ///< of the whole mesh
  std::vector<Index> block_ends{0};  ///< block b has the cells block_ends[b] to block_ends[b + 1] − 1

 private:
  UniqueNames arrays_;
  UniqueNames sets_;
};

/// Returns the names of the properties except ID, and calls `put(object, value)` for each of their values.
template <class Put>
std::vector<std::string> read_properties(Reading& reading, const std::string& prefix, std::size_t objects,
                                         Put put) {
  std::vector<std::string> names;
  for (int k = 2;; ++k) {
    const Variable* const variable = reading.take(prefix + "_prop" + std::to_string(k));
    if (variable == nullptr) return names;
    reading.require_shape(*variable, {objects});
    const std::vector<std::int64_t> values = reading.file.integers(*variable);
    for (std::size_t object = 0; object < objects; ++object) put(object, values[object]);
    names.push_back(reading.file.text(*variable, "name"));
  }
}

/// Returns the ids of blocks, sets or maps; 1, 2, … if the file has no ids or gives an id twice.
std::vector<std::int64_t> read_ids(Reading& reading, const std::string& variable, std::size_t objects);

/// Return the start and the number of values of a range, for reading a variable of one dimension.
inline std::vector<std::size_t> start_of(MeshRange range) { return {static_cast<std::size_t>(range.first)}; }
inline std::vector<std::size_t> count_of(MeshRange range) { return {static_cast<std::size_t>(range.size())}; }

/// Reads the sets of nodes, sides and elements.
void read_sets(Reading& reading);

/// Reads the variables of nodes, elements and sets at all steps.
void read_variables(Reading& reading);

}  // namespace meshorder::exodus
