// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/procedural.hpp"

#include "base/index.hpp"
#include "base/memory.hpp"
#include "base/random.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace meshorder {
namespace {

/// A lattice of cubes; the first axis may be closed to a ring.
struct Lattice {
  std::array<Index, 3> cubes;
  bool ring = false;

  [[nodiscard]] Index vertices_along(int axis) const {
    return axis == 0 && ring ? cubes[0] : cubes[axis] + 1;
  }
  [[nodiscard]] Index vertex(Index i, Index j, Index k) const {
    return ((k * vertices_along(1)) + j) * vertices_along(0) + i % vertices_along(0);
  }
  /// Returns the position of a vertex in [0, 1]³ before jitter.
  [[nodiscard]] Point point(Index v) const {
    const Index row = v / vertices_along(0);
    const Index layer = row / vertices_along(1);
    return {1.0 * (v % vertices_along(0)) / cubes[0], 1.0 * (row % vertices_along(1)) / cubes[1],
            1.0 * layer / cubes[2]};
  }
};

void check_options(const ProceduralOptions& options, double vertices) {
  if (options.size < 1)
    throw InvalidArgument("model: size is " + std::to_string(options.size) + ", at least 1 is needed");
  if (!(options.jitter >= 0 && options.jitter <= 0.15))
    throw InvalidArgument("model: jitter must be 0 … 0.15");
  if (6 * vertices > kMaxIndex) throw InvalidArgument("model: too large, more than 2,147,483,647 tetrahedra");
  // bytes of a point and six tetrahedra
  constexpr std::uint64_t kBytesEach =
      sizeof(Point) + 6 * (4 * sizeof(Index) + sizeof(Offset) + sizeof(Shape));
  const std::uint64_t bytes = bytes_for(static_cast<std::uint64_t>(vertices), kBytesEach);
  if (bytes > memory_limit().bytes) {
    throw InvalidArgument("model: a size of " + std::to_string(options.size) + " would take " +
                          size_text(bytes) + ", more than the limit of " + size_text(memory_limit().bytes));
  }
}

/// Returns a mesh of [0, 1]³: vertices at lattice positions, jittered inside; six tetrahedra for each cube.
Mesh cut_lattice(const Lattice& lattice, const ProceduralOptions& options) {
  Mesh mesh;
  Random random(options.seed);
  mesh.points.reserve(static_cast<std::size_t>(lattice.vertices_along(0)) * lattice.vertices_along(1) *
                      lattice.vertices_along(2));
  for (Index k = 0; k < lattice.vertices_along(2); ++k) {
    for (Index j = 0; j < lattice.vertices_along(1); ++j) {
      for (Index i = 0; i < lattice.vertices_along(0); ++i) {
        const std::array<Index, 3> at{i, j, k};
        Point point;
        for (int a = 0; a < 3; ++a) {
          const bool inner = (a == 0 && lattice.ring) || (at[a] > 0 && at[a] < lattice.cubes[a]);
          const double moved = inner ? options.jitter * (2 * random.unit() - 1) : 0.0;
          point[a] = (at[a] + moved) / lattice.cubes[a];
        }
        mesh.points.push_back(point);
      }
    }
  }

  // paths from corner 000 to corner 111 along one axis after another; the first three are right-handed
  constexpr std::array<std::array<int, 3>, 6> kAxisOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
  const Offset cubes = Offset{lattice.cubes[0]} * lattice.cubes[1] * lattice.cubes[2];
  mesh.cells.reserve(6 * cubes, 24 * cubes);
  for (Index k = 0; k < lattice.cubes[2]; ++k) {
    for (Index j = 0; j < lattice.cubes[1]; ++j) {
      for (Index i = 0; i < lattice.cubes[0]; ++i) {
        for (std::size_t o = 0; o < kAxisOrders.size(); ++o) {
          std::array<Index, 3> corner{i, j, k};
          std::array<Index, 4> tetrahedron{lattice.vertex(i, j, k)};
          for (std::size_t step = 0; step < 3; ++step) {
            ++corner[kAxisOrders[o][step]];
            tetrahedron[step + 1] = lattice.vertex(corner[0], corner[1], corner[2]);
          }
          if (o >= 3) std::swap(tetrahedron[2], tetrahedron[3]);
          mesh.cells.push_back(Shape::tetrahedron, tetrahedron);
        }
      }
    }
  }
  return mesh;
}

double volume(const std::array<Point, 4>& p) {
  std::array<Point, 3> e;
  for (int k = 0; k < 3; ++k) {
    for (int a = 0; a < 3; ++a) e[k][a] = p[k + 1][a] - p[0][a];
  }
  return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
          e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
          e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
         6;
}

/// Applies `map` to every vertex. The map flattens cubes at the rim and along diagonals, where jitter could
/// invert tetrahedra: if a tetrahedron has less than a tenth of the volume that it would have without jitter,
/// its vertices lose their jitter.
template <class Map>
void bend(Mesh& mesh, const Lattice& lattice, Map map) {
  constexpr double kMinShare = 0.1;
  for (Point& point : mesh.points) point = map(point);
  for (bool changed = true; changed;) {
    changed = false;
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      std::array<Point, 4> jittered;
      std::array<Point, 4> regular;
      for (int k = 0; k < 4; ++k) {
        jittered[k] = mesh.points[mesh.cells[c][k]];
        regular[k] = map(lattice.point(mesh.cells[c][k]));
      }
      if (jittered == regular || volume(jittered) >= kMinShare * volume(regular)) continue;
      for (int k = 0; k < 4; ++k) mesh.points[mesh.cells[c][k]] = regular[k];
      changed = true;
    }
  }
}

/// Maps the square [−1, 1]² or cube [−1, 1]³ into the disc or ball along rays from the centre.
template <std::size_t D>
std::array<double, D> drawn_into_ball(std::array<double, D> p) {
  double largest = 0;
  double norm = 0;
  for (const double x : p) {
    largest = std::max(largest, std::abs(x));
    norm = std::hypot(norm, x);
  }
  if (norm > 0) {
    for (double& x : p) x *= largest / norm;
  }
  return p;
}

}  // namespace

Mesh make_grid(const ProceduralOptions& options) {
  check_options(options, std::pow(options.size + 1.0, 3));
  return cut_lattice({{options.size, options.size, options.size}}, options);
}

Mesh make_ball(const ProceduralOptions& options) {
  Mesh mesh = make_grid(options);
  bend(mesh, {{options.size, options.size, options.size}}, [](const Point& p) {
    return drawn_into_ball<3>({2 * p[0] - 1, 2 * p[1] - 1, 2 * p[2] - 1});
  });
  return mesh;
}

Mesh make_torus(const ProceduralOptions& options) {
  constexpr double kTube = 0.4;
  check_options(options, 8.0 * std::pow(options.size + 1.0, 3));
  const Lattice lattice{{8 * options.size, options.size, options.size}, true};
  Mesh mesh = cut_lattice(lattice, options);
  bend(mesh, lattice, [](const Point& p) -> Point {
    const double angle = -2 * std::numbers::pi * p[0];  // the negative sign keeps volumes positive
    const auto disc = drawn_into_ball<2>({2 * p[1] - 1, 2 * p[2] - 1});
    const double radius = 1 + kTube * disc[0];
    return {radius * std::cos(angle), radius * std::sin(angle), kTube * disc[1]};
  });
  return mesh;
}

}  // namespace meshorder
