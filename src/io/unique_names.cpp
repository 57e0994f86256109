// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/unique_names.hpp"

namespace meshorder {

std::string UniqueNames::take(Association association, const std::string& wanted) {
  return numbers_[association].free_name(
      wanted, [&](int k) { return wanted + " (" + std::to_string(k) + ")"; },
      [&](const std::string& name) { return names_.emplace(association, name).second; });
}

std::string add_named(Mesh& mesh, DataArray array, UniqueNames& names) {
  array.name = names.take(array.association, array.name);
  mesh.data.push_back(std::move(array));
  return mesh.data.back().name;
}

std::string add_named(Mesh& mesh, EntitySet set, UniqueNames& names) {
  set.name = names.take(set.association, set.name);
  mesh.sets.push_back(std::move(set));
  return mesh.sets.back().name;
}

}  // namespace meshorder
