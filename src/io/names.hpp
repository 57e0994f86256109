// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace meshorder {

// Names of arrays and sets as a format can hold them.

/// Returns the name with "_" in place of control characters and of those in `forbidden`. O(size).
std::string plain_name(std::string_view name, std::string_view forbidden = {});

/// Names that are unique in a file.
class DistinctNames {
 public:
  /// `longest`: most bytes of a name, at least 12. Names are cut between characters of UTF-8.
  explicit DistinctNames(std::size_t longest = std::string::npos) : longest_(longest) {}

  /// Takes and returns a free name: the wanted one, cut to the longest size, with a number at its end if it
  /// is taken. O(log names), also if all want the same name.
  std::string take(std::string_view wanted);

 private:
  std::size_t longest_;
  std::set<std::string> taken_;
  std::map<std::string, int> last_numbers_;  // by the wanted name
};

/// Notes "the set 'a b' is written as 'a_b'" if the names differ.
void note_renamed_set(const EntitySet& set, std::string_view name, Notes& notes);

/// Notes "the array 'a b' on cells is written as 'a_b'" if the names differ.
void note_renamed_array(const DataArray& array, std::string_view name, Notes& notes);

}  // namespace meshorder
