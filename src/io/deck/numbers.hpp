// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Numbers of a deck's nodes and elements: those in the deck, and those in the reordered mesh.

#include "io/format.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/id_map.hpp"
#include <meshorder/mesh.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Replaces each position p by moves[p]; empty `places` are 0, 1, 2 …, and empty `moves` change nothing.
/// Returns whether all items still have a position.
bool move_places(std::vector<Index>& places, std::span<const Index> moves);

/// Returns whether ids are valid numbers of nodes or elements: from `smallest` to `largest`, each only once.
/// False if there are no ids. O(n) time; O(n log n) if the ids are far apart.
bool can_be_numbers(std::span<const std::int64_t> ids, std::int64_t largest, std::int64_t smallest = 1);

/// Returns the ids if they can be numbers of nodes or elements, else no ids.
inline std::span<const std::int64_t> ids_as_numbers(std::span<const std::int64_t> ids, std::int64_t largest,
                                                    std::int64_t smallest = 1) {
  return can_be_numbers(ids, largest, smallest) ? ids : std::span<const std::int64_t>();
}

/// The number of each vertex or cell in a new file: its id if all ids can be numbers, else `first` plus its
/// position. The ids must outlive this object.
class NewNumbers {
 public:
  NewNumbers(std::span<const std::int64_t> ids, std::int64_t largest, std::int64_t smallest = 1,
             std::int64_t first = 1)
      : ids_(ids_as_numbers(ids, largest, smallest)), first_(first) {}

  [[nodiscard]] std::int64_t of(Index item) const { return ids_.empty() ? item + first_ : ids_[item]; }

 private:
  std::span<const std::int64_t> ids_;
  std::int64_t first_;
};

/// Returns the positions in the file of the items whose numbers are `from`, `from` + `step`, … ≤ `to`,
/// ascending by number. `step` is at least 1. O(numbers) time if there are fewer numbers than items, else
/// O(items · log items).
std::vector<Index> items_in_range(const IdMap& items, std::int64_t from, std::int64_t to, std::int64_t step);

/// Maps the nodes or elements of a file to their positions and numbers in a mesh. All arguments must outlive
/// this object.
class FileNumbers {
 public:
  FileNumbers(const IdMap& of_file, std::span<const Index> places, std::span<const std::int64_t> ids)
      : of_file_(of_file), places_(places), ids_(ids) {}

  /// Returns the position in the mesh of the k-th item of the file.
  [[nodiscard]] Index place(Index k) const { return places_.empty() ? k : places_[k]; }
  /// Returns the number of the item at that position in the mesh.
  [[nodiscard]] std::int64_t at(Index place) const {
    return ids_.empty() ? place + std::int64_t{1} : ids_[place];
  }
  /// Returns the present number of the item that the file gave `number`; `number` itself if the file has no
  /// such item.
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
  /// Returns, for each position in the mesh, the item of the file. O(items).
  [[nodiscard]] std::vector<Index> items() const {
    std::vector<Index> items(static_cast<std::size_t>(of_file_.size()));
    for (Index k = 0; k < of_file_.size(); ++k) items[place(k)] = k;
    return items;
  }
  [[nodiscard]] const IdMap& of_file() const { return of_file_; }

 private:
  const IdMap& of_file_;
  std::span<const Index> places_;
  std::span<const std::int64_t> ids_;
};

/// The numbers of a deck's nodes and elements in a mesh.
struct DeckNumbers {
  FileNumbers nodes;
  FileNumbers elements;

  [[nodiscard]] const FileNumbers& of(Association association) const {
    return association == Association::vertices ? nodes : elements;
  }
};

/// Returns the sets of a mesh that its deck does not have. Notes the deck's sets that are missing or
/// different in the mesh.
std::vector<EntitySet> sets_beside(const std::vector<EntitySet>& of_deck, const Mesh& mesh,
                                   const DeckNumbers& numbers, Notes& notes);

/// If the ids of vertices or cells are not valid numbers (see `can_be_numbers`), notes that they are not
/// written.
void note_unfit_ids(const Mesh& mesh, std::string_view format, std::int64_t largest, Notes& notes,
                    std::int64_t smallest = 1);

/// Returns whether all nodes and elements keep the numbers of their deck. If not, throws InputError
/// - if new numbers are not valid: they repeat, are below both 1 and the least number in the file, or are
///   above both `largest` and the greatest number in the file;
/// - if there are `unknown` cards: they may name items by number, so no number can change.
/// Time as `can_be_numbers`.
bool keep_numbers(const DeckNumbers& numbers, std::int64_t largest, const std::vector<std::string>& unknown,
                  const FilePath& path);

/// If `coordinates` > 0, notes that so many coordinates were rounded to the width of `field`.
void note_rounded(std::int64_t coordinates, std::string_view field, Notes& notes);

/// Notes that all numbers stay because of `unknown` cards, which may name nodes or elements. Notes nothing if
/// there are no such cards.
void note_kept_numbers(const std::vector<std::string>& unknown, Notes& notes);

}  // namespace meshorder
