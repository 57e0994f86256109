// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/geometry/halving.hpp"

#include "lab/contact/geometry/box_tree.hpp"

#include <algorithm>

namespace meshorder {

void halve(std::span<Index> things, Index left, std::span<const Point> centers) {
  Box box;
  for (const Index thing : things) box.include(centers[thing]);
  int axis = 0;
  for (int c = 1; c < 3; ++c) {
    if (box.upper[c] - box.lower[c] > box.upper[axis] - box.lower[axis]) axis = c;
  }
  std::nth_element(things.begin(), things.begin() + left, things.end(), [&](Index a, Index b) {
    return centers[a][axis] < centers[b][axis] || (centers[a][axis] == centers[b][axis] && a < b);
  });
}

void sort_into_runs(std::span<Index> things, Index size, std::span<const Point> centers) {
  const Index runs = (index_size(things) + size - 1) / size;
  if (runs < 2) return;
  const Index left = runs / 2 * size;
  halve(things, left, centers);
  sort_into_runs(things.subspan(0, left), size, centers);
  sort_into_runs(things.subspan(left), size, centers);
}

}  // namespace meshorder
