// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Orders a badly numbered path of five vertices; exit status 0 if neighbours then follow each other.
#include <meshorder/meshorder.hpp>

#include <cstdlib>
#include <vector>

int main() {
  const std::vector<int> offsets{0, 1, 3, 5, 7, 8};
  const std::vector<int> neighbours{2, 3, 4, 0, 3, 1, 2, 1};  // 0-2-3-1-4
  const auto rcm = meshorder::order_vertices({offsets, neighbours}, "rcm");
  const auto places = rcm.permutation.old_to_new();
  for (int v = 0; v < 5; ++v)
    for (int e = offsets[v]; e < offsets[v + 1]; ++e)
      if (std::abs(places[v] - places[neighbours[e]]) != 1) return 1;
  try {
    meshorder::order_vertices({offsets, neighbours}, "no such method");
    return 2;
  } catch (const meshorder::InvalidArgument&) {
    // exceptions keep their type across the shared library's boundary
  }
  return meshorder::version() == MESHORDER_VERSION ? 0 : 3;
}
