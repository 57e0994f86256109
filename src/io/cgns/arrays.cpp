// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/reading.hpp"
#include "io/names.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

// Makes arrays from the values of nodes. Values of the same name and type for different vertices or cells
// become one array.

namespace meshorder::cgns {
namespace {

/// Pieces of one name.
using Group = std::vector<Piece*>;

class ArrayMaker {
 public:
  explicit ArrayMaker(Reading& reading) : reading_(reading) {
    for (const DataArray& array : reading_.mesh.data) names_.insert({array.association, array.name});
  }

  void make() {
    std::map<std::pair<Association, std::string>, std::size_t> places;
    std::vector<Group> groups;
    for (Piece& piece : reading_.pieces) {
      const auto [place, is_new] =
          places.emplace(std::pair{field_of(piece).association, piece.name}, groups.size());
      if (is_new) groups.emplace_back();
      groups[place->second].push_back(&piece);
    }
    for (const Group& group : groups) make_of(group, 0);
  }

 private:
  [[nodiscard]] const Field& field_of(const Piece& piece) const {
    return reading_.metadata->fields[piece.field];
  }

  /// Returns whether the pieces have values of one type, and no vertex or cell has two values.
  [[nodiscard]] bool fit_together(const Group& group) const {
    std::vector<bool> taken(item_count(reading_.mesh, field_of(*group.front()).association));
    for (const Piece* const piece : group) {
      if (piece->values.index() != group.front()->values.index()) return false;
      for (const Index row : reading_.rows_of(field_of(*piece))) {
        if (taken[row]) return false;
        taken[row] = true;
      }
    }
    return true;
  }

  /// Makes one array of a group if its pieces fit together, else splits the group: by solution at level 0, by
  /// node at level 1.
  void make_of(const Group& group, int level) {
    const Piece& first = *group.front();
    if (group.size() == 1 || fit_together(group)) {
      const std::string zone = reading_.metadata->zones[field_of(first).place].name;
      const std::string before = level == 0   ? ""
                                 : level == 1 ? first.solution + "."
                                              : zone + "." + first.solution + ".";
      return add(group, before + first.name);
    }
    std::map<std::string, Group> parts;
    std::vector<std::string> order;
    for (Piece* const piece : group) {
      const std::string key = level == 0 ? piece->solution : std::to_string(piece->field);
      if (!parts.contains(key)) order.push_back(key);
      parts[key].push_back(piece);
    }
    for (const std::string& key : order) make_of(parts[key], level + 1);
  }

  void add(const Group& group, const std::string& wanted) {
    const Association association = field_of(*group.front()).association;
    const std::string name = numbers_[association].free_name(
        wanted, [&](int k) { return fmt::format("{} {}", wanted, k); },
        [&](const std::string& free) {
          return names_.insert({association, free}).second;
        });
    DataArray array{.name = name, .association = association};
    for (const Piece* const piece : group) {
      reading_.metadata->fields[piece->field].array = name;
      const std::vector<Index> rows = reading_.rows_of(field_of(*piece));
      array.indices.insert(array.indices.end(), rows.begin(), rows.end());
    }
    if (group.size() == 1 && !fit_together(group)) {
      reading_.fail("", "the solution '" + group.front()->solution + "' lists a vertex or cell twice",
                    "each may have one value");
    }
    array.values = std::move(group.front()->values);
    for (std::size_t p = 1; p < group.size(); ++p)
      append_values(array.values, std::exchange(group[p]->values, {}));
    make_dense(array, item_count(reading_.mesh, association));
    reading_.mesh.data.push_back(std::move(array));
  }

  Reading& reading_;
  std::set<std::pair<Association, std::string>> names_;
  std::map<Association, NameNumbers> numbers_;
};

}  // namespace

void add_arrays(Reading& reading) { ArrayMaker(reading).make(); }

}  // namespace meshorder::cgns
