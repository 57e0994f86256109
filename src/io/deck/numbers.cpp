// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/deck/numbers.hpp"

#include "base/text.hpp"
#include "io/named_parts.hpp"
#include "io/stream/read_limits.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace meshorder {

bool move_places(std::vector<Index>& places, std::span<const Index> moves) {
  if (moves.empty()) return true;
  if (places.empty()) {
    places.assign(moves.begin(), moves.end());
  } else {
    for (Index& place : places) place = moves[static_cast<std::size_t>(place)];
  }
  return std::none_of(places.begin(), places.end(), [](Index place) { return place < 0; });
}

bool can_be_numbers(std::span<const std::int64_t> ids, std::int64_t largest, std::int64_t smallest) {
  if (ids.empty()) return false;
  const auto [least, greatest] = std::minmax_element(ids.begin(), ids.end());
  if (*least < smallest || *greatest > largest) return false;
  // ids are dense if their range has at most this many numbers for each id
  constexpr std::uint64_t kDense = 8;
  const std::uint64_t range = static_cast<std::uint64_t>(*greatest) - static_cast<std::uint64_t>(*least);
  if (range / kDense >= ids.size()) {
    std::vector<std::int64_t> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  }
  std::vector<bool> is_taken(range + 1);
  return std::none_of(ids.begin(), ids.end(), [&, least = *least](std::int64_t id) {
    auto taken = is_taken[static_cast<std::size_t>(id - least)];
    const bool was_taken = taken;
    taken = true;
    return was_taken;
  });
}

std::vector<Index> items_in_range(const IdMap& items, std::int64_t from, std::int64_t to, std::int64_t step) {
  std::vector<Index> found;
  if (to < from) return found;
  // unsigned arithmetic: the difference of distant numbers may exceed the signed range
  const auto distance = [from](std::int64_t number) {
    return static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(from);
  };
  const auto width = static_cast<std::uint64_t>(step);
  const std::uint64_t steps = distance(to) / width;
  const auto count = static_cast<std::uint64_t>(items.size());
  claim_memory((steps < count ? steps + 1 : count) * sizeof(Index), "a range of numbers");
  if (steps < count) {
    for (std::uint64_t k = 0; k <= steps; ++k) {
      const auto number = static_cast<std::int64_t>(static_cast<std::uint64_t>(from) + k * width);
      if (const Index item = items.find(number); item >= 0) found.push_back(item);
    }
    return found;
  }
  for (Index item = 0; item < items.size(); ++item) {
    const std::int64_t number = items.id(item);
    if (number >= from && number <= to && distance(number) % width == 0) found.push_back(item);
  }
  std::sort(found.begin(), found.end(), [&](Index a, Index b) { return items.id(a) < items.id(b); });
  return found;
}

namespace {

/// Returns whether a set of the mesh has the same members as in the deck, in any order.
bool is_as_in_deck(const EntitySet& set, const EntitySet& of_deck, const FileNumbers& numbers) {
  if (set.members.size() != of_deck.members.size()) return false;
  std::vector<Index> members = set.members;
  std::vector<Index> wanted = of_deck.members;
  for (Index& member : wanted) member = numbers.place(member);
  std::sort(members.begin(), members.end());
  std::sort(wanted.begin(), wanted.end());
  return members == wanted;
}

/// Throws InputError unless the numbers in the mesh are valid (see `keep_numbers`). `item` is "vertex" or
/// "cell".
void require_valid(const FileNumbers& numbers, std::string_view item, std::int64_t largest,
                   const FilePath& path) {
  const Index count = numbers.of_file().size();
  std::int64_t smallest = 1;
  std::vector<std::int64_t> ids;
  ids.reserve(static_cast<std::size_t>(count));
  for (Index k = 0; k < count; ++k) {
    smallest = std::min(smallest, numbers.of_file().id(k));
    largest = std::max(largest, numbers.of_file().id(k));
    ids.push_back(numbers.at(numbers.place(k)));
  }
  if (ids.empty() || can_be_numbers(ids, largest, smallest)) return;
  std::vector<std::pair<std::int64_t, Index>> given;  // number and position in the mesh
  given.reserve(ids.size());
  for (Index k = 0; k < count; ++k) given.emplace_back(ids[k], numbers.place(k));
  std::sort(given.begin(), given.end());
  const std::string remedy = fmt::format("ids are {} to {} and differ from each other", smallest, largest);
  for (const auto& [number, place] : {given.front(), given.back()}) {
    if (number >= smallest && number <= largest) continue;
    throw InputError(path.string(), fmt::format("the id of {} {} is {}", item, place, number), remedy);
  }
  const auto same = std::adjacent_find(given.begin(), given.end(),
                                       [](const auto& a, const auto& b) { return a.first == b.first; });
  throw InputError(path.string(),
                   fmt::format("the id {} is that of {} {} and of {} {}", same->first, item, same->second,
                               item, (same + 1)->second),
                   remedy);
}

}  // namespace

