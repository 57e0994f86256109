// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/unique_names.hpp"

namespace meshorder {

std::string UniqueNames::take(Association association, const std::string& wanted) {
  if (names_.emplace(association, wanted).second) return wanted;
  int& last = last_numbers_.try_emplace({association, wanted}, 1).first->second;
  std::string name;
  do {
    name = wanted + " (" + std::to_string(++last) + ")";
  } while (!names_.emplace(association, name).second);
  return name;
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
