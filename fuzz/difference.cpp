// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/difference.hpp"

#include "support/sample_meshes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

namespace meshorder::fuzz {
namespace {

template <class T>
bool same(const T& a, const T& b) {
  if constexpr (std::is_same_v<T, double>) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
           (std::isnan(a) && std::isnan(b));
  } else if constexpr (std::is_same_v<T, float>) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
           (std::isnan(a) && std::isnan(b));
  } else {
    return a == b;
  }
}

bool same_values(const Values& a, const Values& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&](const auto& values) {
        const auto& others = std::get<std::decay_t<decltype(values)>>(b);
        return std::equal(values.begin(), values.end(), others.begin(), others.end(),
                          [](const auto& x, const auto& y) { return same(x, y); });
      },
      a);
}

bool same_points(const std::vector<Point>& a, const std::vector<Point>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Point& p, const Point& q) {
    return same(p[0], q[0]) && same(p[1], q[1]) && same(p[2], q[2]);
  });
}

bool near_points(const std::vector<Point>& a, const std::vector<Point>& b) {
  constexpr double kRounding = 1e-6;
  const auto near = [&](double x, double y) {
    return std::abs(x - y) <= kRounding * std::max({std::abs(x), std::abs(y), kRounding});
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const Point& p, const Point& q) {
    return near(p[0], q[0]) && near(p[1], q[1]) && near(p[2], q[2]);
  });
}

/// Returns, cell by cell, the points of each cell's vertices.
std::vector<Point> corners_of(const Mesh& mesh) {
  std::vector<Point> result;
  for (const Index v : mesh.cells.vertices) result.push_back(mesh.points[static_cast<std::size_t>(v)]);
  return result;
}

