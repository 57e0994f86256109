// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace meshorder {

/// Finds free names: adds a number to a wanted name that is taken.
class NameNumbers {
 public:
  /// Takes and returns the first of `wanted`, `numbered(2)`, `numbered(3)` … that is free.
  ///
  /// @param take  takes a name if it is free, and returns whether it was
  /// @note O(log names) and the cost of `take`, even if all calls want the same name.
  template <class Numbered, class Take>
  std::string free_name(const std::string& wanted, Numbered numbered, Take take) {
    if (take(wanted)) return wanted;
    int& last = last_.try_emplace(wanted, 1).first->second;
    for (;;) {
      std::string name = numbered(++last);
      if (take(name)) return name;
    }
  }

 private:
  std::map<std::string, int> last_;  // last number given, for each wanted name
};

/// Gives arrays or sets names that are unique among those on vertices and among those on cells.
class UniqueNames {
 public:
  /// Returns the wanted name or, if it is taken, "NAME (2)", "NAME (3)" and so on. O(log names), even if all
  /// calls want the same name.
  std::string take(Association association, const std::string& wanted);

  [[nodiscard]] bool has(Association association, const std::string& name) const {
    return names_.contains({association, name});
  }

 private:
  using Name = std::pair<Association, std::string>;
  std::set<Name> names_;
  std::map<Association, NameNumbers> numbers_;
};

/// Adds an array to a mesh under a name that no other array has; returns that name.
std::string add_named(Mesh& mesh, DataArray array, UniqueNames& names);
/// Adds a set to a mesh under a name that no other set has; returns that name.
std::string add_named(Mesh& mesh, EntitySet set, UniqueNames& names);

/// Returns the members in their order, each once. O(members · log members).
std::vector<Index> unique_members(const std::vector<Index>& members);
/// Removes the members of a set that come again, and notes their number.
void drop_repeated(EntitySet& set, Notes& notes);

// The functions and the class below make names that a format can hold.

/// Returns the name with "_" in place of control characters and of the characters in `forbidden`. O(size).
std::string plain_name(std::string_view name, std::string_view forbidden = {});

/// Gives names that are unique in a file.
class DistinctNames {
 public:
  /// `longest`: maximum size of a name in bytes, at least 12. Names are cut between characters of UTF-8.
  explicit DistinctNames(std::size_t longest = std::string::npos) : longest_(longest) {}

  /// Takes and returns a free name: `wanted`, cut to the maximum size; if this name is taken, the returned
  /// name ends with a number. O(log names), even if all calls want the same name.
  std::string take(std::string_view wanted);

 private:
  std::size_t longest_;
  std::set<std::string> taken_;
  std::map<std::string, int> last_numbers_;  // last number given, for each wanted name
};

/// Notes "the set 'a b' is written as 'a_b'" if the names differ.
void note_renamed_set(const EntitySet& set, std::string_view name, Notes& notes);

/// Notes "the array 'a b' on cells is written as 'a_b'" if the names differ.
void note_renamed_array(const DataArray& array, std::string_view name, Notes& notes);

}  // namespace meshorder
