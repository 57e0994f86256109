// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Orders a simulator's own arrays in place, before its first step.
#include <meshorder/order.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>
#include <vector>

namespace mo = meshorder;

namespace {

struct Body {
  std::vector<std::array<double, 3>> x;
  std::vector<std::array<double, 3>> v;
  std::vector<double> mass;
  std::vector<std::array<int, 4>> tets;
};

void reorder(Body& b) {
  const std::span corners(b.tets[0].data(), 4 * b.tets.size());
  const mo::MeshView mesh{
      {b.x[0].data(), b.x.size()}, mo::CellsView::uniform(mo::Shape::tetrahedron, 4, corners), b.x.size()};
  const auto [vertices, cells] = mo::order_mesh(mesh, {}, {.workload = mo::Workload::element});
  for (auto* field : {&b.x, &b.v}) vertices.permutation.move_in_place(std::span(*field));
  vertices.permutation.move_in_place(std::span(b.mass));
  vertices.permutation.renumber(corners);
  cells.permutation.move_in_place(std::span(b.tets));
}

// Returns a bar of side × side × 4 side cubes, each cut into five tetrahedra. Point i of the grid is vertex
// 7 i mod n, a poor order.
Body sample(int side) {
  const int nx = side + 1;
  const int nz = 4 * side + 1;
  const int n = nx * nx * nz;
  const auto number = [n](int point) { return static_cast<int>(7LL * point % n); };
  Body body;
  body.x.resize(static_cast<std::size_t>(n));
  for (int point = 0; point < n; ++point) {
    const auto layer = point / (nx * nx);
    const auto row = point / nx % nx;
    body.x[static_cast<std::size_t>(number(point))] = {static_cast<double>(point % nx),
                                                       static_cast<double>(row), static_cast<double>(layer)};
  }
  body.v = body.x;
  for (const auto& x : body.x) body.mass.push_back(1 + x[2]);
  constexpr std::array<std::array<int, 4>, 5> kCorners{
      {{0, 1, 2, 4}, {3, 1, 7, 2}, {5, 1, 4, 7}, {6, 2, 7, 4}, {1, 2, 4, 7}}};
  for (int z = 0; z + 1 < nz; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        for (const auto& corners : kCorners) {
          std::array<int, 4> tet{};
          for (std::size_t k = 0; k < 4; ++k) {
            const int c = corners[k];
            tet[k] = number((z + c / 4) * nx * nx + (y + c / 2 % 2) * nx + x + c % 2);
          }
          body.tets.push_back(tet);
        }
      }
    }
  }
  return body;
}

// Returns the sum of mass times volume over the tetrahedra, which the order changes by rounding only.
double moment(const Body& body) {
  double sum = 0;
  for (const auto& tet : body.tets) {
    double masses = 0;
    std::array<std::array<double, 3>, 4> p{};
    for (std::size_t k = 0; k < 4; ++k) {
      p[k] = body.x[static_cast<std::size_t>(tet[k])];
      masses += body.mass[static_cast<std::size_t>(tet[k])];
    }
    std::array<std::array<double, 3>, 3> e{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t a = 0; a < 3; ++a) e[k][a] = p[k + 1][a] - p[0][a];
    }
    const double volume = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                          e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                          e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    sum += masses * std::abs(volume);
  }
  return sum;
}

// Returns the mean distance in memory, in vertices, from the first corner of a tetrahedron to the others.
double mean_reach(const Body& body) {
  double sum = 0;
  for (const auto& tet : body.tets) {
    for (std::size_t k = 1; k < 4; ++k) sum += std::abs(tet[k] - tet[0]);
  }
  return sum / (3.0 * static_cast<double>(body.tets.size()));
}

}  // namespace

int main() {
  Body body = sample(8);
  const double moment_before = moment(body);
  const double reach_before = mean_reach(body);
  reorder(body);
  std::printf("mean distance of a tetrahedron's corners: %.0f before, %.0f after\n", reach_before,
              mean_reach(body));
  const bool same = std::abs(moment(body) - moment_before) < 1e-9 * moment_before && body.v == body.x;
  return same && mean_reach(body) < reach_before ? 0 : 1;
}
