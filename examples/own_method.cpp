// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Adds a vertex method. Built as a shared library this file is a plug-in, whose method the command compares
// with the built-in ones: meshorder --plugin ./libdegree.so compare mesh.msh
#include <meshorder.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <numeric>

extern "C" int meshorder_plugin_v1(mo_register_fn add) {
  return add(
      "degree", "by falling degree", 0,
      [](void*, int64_t n, const int64_t* offsets, const int32_t*, const double*, int32_t* order) {
        std::iota(order, order + n, 0);
        std::stable_sort(order, order + n, [&](int a, int b) {
          return offsets[a + 1] - offsets[a] > offsets[b + 1] - offsets[b];
        });
        return 0;
      },
      nullptr);
}

// Registers the method in this program and orders a star of five vertices by it: the hub, vertex 4, comes
// first.
int main() {
  if (meshorder_plugin_v1(mo_register) != MO_OK) {
    std::printf("%s\n", mo_last_error());
    return 1;
  }
  constexpr std::array<std::int64_t, 6> kOffsets{0, 1, 2, 3, 4, 8};
  constexpr std::array<std::int32_t, 8> kNeighbours{4, 4, 4, 4, 0, 1, 2, 3};
  std::array<std::int32_t, 5> new_to_old{};
  const mo_in offsets{kOffsets.data(), kOffsets.size(), MO_INT64};
  const mo_in neighbours{kNeighbours.data(), kNeighbours.size(), MO_INT32};
  const mo_out order{new_to_old.data(), new_to_old.size(), MO_INT32};

  mo_options options;
  mo_options_init(&options, sizeof options);
  options.method = "degree";
  if (mo_order_graph(&offsets, &neighbours, nullptr, nullptr, 0, &options, &order, nullptr, nullptr) !=
      MO_OK) {
    std::printf("%s\n", mo_last_error());
    return 1;
  }
  for (const std::int32_t v : new_to_old) std::printf("%d ", v);
  std::printf("\n");
  return new_to_old == std::array<std::int32_t, 5>{4, 0, 1, 2, 3} ? 0 : 1;
}
