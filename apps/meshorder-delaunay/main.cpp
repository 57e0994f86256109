// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Triangulates sets of points for `meshorder simulate splash` until the end of the input.
//
// Numbers are in the machine's byte order. Reads n (8 bytes), then n points of three doubles. Writes:
// - the number m of tetrahedra (8 bytes);
// - for each tetrahedron, the numbers of its four corners (4 bytes each); points are numbered from 0;
// - for each tetrahedron, the numbers of its four neighbours (4 bytes each), each opposite a corner; −1 where
//   a face is on the hull.
//
// CGAL's triangulations are under the GPL, so this is a separate program: see README.md of meshorder-models.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <utility>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::int32_t, Kernel>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<std::int32_t, Kernel>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Row = std::array<std::int32_t, 4>;

constexpr std::int64_t kMostPoints = std::int64_t{1} << 26;  // the number of tetrahedra must fit 32 bits

template <class T>
bool read(T* to, std::size_t count) {
  return std::fread(to, sizeof(T), count, stdin) == count;
}

template <class T>
bool write(const T* from, std::size_t count) {
  return std::fwrite(from, sizeof(T), count, stdout) == count;
}

void triangulate(const std::vector<std::array<double, 3>>& points, std::vector<Row>& corners,
                 std::vector<Row>& neighbours) {
  std::vector<std::pair<Kernel::Point_3, std::int32_t>> numbered;
  numbered.reserve(points.size());
  for (const auto& [x, y, z] : points)
    numbered.emplace_back(Kernel::Point_3(x, y, z), static_cast<std::int32_t>(numbered.size()));
  const Triangulation triangulation(numbered.begin(), numbered.end());
  corners.clear();
  neighbours.clear();
  if (triangulation.dimension() < 3) return;
  for (const auto cell : triangulation.all_cell_handles()) cell->info() = -1;
  std::int32_t count = 0;
  for (const auto cell : triangulation.finite_cell_handles()) cell->info() = count++;
  corners.reserve(static_cast<std::size_t>(count));
  neighbours.reserve(static_cast<std::size_t>(count));
  for (const auto cell : triangulation.finite_cell_handles()) {
    Row& vertices = corners.emplace_back();
    Row& beyond = neighbours.emplace_back();
    for (int i = 0; i < 4; ++i) {
      vertices[static_cast<std::size_t>(i)] = cell->vertex(i)->info();
      beyond[static_cast<std::size_t>(i)] = cell->neighbor(i)->info();
    }
  }
}

/// Reads points and writes their triangulation; returns false at the end of the input or after a fault.
bool answer_next() {
  std::int64_t count = 0;
  if (!read(&count, 1) || count < 0 || count > kMostPoints) return false;
  std::vector<std::array<double, 3>> points(static_cast<std::size_t>(count));
  if (!read(points.data(), points.size())) return false;
  std::vector<Row> corners;
  std::vector<Row> neighbours;
  triangulate(points, corners, neighbours);
  const auto tetrahedra = static_cast<std::int64_t>(corners.size());
  return write(&tetrahedra, 1) && write(corners.data(), corners.size()) &&
         write(neighbours.data(), neighbours.size()) && std::fflush(stdout) == 0;
}

}  // namespace

int main() {
  try {
    while (answer_next()) {
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "meshorder-delaunay: %s\n", error.what());
    return 1;
  }
}
