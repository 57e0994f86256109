// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/abaqus/sets.hpp"

#include "io/deck/numbers.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshorder::abaqus {
namespace {

/// Removes all but the first of members that are given several times. `last_set` has for each item the last
/// set, counted from 1, that it was seen in.
void keep_first(EntitySet& set, Index number, std::vector<Index>& last_set) {
  std::erase_if(set.members, [&](Index member) { return std::exchange(last_set[member], number) == number; });
}

std::string_view name_of_sets(Association association) {
  return association == Association::vertices ? "node set" : "element set";
}

}  // namespace

std::size_t SetReader::set_named(Association association, std::string_view name) {
  const auto [found, is_new] =
      places_.try_emplace(Key{association, in_assembly_, capitals(name)}, sets_.size());
  if (is_new) {
    const bool also_of_part = in_assembly_ && places_.contains(Key{association, false, capitals(name)});
    sets_.push_back({(also_of_part ? "Assembly." : "") + std::string(name), association, {}});
  }
  return found->second;
}

const EntitySet* SetReader::find(Association association, const Addition& from, std::string_view name) const {
  const auto at = [&](bool of_assembly, std::string_view key) -> const EntitySet* {
    const auto found = places_.find(Key{association, of_assembly, capitals(key)});
    return found == places_.end() ? nullptr : &sets_[found->second];
  };
  if (from.in_assembly && !from.of_instance) {
    if (const EntitySet* const set = at(true, name)) return set;
  }
  if (const EntitySet* const set = at(false, name)) return set;
  const std::size_t dot = name.find('.');  // "PART-1-1.SET"
  return dot == std::string_view::npos ? nullptr : at(false, name.substr(dot + 1));
}

void SetReader::add_block(Association association, std::string_view name, Index first, Index count) {
  Addition& addition = additions_.emplace_back();
  addition.set = set_named(association, name);
  addition.association = association;
  addition.first = first;
  addition.count = count;
}

void SetReader::begin_card(Association association, const Card& card, Place place) {
  Addition& addition = additions_.emplace_back();
  addition.association = association;
  addition.set = set_named(association, card.value(association == Association::vertices ? "NSET" : "ELSET"));
  addition.in_assembly = in_assembly_;
  addition.of_instance = card.has("INSTANCE");
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
      const bool quoted = field.size() > 1 && field.front() == '"' && field.back() == '"';
      addition.names.emplace_back(quoted ? field.substr(1, field.size() - 2) : field);
    }
  }
  return {};
}

void SetReader::add_members(const Addition& addition, const IdMap& items,
                            const std::unordered_set<std::int64_t>& others, const Cells& cells,
                            Notes& notes) {
  const auto claim = [&](std::size_t count) {
    claim_memory(count * sizeof(Index), "the set", {addition.place.file, addition.place.line});
  };
  if (addition.count > 0) claim(static_cast<std::size_t>(addition.count));
  std::vector<Index> members(static_cast<std::size_t>(addition.count));
  std::iota(members.begin(), members.end(), addition.first);
  std::int64_t missing = 0;
  Index first_missing = 0;
  for (const Index number : addition.numbers) {
    const Index item = items.find(number);
    if (item >= 0) {
      members.push_back(item);
    } else if (!others.contains(number) && missing++ == 0) {
      first_missing = number;
    }
  }
  for (const auto& [from, to, step] : addition.ranges) {
    const std::vector<Index> found = items_in_range(items, from, to, step);
    members.insert(members.end(), found.begin(), found.end());
  }
  std::vector<std::string> unknown;
  for (const std::string& name : addition.names) {
    if (const EntitySet* const set = find(addition.association, addition, name)) {
      claim(set->members.size());
      members.insert(members.end(), set->members.begin(), set->members.end());
    } else {
      unknown.push_back(name);
    }
  }
  if (!addition.nodes_of.empty()) {
    if (const EntitySet* const set = find(Association::cells, addition, addition.nodes_of)) {
      for (const Index c : set->members) {
        const auto cell = cells[c];
        claim(cell.size());
        members.insert(members.end(), cell.begin(), cell.end());
      }
    } else {
      unknown.push_back(addition.nodes_of);
    }
  }
  EntitySet& set = sets_[addition.set];
  set.members.insert(set.members.end(), members.begin(), members.end());

  const std::string which = fmt::format("{}:{}: the {} '{}' names", addition.place.file, addition.place.line,
                                        name_of_sets(addition.association), set.name);
  if (missing > 0) {
    notes.push_back(fmt::format("{} {} that the deck does not have, the first is {}", which,
                                missing == 1 ? "one number" : fmt::format("{} numbers", missing),
                                first_missing));
  }
  for (const std::string& name : unknown) {
    notes.push_back(fmt::format("{} the set '{}', which does not exist before it", which, shown(name)));
  }
}

std::vector<EntitySet> SetReader::members(const IdMap& nodes, const IdMap& elements,
                                          const std::unordered_set<std::int64_t>& others, const Cells& cells,
                                          Notes& notes) {
  const std::unordered_set<std::int64_t> none;
  for (const Addition& addition : additions_) {
    const bool of_nodes = addition.association == Association::vertices;
    add_members(addition, of_nodes ? nodes : elements, of_nodes ? none : others, cells, notes);
  }
  std::vector<Index> of_vertices(static_cast<std::size_t>(nodes.size()), 0);
  std::vector<Index> of_cells(static_cast<std::size_t>(elements.size()), 0);
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    keep_first(sets_[i], static_cast<Index>(i) + 1,
               sets_[i].association == Association::vertices ? of_vertices : of_cells);
  }
  additions_.clear();
  return std::move(sets_);
}

}  // namespace meshorder::abaqus
