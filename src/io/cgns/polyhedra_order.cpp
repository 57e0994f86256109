// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/polyhedra_order.hpp"

#include "base/index.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace meshorder::cgns {
namespace {

/// Compares cells with the corners of the faces of polyhedra.
class CornersOfPolyhedra {
 public:
  CornersOfPolyhedra(const CgnsMetadata& metadata, Index vertex_count)
      : metadata_(metadata), polyhedron_with_(static_cast<std::size_t>(vertex_count), -1) {}

  /// Returns whether the vertices of a cell are the corners of a polyhedron's faces, each once. Call it only
  /// once for each polyhedron.
  bool are_those_of(std::span<const Index> cell, Index polyhedron) {
    std::size_t corners = 0;
    for (const Index face : metadata_.polyhedra->faces_of(polyhedron)) {
      for (const Index corner : metadata_.polyhedra->corners_of(Polyhedra::polygon_of(face))) {
        Index& with = polyhedron_with_[metadata_.vertex_at(corner)];
        if (with != polyhedron) ++corners;
        with = polyhedron;
      }
    }
    if (cell.size() != corners) return false;
    return std::all_of(cell.begin(), cell.end(), [&](Index vertex) {
      return std::exchange(polyhedron_with_[vertex], -1) == polyhedron;
    });
  }

 private:
  const CgnsMetadata& metadata_;
  std::vector<Index> polyhedron_with_;  ///< for each vertex, the last polyhedron that has it as a corner
};

}  // namespace

bool polyhedra_fit(const Mesh& mesh, const CgnsMetadata& metadata) {
  if (metadata.polyhedra == nullptr) return true;
  Index cells = 0;
  for (Index p = 0; p < index_size(metadata.cell_of_polygon); ++p) {
    const Index c = metadata.cell_of_polygon[p];
    if (c < 0) continue;
    ++cells;
    if (!std::ranges::equal(mesh.cells[c], metadata.polyhedra->corners_of(p), {}, {},
                            [&](Index corner) { return metadata.vertex_at(corner); })) {
      return false;
    }
  }
  CornersOfPolyhedra corners(metadata, mesh.vertex_count());
  for (Index p = 0; p < index_size(metadata.cell_of_polyhedron); ++p) {
    const Index c = metadata.cell_of_polyhedron[p];
    if (c < 0) continue;
    ++cells;
    if (dimension(mesh.cells.shapes[c]) < 3 || !corners.are_those_of(mesh.cells[c], p)) return false;
  }
  const auto wanted =
      std::count_if(metadata.section_of_cell.begin(), metadata.section_of_cell.end(), [&](Index s) {
        return metadata.sections[s].type == kPolygons || metadata.sections[s].type == kPolyhedra;
      });
  return cells == wanted;
}

PolyhedraOrder::PolyhedraOrder(const CgnsMetadata& metadata)
    : metadata_(metadata), polygons_(metadata.sections.size()), ranks_(metadata.cell_of_polygon.size(), -1) {
  if (ranks_.empty()) return;
  const Polyhedra& polyhedra = *metadata.polyhedra;
  polyhedron_of_cell_.resize(metadata.section_of_cell.size(), -1);
  // the cells on both sides of each polygon, the lower cell first
  std::vector<std::pair<Index, Index>> sides(ranks_.size(), {-1, -1});
  bool are_moved = false;
  Index before = -1;
  for (Index p = 0; p < polyhedra.polyhedron_count(); ++p) {
    const Index cell = metadata.cell_of_polyhedron[p];
    if (cell < 0) continue;
    polyhedron_of_cell_[cell] = p;
    are_moved = are_moved || cell < before;
    before = cell;
    for (const Index face : polyhedra.faces_of(p)) {
      auto& [low, high] = sides[Polyhedra::polygon_of(face)];
      (low < 0 ? low : high) = cell;
      if (high >= 0 && high < low) std::swap(low, high);
    }
  }
  for (std::size_t s = 0; s < polygons_.size(); ++s) {
    if (metadata.sections[s].type == kPolygons) order_section(static_cast<int>(s), sides, are_moved);
  }
}

