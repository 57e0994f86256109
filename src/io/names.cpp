// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/names.hpp"

#include "base/text.hpp"
#include "io/mesh_part.hpp"

#include <fmt/format.h>

#include <algorithm>

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

std::vector<Index> unique_members(const std::vector<Index>& members) {
  std::vector<Index> sorted = members;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) return members;
  std::set<Index> seen;
  std::vector<Index> result;
  for (const Index member : members) {
    if (seen.insert(member).second) result.push_back(member);
  }
  return result;
}

void drop_repeated(EntitySet& set, Notes& notes) {
  const std::size_t before = set.members.size();
  set.members = unique_members(set.members);
  const std::size_t repeated = before - set.members.size();
  if (repeated > 0) notes.push_back(note_of_repeated("the set '" + set.name + "'", repeated));
}

std::string plain_name(std::string_view name, std::string_view forbidden) {
  constexpr unsigned char kDelete = 0x7F;
  std::string result(name);
  std::replace_if(
      result.begin(), result.end(),
      [forbidden](char c) {
        const auto code = static_cast<unsigned char>(c);
        return code < ' ' || code == kDelete || forbidden.find(c) != std::string_view::npos;
      },
      '_');
  return result;
}

std::string DistinctNames::take(std::string_view wanted) {
  std::string name(utf8_prefix(wanted, longest_));
  if (taken_.insert(name).second) return name;
  int& last = last_numbers_.try_emplace(std::string(wanted), 1).first->second;
  do {
    const std::string end = fmt::format("_{}", ++last);
    name = std::string(utf8_prefix(wanted, longest_ - end.size())) + end;
  } while (!taken_.insert(name).second);
  return name;
}

void note_renamed_set(const EntitySet& set, std::string_view name, Notes& notes) {
  if (name != set.name) notes.push_back(fmt::format("the set '{}' is written as '{}'", set.name, name));
}

void note_renamed_array(const DataArray& array, std::string_view name, Notes& notes) {
  if (name == array.name) return;
  notes.push_back(
      fmt::format("the array '{}' on {} is written as '{}'", array.name, to_string(array.association), name));
}

}  // namespace meshorder
