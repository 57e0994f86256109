// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <utility>

namespace meshorder {

/// Gives arrays or sets names that differ on vertices and on cells.
class UnusedNames {
 public:
  /// Returns the name, or "NAME (2)", "NAME (3)" … where it is in use, and takes it into use.
  /// O(log names), also where all want the same name.
  std::string use(Association association, const std::string& wanted) {
    if (in_use_.emplace(association, wanted).second) return wanted;
    int& last = last_numbers_.try_emplace({association, wanted}, 1).first->second;
    std::string name;
    do {
      name = fmt::format("{} ({})", wanted, ++last);
    } while (!in_use_.emplace(association, name).second);
    return name;
  }

  [[nodiscard]] bool has(Association association, const std::string& name) const {
    return in_use_.contains({association, name});
  }

 private:
  using Name = std::pair<Association, std::string>;
  std::set<Name> in_use_;
  std::map<Name, int> last_numbers_;
};

}  // namespace meshorder
