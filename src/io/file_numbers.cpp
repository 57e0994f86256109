// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/file_numbers.hpp"

#include <algorithm>
#include <cstddef>

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

bool are_file_numbers(std::vector<std::int64_t> ids) {
  constexpr std::int64_t kLargest = 999'999'999;  // of Abaqus; more digits fill the fields of I-deas
  std::sort(ids.begin(), ids.end());
  return !ids.empty() && ids.front() > 0 && ids.back() <= kLargest &&
         std::adjacent_find(ids.begin(), ids.end()) == ids.end();
}

bool FileNumbers::all_as_in_file() const {
  for (Index k = 0; k < of_file_.size(); ++k) {
    if (at(place(k)) != of_file_.id(k)) return false;
  }
  return true;
}

}  // namespace meshorder
