// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Orders a simulator's own arrays in place, before its first step.
#include <meshorder/order.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <set>
#include <vector>

namespace mo = meshorder;

namespace {

struct Body {
  std::vector<std::array<double, 3>> x;
  std::vector<std::array<double, 3>> v;
  std::vector<double> mass;
  std::vector<int> pinned;  // numbers of vertices
  std::vector<std::array<int, 4>> tets;
  std::vector<std::array<int, 2>> springs;
  std::vector<double> rest_length;  // of each spring
};

// Orders all arrays of the body. Returns the order of the vertices, for data that are stored elsewhere.
mo::Permutation reorder(Body& b) {
  const mo::MeshView mesh{b.x, mo::CellsView::uniform(mo::Shape::tetrahedron, 4, b.tets)};
  const auto [vertices, tets] = mo::order_mesh(mesh, {}, {.workload = mo::Workload::element});
  const mo::Permutation& moved = vertices.permutation;
  const mo::Permutation springs = mo::order_edges(b.springs, moved);  // takes the old numbers of the ends

  moved.move_in_place(b.x);  // data of vertices moves
  moved.move_in_place(b.v);
  moved.move_in_place(b.mass);
  moved.renumber(b.pinned);  // numbers of vertices change
  moved.renumber(b.tets);
  moved.renumber(b.springs);
  tets.permutation.move_in_place(b.tets);
  springs.move_in_place(b.springs);
  springs.move_in_place(b.rest_length);
  return moved;
}

double distance(const Body& b, const std::array<int, 2>& ends) {
  const auto& p = b.x[static_cast<std::size_t>(ends[0])];
  const auto& q = b.x[static_cast<std::size_t>(ends[1])];
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

// Adds a spring on each edge of the tetrahedra.
void add_springs(Body& body) {
  std::set<std::array<int, 2>> edges;
  for (const auto& tet : body.tets) {
    for (const int a : tet)
      for (const int b : tet)
        if (a < b) edges.insert({a, b});
  }
  for (const auto& ends : edges) {
    body.springs.push_back(ends);
    body.rest_length.push_back(distance(body, ends));
  }
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
  for (int point = 0; point < nx * nx; ++point) body.pinned.push_back(number(point));
  add_springs(body);
  return body;
}

// Returns the sum over the tetrahedra of mass times volume; the order changes this sum by rounding only.
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

// Returns whether each spring is at rest and all pinned vertices are in the first layer.
bool is_at_rest(const Body& body) {
  for (std::size_t s = 0; s < body.springs.size(); ++s)
    if (std::abs(distance(body, body.springs[s]) - body.rest_length[s]) > 1e-12) return false;
  return std::ranges::all_of(body.pinned, [&](int v) { return body.x[static_cast<std::size_t>(v)][2] == 0; });
}

// Returns the mean distance in memory, in vertices, from a spring's ends to the next spring's ends.
double mean_step(const Body& body) {
  double sum = 0;
  for (std::size_t s = 1; s < body.springs.size(); ++s) {
    const auto [a, b] = std::ranges::minmax(body.springs[s]);
    const auto [c, d] = std::ranges::minmax(body.springs[s - 1]);
    sum += std::abs(a - c) + std::abs(b - d);
  }
  return sum / (2.0 * static_cast<double>(body.springs.size() - 1));
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
  const double step_before = mean_step(body);
  const std::vector<double> mass_before = body.mass;
  const mo::Permutation moved = reorder(body);
  std::printf("mean distance of a tetrahedron's corners: %.0f before, %.0f after\n", reach_before,
              mean_reach(body));
  std::printf("mean distance from a spring's ends to the next one's: %.0f before, %.0f after\n", step_before,
              mean_step(body));
  std::vector<double> mass(body.mass.size());
  moved.inverse().move(body.mass, mass);  // results in the old order
  const bool same = std::abs(moment(body) - moment_before) < 1e-9 * moment_before && body.v == body.x &&
                    is_at_rest(body) && mass == mass_before;
  return same && mean_reach(body) < reach_before && mean_step(body) < step_before ? 0 : 1;
}