/// Returns the cells in ascending order, each as its vertices in ascending order.
std::vector<std::vector<Index>> sorted_cells(const Cells& cells) {
  std::vector<std::vector<Index>> result;
  for (Index c = 0; c < cells.size(); ++c) {
    result.emplace_back(cells[c].begin(), cells[c].end());
    std::sort(result.back().begin(), result.back().end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Returns arrays or sets sorted by association and name; those with the same name keep their order. A file
/// may list them in another order.
template <class Named>
std::vector<const Named*> by_name(const std::vector<Named>& all) {
  std::vector<const Named*> result(all.size());
  std::transform(all.begin(), all.end(), result.begin(), [](const Named& one) { return &one; });
  std::stable_sort(result.begin(), result.end(), [](const Named* a, const Named* b) {
    return std::tie(a->association, a->name) < std::tie(b->association, b->name);
  });
  return result;
}

std::string difference_of_arrays(const DataArray& a, const DataArray& b) {
  const std::string name = "the array '" + b.name + "' on " + std::string(to_string(b.association));
  if (a.name != b.name || a.association != b.association) return name + " is gone";
  if (a.components != b.components) return name + " has another number of components";
  if (a.indices != b.indices) return name + " has rows of other vertices or cells";
  if (a.component_names != b.component_names) return name + " has other names of components";
  if (!same_values(a.values, b.values)) return name + " has other values";
  return {};
}

/// Returns the ids; an empty list if they are 1, 2, 3, … Such ids hold no information, since Gmsh files
/// always number their nodes.
std::vector<std::int64_t> told_ids(const std::vector<std::int64_t>& ids) {
  std::int64_t next = 1;
  const bool counts = std::all_of(ids.begin(), ids.end(), [&](std::int64_t id) { return id == next++; });
  return counts ? std::vector<std::int64_t>() : ids;
}

std::string difference_of_data(const Mesh& a, const Mesh& b) {
  if (a.data.size() != b.data.size()) {
    return std::to_string(a.data.size()) + " arrays for " + std::to_string(b.data.size());
  }
  const std::vector<const DataArray*> found_arrays = by_name(a.data);
  const std::vector<const DataArray*> expected_arrays = by_name(b.data);
  for (std::size_t i = 0; i < expected_arrays.size(); ++i) {
    std::string found = difference_of_arrays(*found_arrays[i], *expected_arrays[i]);
    if (!found.empty()) return found;
  }
  if (a.sets.size() != b.sets.size()) {
    return std::to_string(a.sets.size()) + " sets for " + std::to_string(b.sets.size());
  }
  const std::vector<const EntitySet*> found_sets = by_name(a.sets);
  const std::vector<const EntitySet*> expected_sets = by_name(b.sets);
  for (std::size_t i = 0; i < expected_sets.size(); ++i) {
    if (!(*found_sets[i] == *expected_sets[i])) return "the set '" + expected_sets[i]->name + "' differs";
  }
  if (told_ids(a.vertex_ids) != told_ids(b.vertex_ids)) return "ids of vertices differ";
  if (told_ids(a.cell_ids) != told_ids(b.cell_ids)) return "ids of cells differ";
  if (a.cell_blocks != b.cell_blocks) return "blocks of cells differ";
  return {};
}

/// Returns whether two cells of the same shape have the same vertices in the same order, or are mirrored
/// linear wedges: VTK's files do not define a wedge's orientation, and the reader may mirror a wedge without
/// a sensible volume.
bool same_cell(std::span<const Index> a, std::span<const Index> b) {
  if (std::equal(a.begin(), a.end(), b.begin(), b.end())) return true;
  constexpr std::array<std::size_t, 6> kMirrored{0, 2, 1, 3, 5, 4};
  if (a.size() != kMirrored.size() || b.size() != kMirrored.size()) return false;
  std::size_t k = 0;
  return std::all_of(b.begin(), b.end(), [&](Index v) { return v == a[kMirrored[k++]]; });
}

}  // namespace

std::string difference(const Mesh& found, const Mesh& expected, Extent extent) {
  if (found.cells.size() != expected.cells.size()) {
    return std::to_string(found.cells.size()) + " cells for " + std::to_string(expected.cells.size());
  }
  switch (extent) {
    case Extent::corners:
      return corners_of(found) == corners_of(expected) ? "" : "corners of cells differ";
    case Extent::pairs:
      return sorted_cells(found.cells) == sorted_cells(expected.cells) ? "" : "entries differ";
    case Extent::points_and_cells:
      if (!near_points(found.points, expected.points)) return "points differ by more than rounding";
      return found.cells == expected.cells ? "" : "cells differ";
    case Extent::all:
      if (!same_points(found.points, expected.points)) return "points differ";
      if (!(found.cells == expected.cells)) return "cells differ";
  }
  return difference_of_data(test::sorted_members(found), test::sorted_members(expected));
}

namespace {

/// Returns whether a format without polygons may have changed one shape to the other: its files give only the
/// number of corners.
bool same_shape(Shape a, Shape b, std::size_t corners) {
  const auto is_face = [&](Shape shape) {
    return shape == Shape::polygon || (shape == Shape::triangle && corners == 3) ||
           (shape == Shape::quad && corners == 4);
  };
  const auto is_line = [&](Shape shape) {
    return corners == 2 && (shape == Shape::line || shape == Shape::polyline);
  };
  const auto is_point = [&](Shape shape) {
    return corners == 1 && (shape == Shape::vertex || shape == Shape::poly_vertex);
  };
  return a == b || (is_face(a) && is_face(b)) || (is_line(a) && is_line(b)) || (is_point(a) && is_point(b));
}

}  // namespace

std::string difference_of_cells(const Cells& found, const Cells& expected, const Permutation& places) {
  if (found.size() != expected.size()) {
    return std::to_string(found.size()) + " cells for " + std::to_string(expected.size());
  }
  for (Index c = 0; c < expected.size(); ++c) {
    const Index place = places.old_to_new()[static_cast<std::size_t>(c)];
    const auto a = found[place];
    const auto b = expected[c];
    if (!same_shape(found.shapes[static_cast<std::size_t>(place)],
                    expected.shapes[static_cast<std::size_t>(c)], b.size()) ||
        !same_cell(a, b)) {
      return "cell " + std::to_string(c) + " differs";
    }
  }
  return {};
}

}  // namespace meshorder::fuzz
