// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// The numbers that the nodes and elements of a deck have, in the deck and in a mesh whose items moved.

#include "io/format.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/id_map.hpp"
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {

/// Moves the places of items; `moves` is empty where all stay. Returns whether all still have a place.
bool move_places(std::vector<Index>& places, std::span<const Index> moves);

/// Returns whether ids can be the numbers of nodes or elements: `smallest` to `largest`, and each given once.
/// False for none. O(n log n).
bool can_be_numbers(std::vector<std::int64_t> ids, std::int64_t largest, std::int64_t smallest = 1);

/// Returns the positions, in the file, of items whose numbers are from, from + step, … ≤ to; ascending by
/// number. `step` is 1 or more. O(numbers), or O(items) if these are fewer.
std::vector<Index> items_in_range(const IdMap& items, std::int64_t from, std::int64_t to, std::int64_t step);

/// The numbers that the nodes or elements of a file have in a mesh.
class FileNumbers {
 public:
  FileNumbers(const IdMap& of_file, const std::vector<Index>& places, const std::vector<std::int64_t>& ids)
      : of_file_(of_file), places_(places), ids_(ids) {}

  /// Returns the position in the mesh of the k-th item of the file.
  [[nodiscard]] Index place(Index k) const { return places_.empty() ? k : places_[k]; }
  /// Returns the number of the item at that position in the mesh.
  [[nodiscard]] std::int64_t at(Index place) const {
    return ids_.empty() ? place + std::int64_t{1} : ids_[place];
  }
  /// Returns the present number of the item that had this one in the file; the same where there was none.
  [[nodiscard]] std::int64_t now(std::int64_t number) const {
    const Index k = of_file_.find(number);
    return k < 0 ? number : at(place(k));
  }
  [[nodiscard]] bool all_as_in_file() const {
    for (Index k = 0; k < of_file_.size(); ++k) {
      if (at(place(k)) != of_file_.id(k)) return false;
    }
    return true;
  }
  [[nodiscard]] const IdMap& of_file() const { return of_file_; }

 private:
  const IdMap& of_file_;
  const std::vector<Index>& places_;
  const std::vector<std::int64_t>& ids_;
};

/// The sets of a mesh by name; of several with one name, the first. The names must stay where they are.
class SetsByName {
 public:
  explicit SetsByName(const std::vector<EntitySet>& sets) {
    for (const EntitySet& set : sets)
      sets_.try_emplace(std::pair(set.association, std::string_view(set.name)), &set);
  }

  /// Returns the set of that name, null if there is none. O(log sets).
  [[nodiscard]] const EntitySet* find(Association association, std::string_view name) const {
    const auto found = sets_.find({association, name});
    return found == sets_.end() ? nullptr : found->second;
  }

 private:
  std::map<std::pair<Association, std::string_view>, const EntitySet*> sets_;
};

/// Returns the sets of a mesh that its deck does not have. Notes those that are no longer as the deck has
/// them.
///
/// @param nodes, elements  of the deck, in the mesh
std::vector<EntitySet> sets_beside(const std::vector<EntitySet>& of_deck,
                                   const std::vector<EntitySet>& of_mesh, const FileNumbers& nodes,
                                   const FileNumbers& elements, Notes& notes);

/// Notes the ids of a mesh that are not written: those that `can_be_numbers` refuses.
void note_unfit_ids(const Mesh& mesh, std::string_view format, std::int64_t largest, Notes& notes,
                    std::int64_t smallest = 1);

/// Throws InputError where `unknown` cards may name nodes or elements by number, so that these cannot change.
void require_known_references(const std::vector<std::string>& unknown, const FilePath& path);

/// Notes that all numbers stay, for cards that may name nodes or elements; nothing where there are none.
void note_kept_numbers(const std::vector<std::string>& unknown, Notes& notes);

}  // namespace meshorder
