// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <map>
#include <string_view>
#include <utility>

namespace meshorder {

/// Finds the arrays and sets of a mesh by name, for writers that look up many. An object is valid until the
/// mesh's arrays or sets change.
class NamedParts {
 public:
  /// O(n · log n) for n arrays and sets.
  explicit NamedParts(const Mesh& mesh) {
    for (const DataArray& array : mesh.data) arrays_.try_emplace({array.association, array.name}, &array);
    for (const EntitySet& set : mesh.sets) sets_.try_emplace({set.association, set.name}, &set);
  }

  /// Returns the first array of that name, or null. O(log arrays).
  [[nodiscard]] const DataArray* array(std::string_view name, Association association) const {
    const auto found = arrays_.find({association, name});
    return found == arrays_.end() ? nullptr : found->second;
  }

  /// Returns the first set of that name, or null. O(log sets).
  [[nodiscard]] const EntitySet* set(std::string_view name, Association association) const {
    const auto found = sets_.find({association, name});
    return found == sets_.end() ? nullptr : found->second;
  }

 private:
  using Name = std::pair<Association, std::string_view>;
  std::map<Name, const DataArray*> arrays_;
  std::map<Name, const EntitySet*> sets_;
};

}  // namespace meshorder
