// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/space_filling.hpp"

#include "mesh/graphs.hpp"
#include "ordering/method.hpp"
#include "ordering/moved.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>

namespace meshorder {
namespace {

/// All cells of a lattice of 2^k cells along each of `axes` axes, shuffled; the other coordinates are 7.
std::vector<Point> full_lattice(int axes, int k) {
  const Index side = Index{1} << k;
  std::vector<Point> points;
  for (Index x = 0; x < side; ++x) {
    for (Index y = 0; y < (axes > 1 ? side : 1); ++y) {
      for (Index z = 0; z < (axes > 2 ? side : 1); ++z) {
        points.push_back({1.0 * x, axes > 1 ? y : 7.0, axes > 2 ? z : 7.0});
      }
    }
  }
  return moved(test::shuffled(index_size(points), 1), points);
}

Permutation order_of(std::string_view method, const std::vector<Point>& points) {
  const CsrGraph complete_enough = [&] {
    // no vertex may be isolated: isolated ones would be moved to the end
    std::vector<Edge> ring;
    const auto n = index_size(points);
    for (Index v = 0; v < n; ++v) ring.push_back({v, (v + 1) % n});
    return graph_from_edges(n, ring);
  }();
  return order_graph(method, {complete_enough, points}).permutation;
}

double distance(const Point& a, const Point& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

TEST(Hilbert, ConsecutiveCellsOfAFullLatticeAreNeighbours) {
  for (const auto& [axes, most] : {std::pair(1, 8), std::pair(2, 6), std::pair(3, 4)}) {
    for (int k = 1; k <= most; ++k) {
      const std::vector<Point> points = full_lattice(axes, k);
      const std::vector<Index> sequence = order_of("hilbert", points).new_to_old();
      for (std::size_t i = 1; i < sequence.size(); ++i) {
        ASSERT_EQ(distance(points[sequence[i - 1]], points[sequence[i]]), 1)
            << axes << " axes, 2^" << k << " cells, step " << i;
      }
    }
  }
}

TEST(Hilbert, FillsEachHalfOfTheLatticeBeforeTheNext) {
  // the cells of every aligned block of 4^j are consecutive
  const std::vector<Point> points = full_lattice(2, 5);
  const std::vector<Index> sequence = order_of("hilbert", points).new_to_old();
  for (int j = 1; j <= 4; ++j) {
    const std::size_t block = std::size_t{1} << (2 * j);
    for (std::size_t first = 0; first < sequence.size(); first += block) {
      for (std::size_t i = first; i < first + block; ++i) {
        for (int a = 0; a < 2; ++a) {
          ASSERT_EQ(std::floor(points[sequence[i]][a] / (1 << j)),
                    std::floor(points[sequence[first]][a] / (1 << j)));
        }
      }
    }
  }
}

TEST(Hilbert, DoesNotDependOnScaleAndPlace) {
  std::vector<Point> points = full_lattice(3, 3);
  const Permutation order = order_of("hilbert", points);
  for (Point& point : points) point = {1e-9 * point[0] - 4, 1e-9 * point[1], 1e-9 * point[2] + 2};
  EXPECT_EQ(order_of("hilbert", points), order);
}

/// The number of a cell on the Hilbert curve, by Skilling's transformation of the coordinates, scale by scale
/// (2004, AxestoTranspose).
std::uint64_t skillings_number(std::array<std::uint32_t, 3> x, int axes, int bits) {
  for (std::uint32_t q = 1U << static_cast<unsigned>(bits - 1); q > 1; q /= 2) {
    for (int a = 0; a < axes; ++a) {
      const std::uint32_t change = (x[a] & q) != 0 ? q - 1 : (x[0] ^ x[a]) & (q - 1);
      if ((x[a] & q) == 0) x[a] ^= change;
      if ((x[a] & q) != 0 || a > 0) x[0] ^= change;
    }
  }
  for (int a = 1; a < axes; ++a) x[a] ^= x[a - 1];
  std::uint32_t flips = 0;
  for (std::uint32_t q = 1U << static_cast<unsigned>(bits - 1); q > 1; q /= 2) {
    if ((x[axes - 1] & q) != 0) flips ^= q - 1;
  }
  for (int a = 0; a < axes; ++a) x[a] ^= flips;
  return interleaved(x, axes);
}

TEST(Hilbert, NumbersCellsAsSkillingsTransformationDoes) {
  std::mt19937 random(1);
  for (const auto& [axes, bits] : {std::pair(1, 31), std::pair(2, 31), std::pair(3, 21), std::pair(3, 1)}) {
    for (int trial = 0; trial < 2000; ++trial) {
      std::array<std::uint32_t, 3> x{};
      for (int a = 0; a < axes; ++a)
        x[a] = static_cast<std::uint32_t>(random()) % (1U << static_cast<unsigned>(bits));
      ASSERT_EQ(hilbert_key(x, axes, bits), skillings_number(x, axes, bits)) << axes << " axes";
    }
  }
  EXPECT_EQ(hilbert_key({}, 0, 31), 0U);
}

/// The number that the bits of the coordinates spell, x before y before z, highest first.
std::uint64_t spelt(const std::array<std::uint32_t, 3>& coordinates, int axes, int bits) {
  std::uint64_t number = 0;
  for (int place = 0; place < axes * bits; ++place) {
    const auto axis = static_cast<std::size_t>(axes - 1 - place % axes);
    const std::uint64_t bit = (coordinates[axis] / (std::uint64_t{1} << (place / axes))) % 2;
    number += bit * (std::uint64_t{1} << place);
  }
  return number;
}

TEST(Morton, InterleavesBits) {
  EXPECT_EQ(interleaved({1, 0, 0}, 3), 4U);
  EXPECT_EQ(interleaved({0, 3, 0}, 2), 5U);
  std::mt19937 random(1);
  for (const auto& [axes, bits] : {std::pair(1, 31), std::pair(2, 31), std::pair(3, 21)}) {
    for (int trial = 0; trial < 200; ++trial) {
      std::array<std::uint32_t, 3> coordinates{};
      for (int a = 0; a < axes; ++a) {
        coordinates[a] = static_cast<std::uint32_t>(random()) % (1U << static_cast<unsigned>(bits));
      }
      ASSERT_EQ(interleaved(coordinates, axes), spelt(coordinates, axes, bits));
    }
  }
}

TEST(Morton, OfAFullLatticeIsTheSpeltNumber) {
  for (const auto& [axes, k] : {std::pair(1, 6), std::pair(2, 5), std::pair(3, 4)}) {
    const std::vector<Point> points = full_lattice(axes, k);
    const std::vector<Index> sequence = order_of("morton", points).new_to_old();
    for (std::size_t i = 0; i < sequence.size(); ++i) {
      const Point& point = points[sequence[i]];
      const auto bits = [](double x) { return static_cast<std::uint32_t>(x); };
      ASSERT_EQ(spelt({bits(point[0]), bits(point[1]), bits(point[2])}, axes, k), i) << axes << " axes";
    }
  }
}

TEST(SpaceFilling, LeavesOutAxesWithoutExtent) {
  // the same plane lattice in each pair of axes
  const std::vector<Point> flat = full_lattice(2, 4);
  for (const char* method : {"morton", "hilbert"}) {
    const Permutation order = order_of(method, flat);
    for (const auto& [first, second] : {std::pair(0, 2), std::pair(1, 2)}) {
      std::vector<Point> stood(flat.size(), Point{-3, -3, -3});
      for (std::size_t v = 0; v < flat.size(); ++v) {
        stood[v][first] = flat[v][0];
        stood[v][second] = flat[v][1];
      }
      EXPECT_EQ(order_of(method, stood), order) << method;
    }
  }
}

TEST(SpaceFilling, OfPointsOnALineGoesAlongIt) {
  std::mt19937_64 random(3);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Point> points(500, Point{5, 5, 5});
    for (Point& point : points) point[axis] = static_cast<double>(random() % 100000U) / 3;
    for (const char* method : {"morton", "hilbert"}) {
      const std::vector<Index> sequence = order_of(method, points).new_to_old();
      EXPECT_TRUE(std::is_sorted(sequence.begin(), sequence.end(), [&](Index a, Index b) {
        return std::pair(points[a][axis], a) < std::pair(points[b][axis], b);
      })) << method;
    }
  }
}

TEST(SpaceFilling, OfEqualPointsKeepsTheirOrder) {
  const std::vector<Point> points(50, Point{1, 2, 3});
  for (const char* method : {"morton", "hilbert"})
    EXPECT_TRUE(order_of(method, points).is_identity()) << method;
}

TEST(SpaceFilling, ComparesWholeNumbersOfPointsThatAreNear) {
  for (const int axes : {2, 3}) {
    std::mt19937_64 random(3);
    std::vector<Point> points{{0, 0, 0}, {1, 1, axes == 3 ? 1.0 : 0.0}};
    for (int k = 0; k < 600; ++k) {
      const double scale = std::ldexp(1.0, -k % 24);  // in clusters around a corner, some points in one cell
      const auto at = [&] { return scale * (0.5 + static_cast<double>(random() % 64) / 128); };
      points.push_back({at(), at(), axes == 3 ? at() : 0});
    }
    const Lattice lattice = lattice_of(points);
    const auto cell = [&](Index i) { return lattice.cell_of(points[i]); };
    const auto sorted_by = [&](const auto& number) {
      std::vector<Index> sequence(points.size());
      std::iota(sequence.begin(), sequence.end(), 0);
      std::ranges::stable_sort(sequence, {}, number);
      return sequence;
    };
    EXPECT_EQ(order_of("hilbert", points).new_to_old(),
              sorted_by([&](Index i) { return hilbert_key(cell(i), lattice.axes(), lattice.bits()); }));
    EXPECT_EQ(order_of("morton", points).new_to_old(),
              sorted_by([&](Index i) { return interleaved(cell(i), lattice.axes()); }));
  }
}

TEST(SpaceFilling, LatticeCoversTheBox) {
  const std::vector<Point> points{{-1, 2, 0}, {3, 2.5, 0}, {1, 2.25, 0}};
  const Lattice lattice = lattice_of(PointsView(points));
  EXPECT_EQ(lattice.axes(), 2);
  EXPECT_EQ(lattice.bits(), 31);
  const std::uint32_t last = (1U << 31U) - 1;
  EXPECT_EQ(lattice.cell_of(points[0]), (std::array<std::uint32_t, 3>{0, 0, 0}));
  EXPECT_EQ(lattice.cell_of(points[1]), (std::array<std::uint32_t, 3>{last, last / 8, 0}))
      << "cells are cubes";
  EXPECT_EQ(lattice.cell_of(points[2]), (std::array<std::uint32_t, 3>{last / 2, last / 16, 0}));
  EXPECT_EQ(lattice_of({}).axes(), 0);
}

TEST(Hilbert, OfElementsGoesThroughTheirCentroids) {
  const Mesh mesh = test::tetrahedral_bar(5);
  const CellArrays cells = cell_arrays(mesh);
  const CellSelection top = CellSelection::elements(cells);
  std::vector<Point> centroids;
  for (Index e = 0; e < top.incidence().size(); ++e) {
    Point sum{};
    for (const Index v : top.incidence()[e]) {
      for (int a = 0; a < 3; ++a) sum[a] += mesh.points[v][a] / 4;
    }
    centroids.push_back(sum);
  }
  const Permutation vertices = test::shuffled(mesh.vertex_count(), 1);
  EXPECT_EQ(order_incidence("hilbert", {top.incidence(), vertices, mesh.points, {}}).permutation,
            order_of("hilbert", centroids));
}

}  // namespace
}  // namespace meshorder
