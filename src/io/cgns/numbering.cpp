// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/numbering.hpp"

#include "base/index.hpp"

#include <algorithm>

namespace meshorder::cgns {

Numbering::Numbering(const Mesh& mesh, const CgnsMetadata& metadata)
    : mesh_(mesh),
      metadata_(metadata),
      polygons_(metadata.sections.size()),
      polygon_ranks_(metadata.cell_of_polygon.size(), -1),
      cells_(metadata.sections.size()),
      cell_ranks_(mesh.cells.shapes.size()),
      centred_counts_(metadata.zones.size()) {
  place_vertices();
  place_polygons();
  place_cells();
}

void Numbering::place_vertices() {
  if (metadata_.zone_of_vertex.empty()) return;
  vertices_.resize(metadata_.zones.size());
  vertex_numbers_.resize(mesh_.points.size());
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    auto& vertices = vertices_[metadata_.zone_of_vertex[v]];
    vertices.push_back(v);
    vertex_numbers_[v] = index_size(vertices);
  }
}

void Numbering::place_polygons() {
  if (polygon_ranks_.empty()) return;
  const Polyhedra& polyhedra = *metadata_.polyhedra;
  polyhedra_.resize(metadata_.section_of_cell.size(), -1);
  // the cells on both sides of each polygon, the lower cell first
  std::vector<std::pair<Index, Index>> sides(polygon_ranks_.size(), {-1, -1});
  bool are_moved = false;
  Index before = -1;
  for (Index p = 0; p < polyhedra.polyhedron_count(); ++p) {
    const Index cell = metadata_.cell_of_polyhedron[p];
    if (cell < 0) continue;
    polyhedra_[cell] = p;
    are_moved = are_moved || cell < before;
    before = cell;
    for (const Index face : polyhedra.faces_of(p)) {
      auto& [low, high] = sides[Polyhedra::polygon_of(face)];
      (low < 0 ? low : high) = cell;
      if (high >= 0 && high < low) std::swap(low, high);
    }
  }
  for (std::size_t s = 0; s < polygons_.size(); ++s) {
    if (metadata_.sections[s].type == kPolygons) order_polygons(static_cast<int>(s), sides, are_moved);
  }
}

void Numbering::order_polygons(int section, const std::vector<std::pair<Index, Index>>& sides,
                               bool are_moved) {
  const Index first = metadata_.sections[section].first_item;
  const auto cell_of = [&](Index p) { return metadata_.cell_of_polygon[p]; };
  std::vector<Index> cells;
  std::vector<Index> others;
  std::vector<bool> is_cell;
  for (Index p = first; p < first + metadata_.sections[section].count; ++p) {
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
    polygon_ranks_[order.back()] = index_size(order) - 1;
  }
}

void Numbering::place_cells() {
  for (Index c = 0; c < mesh_.cell_count(); ++c) {
    auto& cells = cells_[metadata_.section_of_cell[c]];
    cell_ranks_[c] = index_size(cells);
    cells.push_back(c);
  }
  for (Index p = 0; p < index_size(polygon_ranks_); ++p) {
    if (const Index c = metadata_.cell_of_polygon[p]; c >= 0) cell_ranks_[c] = polygon_ranks_[p];
  }
  std::vector<std::int64_t> next(metadata_.zones.size(), 1);
  for (std::size_t s = 0; s < cells_.size(); ++s) {
    const Section& section = metadata_.sections[s];
    const Index count = index_size(elements_of(static_cast<int>(s)));
    is_whole_ = is_whole_ && count == section.count;
    first_numbers_.push_back(next[section.zone]);
    next[section.zone] += count;
    for (const Index c : cells_[s]) {
      if (dimension(mesh_.cells.shapes[c]) == metadata_.cell_dimension) ++centred_counts_[section.zone];
    }
  }
  for (std::size_t s = 0; is_whole_ && s < cells_.size(); ++s)
    first_numbers_[s] = metadata_.sections[s].first;
}

Index Numbering::vertex_count(int zone) const {
  return vertices_.empty() ? mesh_.vertex_count() : index_size(vertices_[zone]);
}

Index Numbering::vertex_at(int zone, Index place) const {
  return vertices_.empty() ? place : vertices_[zone][place];
}

Index Numbering::number_of_vertex(Index v) const {
  return vertex_numbers_.empty() ? v + 1 : vertex_numbers_[v];
}

const std::vector<Index>& Numbering::elements_of(int section) const {
  return metadata_.sections[section].type == kPolygons ? polygons_[section] : cells_[section];
}

std::int64_t Numbering::number_of_cell(Index c) const {
  return first_numbers_[metadata_.section_of_cell[c]] + cell_ranks_[c];
}

std::int64_t Numbering::number_of_polygon(Index p) const {
  const auto section =
      std::find_if(metadata_.sections.begin(), metadata_.sections.end(), [&](const Section& one) {
        return one.type == kPolygons && p >= one.first_item && p - one.first_item < one.count;
      });
  return first_numbers_[section - metadata_.sections.begin()] + polygon_ranks_[p];
}

std::vector<Index> Numbering::rows_of(const Field& field) const {
  if (field.section >= 0) return cells_[field.section];
  if (field.list >= 0) return metadata_.lists[field.list].members;
  if (field.association == Association::vertices) {
    return vertices_.empty() ? index_range(0, mesh_.vertex_count()) : vertices_[field.place];
  }
  std::vector<Index> rows;
  for (std::size_t s = 0; s < cells_.size(); ++s) {
    if (metadata_.sections[s].zone != field.place) continue;
    for (const Index c : cells_[s]) {
      if (dimension(mesh_.cells.shapes[c]) == metadata_.cell_dimension) rows.push_back(c);
    }
  }
  return rows;
}

}  // namespace meshorder::cgns
