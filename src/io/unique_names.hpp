// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <map>
#include <set>
#include <string>
#include <utility>

namespace meshorder {

/// Gives arrays, or sets, names that no other of their association has.
class UniqueNames {
 public:
  /// Returns the wanted name, or "NAME (2)", "NAME (3)" and so on where it is taken. O(log names), also where
  /// all want the same name.
  std::string take(Association association, const std::string& wanted);

  [[nodiscard]] bool has(Association association, const std::string& name) const {
    return names_.contains({association, name});
  }

 private:
  using Name = std::pair<Association, std::string>;
  std::set<Name> names_;
  std::map<Name, int> last_numbers_;
};

/// Adds an array to a mesh under a name that no other has; returns that name.
std::string add_named(Mesh& mesh, DataArray array, UniqueNames& names);
/// Adds a set likewise.
std::string add_named(Mesh& mesh, EntitySet set, UniqueNames& names);

}  // namespace meshorder
