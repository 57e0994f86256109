// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/exodus/exodus.hpp"
#include "io/unique_names.hpp"

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace meshorder::exodus {

/// A file that is being read, and what has been found so far.
struct Reading {
  Reading(const FilePath& path, Notes& warnings)
      : file(path), metadata(std::make_shared<Metadata>()), notes(warnings) {}

  /// Returns the variable of that name, which is understood with that; null if there is none.
  const Variable* take(const std::string& name);
  /// Returns the texts of a table of names, empty ones where it is not there.
  std::vector<std::string> take_names(const std::string& name, std::size_t count);
  /// Throws InputError unless the variable has these lengths along its dimensions.
  void require_shape(const Variable& variable, const std::vector<std::size_t>& expected) const;

  /// Adds an array, under a name that no other array has, and returns that name.
  std::string add_array(DataArray array);
  /// Adds a set likewise.
  std::string add_set(EntitySet set);

  NcInput file;
  Mesh mesh;
  std::shared_ptr<Metadata> metadata;
  Notes& notes;
  std::set<std::string> taken;
  std::vector<Index> block_ends;  ///< blocks + 1: block b has the cells from entry b to entry b + 1

 private:
  UniqueNames arrays_;
  UniqueNames sets_;
};

/// Returns the names of properties besides the ids, and gives each object's values to `put(object, value)`.
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

/// Returns the ids of blocks, sets or maps; 1, 2, … where the file has none or gives one twice.
std::vector<std::int64_t> read_ids(Reading& reading, const std::string& variable, std::size_t objects);

/// Reads the sets of nodes, sides and elements.
void read_sets(Reading& reading);

/// Reads the variables of nodes, elements and sets at all steps.
void read_variables(Reading& reading);

}  // namespace meshorder::exodus
