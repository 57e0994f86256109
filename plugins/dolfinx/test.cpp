// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Tests orders for DOLFINx: their direction, and that the solution stays the same.
#include "problem.hpp"
#include "reaction.h"
#include <meshorder/dolfinx.hpp>

#include <basix/finite-element.h>
#include <dolfinx/common/log.h>
#include <dolfinx/fem/DofMap.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace {

void check(bool holds, const char* what, int line) {
  if (holds) return;
  std::printf("line %d: not true: %s\n", line, what);
  std::exit(1);
}
#define EXPECT(condition) check((condition), #condition, __LINE__)

// Returns a bar of cubes, each cut into six tetrahedra around its diagonal, with scattered points and cells.
measuring::Tetrahedra bar(int length, int side) {
  constexpr std::array<std::array<int, 3>, 6> paths{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  const std::array strides{1, length + 1, (length + 1) * (side + 1)};
  const int points = (length + 1) * (side + 1) * (side + 1);
  const int cells = 6 * length * side * side;
  const auto scattered = [](int k, int n) {
    int stride = 37;
    while (std::gcd(stride, n) != 1) ++stride;
    return static_cast<std::size_t>(static_cast<long long>(k) * stride % n);
  };
  measuring::Tetrahedra mesh{.points = std::vector<std::array<double, 3>>(static_cast<std::size_t>(points)),
                             .cells = std::vector<std::array<int, 4>>(static_cast<std::size_t>(cells))};
  int cell = 0;
  for (int p = 0; p < points; ++p) {
    const std::array at{p % (length + 1), p / strides[1] % (side + 1), p / strides[2]};
    mesh.points[scattered(p, points)] = {static_cast<double>(at[0]), static_cast<double>(at[1]),
                                         static_cast<double>(at[2])};
    if (at[0] == length || at[1] == side || at[2] == side) continue;
    for (const auto& path : paths) {
      int corner = p;
      auto& corners = mesh.cells[scattered(cell++, cells)];
      corners[0] = static_cast<int>(scattered(corner, points));
      for (std::size_t step = 0; step < 3; ++step) {
        corner += strides[static_cast<std::size_t>(path[step])];
        corners[step + 1] = static_cast<int>(scattered(corner, points));
      }
    }
  }
  return mesh;
}

int bandwidth(const dolfinx::graph::AdjacencyList<std::int32_t>& cells) {
  int largest = 0;
  for (std::int32_t c = 0; c < cells.num_nodes(); ++c) {
    const auto [least, most] = std::ranges::minmax(cells.links(c));
    largest = std::max(largest, most - least);
  }
  return largest;
}

std::shared_ptr<dolfinx::fem::FunctionSpace> linear_space(const std::shared_ptr<dolfinx::mesh::Mesh>& mesh,
                                                          const problem::Reorder& order) {
  const auto element = basix::create_element(basix::element::family::P, basix::cell::type::tetrahedron, 1);
  return std::make_shared<dolfinx::fem::FunctionSpace>(
      dolfinx::fem::create_functionspace(mesh, element, 1, order));
}

// Orders a bar of one row of cubes. A good order has a bandwidth of at most 7: neighbours are in the same or
// adjacent squares of 4 points.
void test_direction() {
  const measuring::Tetrahedra tetrahedra = bar(60, 1);
  const auto rcm = meshorder::dolfinx_reorder("rcm");
  const problem::Reorder swapped = [&](const auto& graph) {
    const std::vector<int> map = rcm(graph);
    std::vector<int> inverse(map.size());
    for (std::size_t k = 0; k < map.size(); ++k)
      inverse[static_cast<std::size_t>(map[k])] = static_cast<int>(k);
    EXPECT(map != inverse);
    return inverse;
  };
  const auto mesh = problem::create_mesh(tetrahedra, problem::stay, rcm);
  EXPECT(bandwidth(mesh->geometry().dofmap()) <= 7);
  EXPECT(bandwidth(linear_space(mesh, rcm)->dofmap()->list()) <= 7);
  EXPECT(bandwidth(linear_space(mesh, swapped)->dofmap()->list()) > 7);
  EXPECT(bandwidth(linear_space(mesh, problem::stay)->dofmap()->list()) > 7);
  const auto wrong = problem::create_mesh(tetrahedra, problem::stay, swapped);
  EXPECT(bandwidth(wrong->geometry().dofmap()) > 7);
}

// Solves the problem in that order; returns u at the points, by coordinates.
std::map<std::array<double, 3>, double> solution(const problem::Reorder& order) {
  const auto mesh = problem::create_mesh(bar(9, 5), order, order);
  const auto space = linear_space(mesh, order);
  problem::System system(space, *form_reaction_a, *form_reaction_L);
  system.assemble();
  std::vector<double> u;
  system.solve(u, 1e-13);
  const std::vector<double> x = space->tabulate_dof_coordinates(false);
  std::map<std::array<double, 3>, double> values;
  for (std::size_t k = 0; k < u.size(); ++k) {
    values[{std::round(x[3 * k]), std::round(x[3 * k + 1]), std::round(x[3 * k + 2])}] = u[k];
  }
  return values;
}

void test_the_same_solution() {
  const auto expected = solution(problem::stay);
  EXPECT(expected.size() == 10 * 6 * 6);
  for (const char* const method : {"rcm", "spectral", "auto", "scrambled"}) {
    const auto found = solution(meshorder::dolfinx_reorder(method));
    EXPECT(found.size() == expected.size());
    for (const auto& [place, value] : expected) {
      EXPECT(value > 0.5);
      EXPECT(std::abs(found.at(place) - value) < 1e-10);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  dolfinx::init_logging(argc, argv);  // warnings only
  test_direction();
  test_the_same_solution();
  MPI_Finalize();
  return 0;
}