void PolyhedraOrder::order_section(int section, const std::vector<std::pair<Index, Index>>& sides,
                                   bool are_moved) {
  const Index first = metadata_.sections[section].first_item;
  const Index end = first + metadata_.sections[section].count;
  const auto cell_of = [&](Index p) { return metadata_.cell_of_polygon[p]; };
  std::vector<Index> cells;
  std::vector<Index> others;
  std::vector<bool> is_cell;
  for (Index p = first; p < end; ++p) {
    if (cell_of(p) < 0 && sides[p].first < 0) continue;
    is_cell.push_back(cell_of(p) >= 0);
    (is_cell.back() ? cells : others).push_back(p);
  }
  std::sort(cells.begin(), cells.end(), [&](Index a, Index b) { return cell_of(a) < cell_of(b); });
  if (are_moved) {
    std::stable_sort(others.begin(), others.end(), [&](Index a, Index b) { return sides[a] < sides[b]; });
  }
  auto next_cell = cells.begin();
  auto next_other = others.begin();
  std::vector<Index>& order = polygons_[section];
  order.reserve(is_cell.size());
  for (const bool of_cell : is_cell) {
    order.push_back(*(of_cell ? next_cell : next_other)++);
    ranks_[order.back()] = index_size(order) - 1;
  }
}

int PolyhedraOrder::section_of(Index polygon) const {
  std::size_t s = 0;
  const auto is_in = [&](const Section& section) {
    return section.type == kPolygons && polygon >= section.first_item &&
           polygon - section.first_item < section.count;
  };
  while (!is_in(metadata_.sections[s])) ++s;
  return static_cast<int>(s);
}

std::vector<std::int64_t> PolyhedraOrder::corner_numbers(
    int section, const std::function<std::int64_t(Index)>& number_of) const {
  const bool are_counted = metadata_.sections[section].offset_type.empty();
  std::vector<std::int64_t> numbers;
  for (const Index polygon : polygons_[section]) {
    const std::span<const Index> corners = metadata_.polyhedra->corners_of(polygon);
    if (are_counted) numbers.push_back(std::ssize(corners));
    for (const Index corner : corners) numbers.push_back(number_of(metadata_.vertex_at(corner)));
  }
  return numbers;
}

std::vector<std::int64_t> PolyhedraOrder::face_numbers(int section, const std::vector<Index>& cells,
                                                       const std::vector<std::int64_t>& first_numbers) const {
  const bool are_counted = metadata_.sections[section].offset_type.empty();
  std::vector<std::int64_t> numbers;
  for (const Index cell : cells) {
    const std::span<const Index> faces = metadata_.polyhedra->faces_of(polyhedron_of_cell_[cell]);
    if (are_counted) numbers.push_back(std::ssize(faces));
    for (const Index face : faces) {
      const Index polygon = Polyhedra::polygon_of(face);
      const std::int64_t number = first_numbers[section_of(polygon)] + ranks_[polygon];
      numbers.push_back(face < 0 ? -number : number);
    }
  }
  return numbers;
}

std::vector<std::int64_t> PolyhedraOrder::offsets(int section, const std::vector<Index>& cells) const {
  std::vector<std::int64_t> result{0};
  const auto append = [&](std::size_t size) {
    result.push_back(result.back() + static_cast<std::int64_t>(size));
  };
  if (metadata_.sections[section].type == kPolygons) {
    for (const Index p : polygons_[section]) append(metadata_.polyhedra->corners_of(p).size());
  } else {
    for (const Index c : cells) append(metadata_.polyhedra->faces_of(polyhedron_of_cell_[c]).size());
  }
  return result;
}

}  // namespace meshorder::cgns
