// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/abaqus/sets.hpp"

#include "base/text.hpp"
#include "io/deck/numbers.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/scanner.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

namespace meshorder::abaqus {

std::string_view name_of_sets(Association association) {
  return association == Association::vertices ? "node set" : "element set";
}

std::string note_of_missing(std::string_view which, const std::vector<std::int64_t>& numbers) {
  return fmt::format("{} {} that the deck does not have, the first is {}", which,
                     numbers.size() == 1 ? "one number" : fmt::format("{} numbers", numbers.size()),
                     numbers.front());
}

/// Drops repeated members of sets of vertices or cells before they take much memory.
class SetReader::Repeats {
 public:
  /// @param items  vertices or cells of the mesh
  explicit Repeats(Index items) : last_turn_(static_cast<std::size_t>(items), 0) {}

  /// Appends members; repeated ones may stay until the next `drop`. Amortised O(members).
  void append(EntitySet& set, std::span<const Index> members) {
    set.members.insert(set.members.end(), members.begin(), members.end());
    if (set.members.size() > 2 * last_turn_.size()) drop(set);
  }

  /// Removes repeated members; the first of each stays. O(members).
  void drop(EntitySet& set) {
    ++turn_;
    std::erase_if(set.members,
                  [&](Index member) { return std::exchange(last_turn_[member], turn_) == turn_; });
  }

 private:
  Index turn_ = 0;
  /// For each item, the number (from 1) of the last call of `drop` that saw it.
  std::vector<Index> last_turn_;
};

std::size_t SetReader::set_named(Association association, std::string_view name) {
  const auto [found, is_new] =
      places_.try_emplace(Key{association, in_assembly_, upper_case(name)}, sets_.size());
  if (is_new) {
    const bool also_of_part = in_assembly_ && places_.contains(Key{association, false, upper_case(name)});
    sets_.push_back({(also_of_part ? "Assembly." : "") + std::string(name), association, {}});
  }
  return found->second;
}

const EntitySet* SetReader::find(Association association, bool in_assembly, std::string_view name) const {
  const auto at = [&](bool of_assembly, std::string_view key) -> const EntitySet* {
    const auto found = places_.find(Key{association, of_assembly, upper_case(key)});
    return found == places_.end() ? nullptr : &sets_[found->second];
  };
  if (in_assembly) {
    if (const EntitySet* const set = at(true, name)) return set;
  }
  if (const EntitySet* const set = at(false, name)) return set;
  const std::size_t dot = name.find('.');  // "PART-1-1.SET"
  return dot == std::string_view::npos ? nullptr : at(false, name.substr(dot + 1));
}

bool SetReader::knows(Association association, std::string_view name) const {
  const auto is_key = [&](std::string_view key) {
    return places_.contains(Key{association, false, upper_case(key)}) ||
           places_.contains(Key{association, true, upper_case(key)});
  };
  return is_key(name) || is_key(name.substr(name.find('.') + 1));  // the whole name if there is no dot
}

void SetReader::add_block(Association association, std::string_view name, Index first, Index count) {
  additions_.push_back(
      {.set = set_named(association, name), .association = association, .first = first, .count = count});
}

void SetReader::begin_card(Association association, const Card& card, Location place) {
  Addition& addition = additions_.emplace_back();
  addition.association = association;
  addition.set = set_named(association, card.value(association == Association::vertices ? "NSET" : "ELSET"));
  addition.in_assembly = in_assembly_ && !card.has("INSTANCE");
  addition.place = std::move(place);
  addition.generate = card.has("GENERATE");
  if (association == Association::vertices) addition.nodes_of = card.value("ELSET");
}

std::string SetReader::add_line(std::string_view line) {
  Addition& addition = additions_.back();
  if (addition.generate) {
    std::array<std::int64_t, 3> range{0, 0, 1};
    std::size_t given = 0;
    while (!line.empty()) {
      const std::string_view field = next_field(line);
      if (field.empty() && line.empty()) break;
      const std::int64_t number = number_of(field);
      if (number == 0 || given == 3) return "a line of GENERATE has first, last and step";
      range[given++] = number;
    }
    if (given == 1) range[1] = range[0];
    if (given == 0) return {};
    if (range[1] < range[0]) return fmt::format("the range {} to {} is empty", range[0], range[1]);
    addition.ranges.push_back(range);
    return {};
  }
  while (!line.empty()) {
    const std::string_view field = next_field(line);
    if (field.empty()) continue;
    const std::int64_t number = number_of(field);
    if (number > kMaxIndex) return fmt::format("the number {} is too large", number);
    if (number > 0) {
      addition.numbers.push_back(static_cast<Index>(number));
    } else {
      addition.names.emplace_back(without_quotes(field));
    }
  }
  return {};
}

void SetReader::add_members(const Addition& addition, Repeats& repeats, Notes& notes) {
  const bool of_nodes = addition.association == Association::vertices;
  const IdMap& items = of_nodes ? deck_.nodes : deck_.elements;
  const auto claim = [&](std::size_t count) {
    claim_memory(count * sizeof(Index), "the set", addition.place);
  };
  if (addition.count > 0) claim(static_cast<std::size_t>(addition.count));
  std::vector<Index> members = index_range(addition.first, addition.count);
  std::vector<std::int64_t> missing;
  for (const Index number : addition.numbers) {
    const Index item = items.find(number);
    if (item >= 0) {
      members.push_back(item);
    } else if (of_nodes || !others_.contains(number)) {
      missing.push_back(number);
    }
  }
  EntitySet& set = sets_[addition.set];
  repeats.append(set, members);
  for (const auto& [from, to, step] : addition.ranges)
    repeats.append(set, items_in_range(items, from, to, step));
  std::vector<std::string> unknown;
  for (const std::string& name : addition.names) {
    if (const EntitySet* const named = find(addition.association, addition.in_assembly, name)) {
      claim(named->members.size());
      members = named->members;  // a set may name itself
      repeats.append(set, members);
    } else {
      unknown.push_back(name);
    }
  }
  if (!addition.nodes_of.empty()) {
    if (const EntitySet* const of_cells = find(Association::cells, addition.in_assembly, addition.nodes_of)) {
      for (const Index c : of_cells->members) {
        claim(cells_[c].size());
        repeats.append(set, cells_[c]);
      }
    } else {
      unknown.push_back(addition.nodes_of);
    }
  }

  const std::string which = fmt::format("{}:{}: the {} '{}' names", addition.place.file, addition.place.line,
                                        name_of_sets(addition.association), set.name);
  if (!missing.empty()) notes.push_back(note_of_missing(which, missing));
  for (const std::string& name : unknown) {
    notes.push_back(fmt::format("{} the set '{}', which does not exist before it", which, shown(name)));
  }
}

std::vector<EntitySet> SetReader::members(Notes& notes) {
  Repeats of_vertices(deck_.nodes.size());
  Repeats of_cells(deck_.elements.size());
  const auto repeats = [&](Association association) -> Repeats& {
    return association == Association::vertices ? of_vertices : of_cells;
  };
  for (const Addition& addition : additions_) add_members(addition, repeats(addition.association), notes);
  for (EntitySet& set : sets_) repeats(set.association).drop(set);
  additions_.clear();
  return std::move(sets_);
}

}  // namespace meshorder::abaqus
