// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Keeps the order of a mesh fresh. The mesh is refined in each step where a wave passes.
#include <meshorder/changing.hpp>
#include <meshorder/order.hpp>
#include <meshorder/quality.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace mo = meshorder;

namespace {

struct Surface {
  std::vector<std::array<double, 2>> x;
  std::vector<std::array<int, 3>> triangles;
};

// Returns a square of side × side points, row by row.
Surface square(int side) {
  Surface s;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) s.x.push_back({1.0 * x / (side - 1), 1.0 * y / (side - 1)});
  for (int y = 0; y + 1 < side; ++y) {
    for (int x = 0; x + 1 < side; ++x) {
      const int a = x + side * y;
      s.triangles.push_back({a, a + 1, a + side});
      s.triangles.push_back({a + 1, a + 1 + side, a + side});
    }
  }
  return s;
}

// Puts a vertex into each triangle where the wave is, at the end of the arrays, as most programs do.
void refine(Surface& s, double wave) {
  const std::size_t before = s.triangles.size();
  for (std::size_t t = 0; t < before; ++t) {
    const auto [a, b, c] = s.triangles[t];
    std::array<double, 2> middle{};
    for (const int v : {a, b, c})
      for (std::size_t axis = 0; axis < 2; ++axis) middle[axis] += s.x[static_cast<std::size_t>(v)][axis] / 3;
    if (std::abs(std::hypot(middle[0], middle[1]) - wave) > 0.01) continue;
    const int added = static_cast<int>(s.x.size());
    s.x.push_back(middle);
    s.triangles[t] = {a, b, added};
    s.triangles.push_back({b, c, added});
    s.triangles.push_back({c, a, added});
  }
}

mo::CellsView cells_of(const Surface& s) {
  return mo::CellsView::uniform(mo::Shape::triangle, 3, s.triangles);
}

double mean_log2_span(const Surface& s) {
  const mo::Graph graph = mo::vertex_graph(cells_of(s), s.x.size());
  return mo::quality(graph).mean_log2_span;
}

}  // namespace

int main() {
  Surface kept = square(120);
  Surface left = kept;  // the same mesh, never reordered
  mo::Reorderer reorderer({.method = "hilbert"});
  for (int step = 0; step < 40; ++step) {
    std::vector<int> previous(kept.x.size());
    for (std::size_t v = 0; v < previous.size(); ++v) previous[v] = step == 0 ? -1 : static_cast<int>(v);
    refine(kept, 0.03 * step);
    refine(left, 0.03 * step);
    previous.resize(kept.x.size(), -1);
    const mo::Update update = reorderer.update(mo::MeshView{kept.x, cells_of(kept)}, previous);
    if (update.repair == mo::Repair::none) continue;
    update.permutation.move_in_place(kept.x);
    update.permutation.renumber(kept.triangles);
  }
  Surface fresh = kept;
  const mo::Permutation order =
      mo::order_mesh({fresh.x, cells_of(fresh)}, {.vertices = "hilbert"}).vertices.permutation;
  order.renumber(fresh.triangles);
  std::printf("mean log2 span: %.2f left alone, %.2f kept fresh, %.2f in a fresh order\n",
              mean_log2_span(left), mean_log2_span(kept), mean_log2_span(fresh));
  return mean_log2_span(kept) < 1.05 * mean_log2_span(fresh) && mean_log2_span(kept) < mean_log2_span(left)
             ? 0
             : 1;
}