std::vector<EntitySet> sets_beside(const std::vector<EntitySet>& of_deck, const Mesh& mesh,
                                   const DeckNumbers& numbers, Notes& notes) {
  std::set<std::pair<Association, std::string_view>> in_deck;
  for (const EntitySet& set : of_deck) in_deck.emplace(set.association, set.name);
  std::vector<EntitySet> added;
  for (const EntitySet& set : mesh.sets) {
    if (!in_deck.contains({set.association, set.name})) added.push_back(set);
  }
  const NamedParts in_mesh(mesh);
  for (const EntitySet& wanted : of_deck) {
    const EntitySet* const set = in_mesh.set(wanted.name, wanted.association);
    if (set != nullptr && is_as_in_deck(*set, wanted, numbers.of(wanted.association))) continue;
    notes.push_back(fmt::format("the set '{}' of {} is written as the deck has it; changes to it are lost",
                                wanted.name, to_string(wanted.association)));
  }
  return added;
}

void note_unfit_ids(const Mesh& mesh, std::string_view format, std::int64_t largest, Notes& notes,
                    std::int64_t smallest) {
  for (const Association association : {Association::vertices, Association::cells}) {
    const auto& ids = association == Association::vertices ? mesh.vertex_ids : mesh.cell_ids;
    if (ids.empty() || can_be_numbers(ids, largest, smallest)) continue;
    notes.push_back(
        fmt::format("the ids of {} are not written: numbers of {} are {} to {} and differ from each other",
                    to_string(association), format, smallest, largest));
  }
}

bool keep_numbers(const DeckNumbers& numbers, std::int64_t largest, const std::vector<std::string>& unknown,
                  const FilePath& path) {
  if (numbers.nodes.all_as_in_file() && numbers.elements.all_as_in_file()) return true;
  require_valid(numbers.nodes, "vertex", largest, path);
  require_valid(numbers.elements, "cell", largest, path);
  if (unknown.empty()) return false;
  throw InputError(path.string(),
                   "its numbers must stay, because other data may refer to them: " + join(unknown),
                   "keep them: --ids keep");
}

void note_rounded(std::int64_t coordinates, std::string_view field, Notes& notes) {
  if (coordinates == 0) return;
  notes.push_back(fmt::format(
      "{} rounded to the {}",
      coordinates == 1 ? "one coordinate is" : fmt::format("{} coordinates are", coordinates), field));
}

void note_kept_numbers(const std::vector<std::string>& unknown, Notes& notes) {
  if (unknown.empty()) return;
  constexpr std::size_t kShown = 3;
  const std::size_t more = unknown.size() - std::min(kShown, unknown.size());
  const std::vector<std::string> first(unknown.begin(), unknown.end() - static_cast<std::ptrdiff_t>(more));
  notes.push_back(
      fmt::format("all nodes and elements keep their numbers, and only their lines move, since these may "
                  "refer to their numbers or order: {}{}",
                  join(first), more > 0 ? fmt::format(" and {} more", more) : ""));
}

}  // namespace meshorder
