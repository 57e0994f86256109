// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vtk/polyhedra.hpp"

#include <algorithm>

namespace meshorder::vtk {

bool are_faces(std::span<const Index> numbers) {
  if (numbers.empty() || numbers[0] < 1) return false;
  std::size_t at = 1;
  for (Index face = 0; face < numbers[0]; ++face) {
    if (at >= numbers.size() || numbers[at] < 1) return false;
    const auto corners = static_cast<std::size_t>(numbers[at]);
    if (corners >= numbers.size() - at) return false;
    at += 1 + corners;
  }
  return at == numbers.size();
}

Polyhedra Polyhedra::moved(std::span<const Index> new_vertices, std::span<const Index> new_cells) const {
  if (empty()) return {};
  Polyhedra result;
  result.are_by_face = are_by_face;
  if (new_cells.empty()) {
    result.starts = starts;
    result.numbers = numbers;
  } else {
    const auto kept =
        std::count_if(new_cells.begin(), new_cells.end(), [](Index place) { return place >= 0; });
    std::vector<Index> old_cells(static_cast<std::size_t>(kept));
    for (std::size_t c = 0; c < new_cells.size(); ++c) {
      if (new_cells[c] >= 0) old_cells[static_cast<std::size_t>(new_cells[c])] = static_cast<Index>(c);
    }
    result.starts.reserve(old_cells.size() + 1);
    result.starts.push_back(0);
    result.numbers.reserve(numbers.size());
    for (const Index cell : old_cells) {
      const std::span<const Index> own = (*this)[cell];
      result.numbers.insert(result.numbers.end(), own.begin(), own.end());
      result.starts.push_back(static_cast<Offset>(result.numbers.size()));
    }
  }
  if (new_vertices.empty()) return result;
  for (std::size_t c = 0; c + 1 < result.starts.size(); ++c) {
    const auto size = static_cast<std::size_t>(result.starts[c + 1] - result.starts[c]);
    for_faces(std::span<Index>(result.numbers.data() + result.starts[c], size), [&](std::span<Index> face) {
      for (Index& corner : face) corner = new_vertices[static_cast<std::size_t>(corner)];
    });
  }
  return result;
}

}  // namespace meshorder::vtk
