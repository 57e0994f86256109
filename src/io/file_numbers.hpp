// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// For formats that keep a file whole while its nodes and elements move.

#include "io/stream/id_map.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

/// Moves the places that items of a file have in a mesh.
///
/// @param places  of each item of the file; empty if they are in its order
/// @param moves   the new place of each old one, −1 for none; empty where all stay
/// @return whether all items still have a place
bool move_places(std::vector<Index>& places, std::span<const Index> moves);

/// Returns whether ids can be the numbers of nodes or elements: 1 to 999999999, each given once.
bool are_file_numbers(std::vector<std::int64_t> ids);

/// The numbers that the nodes or elements of a file have in a mesh.
class FileNumbers {
 public:
  /// Of items whose numbers in the file are `of_file`, at `places` (see `move_places`) of a mesh with these
  /// ids, or numbered from 1. All must outlive this object.
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
  [[nodiscard]] bool all_as_in_file() const;
  [[nodiscard]] const IdMap& of_file() const { return of_file_; }

 private:
  const IdMap& of_file_;
  const std::vector<Index>& places_;
  const std::vector<std::int64_t>& ids_;
};

}  // namespace meshorder
