// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "grouped_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

/// A note without its first quoted name, and that name with its quotes; "" if there is none.
struct Parts {
  std::pair<std::string, std::string> around;
  std::string name;
};

Parts parts_of(const std::string& note) {
  const std::size_t begin = note.find(" '");
  const std::size_t end = begin == std::string::npos ? begin : note.find("' ", begin + 2);
  if (end == std::string::npos) return {{note, ""}, ""};
  return {{note.substr(0, begin + 1), note.substr(end + 1)}, note.substr(begin + 1, end - begin)};
}

/// Returns whether the note is on a set that Gmsh's reader made of periodic nodes. Another note, on pairs of
/// periodic entities, reports the loss of these.
bool is_on_periodic_nodes(const std::string& note) { return note.starts_with("the set 'gmsh:periodic "); }

std::string likewise(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 3;
  std::string words;
  const std::size_t shown = names.size() <= kShown ? names.size() : kShown - 1;
  for (std::size_t i = 0; i < shown; ++i) words += (i == 0 ? "" : ", ") + names[i];
  if (shown < names.size()) words += fmt::format(" and {} more", names.size() - shown);
  return words;
}

}  // namespace

Notes grouped_by_name(const Notes& notes) {
  struct Group {
    std::string first;
    std::vector<std::string> others;  ///< names
  };
  std::vector<Group> groups;
  std::map<std::pair<std::string, std::string>, std::size_t> place;
  const bool pairs_are_noted = std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("periodic entities") != std::string::npos;
  });
  for (const std::string& note : notes) {
    if (pairs_are_noted && is_on_periodic_nodes(note)) continue;
    const Parts parts = parts_of(note);
    const auto [found, is_new] = place.try_emplace(parts.around, groups.size());
    if (is_new) {
      groups.push_back({note, {}});
    } else if (!parts.name.empty()) {
      groups[found->second].others.push_back(parts.name);
    }
  }
  Notes result;
  result.reserve(groups.size());
  for (const Group& group : groups)
    result.push_back(group.others.empty()
                         ? group.first
                         : fmt::format("{} (likewise {})", group.first, likewise(group.others)));
  return result;
}

}  // namespace meshorder::command
