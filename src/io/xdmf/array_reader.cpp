// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/xdmf/reading.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

// Reads Attributes and Sets. The Attributes of several Grids may become one array, and their Sets one set.

namespace meshorder::xdmf {
void ArrayReader::add_moved_points(const GridElement& grid, std::vector<Field>& fields,
                                   std::vector<Point> points, int dimension) {
  if (fields.size() != 1) {
    throw reading_.document.error(grid.element, "points that move are given axis by axis",
                                  "write them as XYZ");
  }
  DataArray array;
  array.name = fmt::format("points step {}", grid.step);
  array.components = dimension;
  std::vector<double> values;
  values.reserve(points.size() * static_cast<std::size_t>(dimension));
  for (const Point& point : points) values.insert(values.end(), point.begin(), point.begin() + dimension);
  array.values = std::move(values);
  Field& field = reading_.layout->fields.emplace_back(fields.front());
  field.role = Field::Role::data;
  field.name = add_growing(std::move(array));
}

std::string ArrayReader::add_growing(DataArray array) {
  array.name = array_names_.take(array.association, array.name);
  place_of_array_.emplace(std::pair(array.association, array.name), arrays_.size());
  arrays_.push_back({std::move(array), {}});
  return arrays_.back().array.name;
}

std::string ArrayReader::name_of(pugi::xml_node element) const {
  std::string name = element.attribute("Name").value();
  if (name.empty())
    throw reading_.document.error(element, fmt::format("the <{}> has no Name", element.name()),
                                  "it is needed");
  return name;
}

void ArrayReader::read_attribute(const GridElement& grid, int part, pugi::xml_node element) {
  const std::string name = name_of(element);
  std::string center = attribute(element, "Center");
  const std::string kind = attribute(element, "ItemType");
  if (same_but_for_case(kind, "FiniteElementFunction") || items_of(element).size() > 1) {
    throw reading_.document.error(
        element,
        fmt::format("the attribute '{}' is a finite element function by its degrees of freedom", name),
        "write its values at points or cells (in FEniCS: write, not write_checkpoint)");
  }
  if (center.empty()) center = "Node";
  if (same_but_for_case(center, "Grid")) return read_of_grid(reading_.item_of(element), name);
  const bool on_vertices = same_but_for_case(center, "Node");
  if (!on_vertices && !same_but_for_case(center, "Cell")) {
    throw reading_.document.error(element,
                                  fmt::format("the attribute '{}' is on each {}", name, shortened(center)),
                                  "attributes of Node, Cell and Grid can be moved with the mesh");
  }
  Field field{Field::Role::data, reading_.data.place_of(reading_.item_of(element))};
  field.part = on_vertices ? 0 : part;
  field.association = on_vertices ? Association::vertices : Association::cells;
  const std::string key = fmt::format("{} {} {}", key_of(field.place), field.part, on_vertices);
  const auto [known, is_new] = known_arrays_.try_emplace(key + name);
  if (!is_new) {
    if (known->second) pending_[*known->second].field.place.repeat(field.place);
    return;
  }

  DataArray array;
  array.association = field.association;
  array.values = reading_.data.read(field.place);
  const Index rows = on_vertices ? reading_.mesh.vertex_count() : index_size(reading_.rows[part]);
  const std::size_t values = size_of(array.values);
  if (rows == 0 ? values != 0 : (values == 0 || values % static_cast<std::size_t>(rows) != 0)) {
    throw reading_.document.error(element, fmt::format("the attribute '{}' has {} values", name, values),
                                  fmt::format("the Grid has {} {}", rows, on_vertices ? "points" : "cells"));
  }
  if (rows == 0) return;
  array.components = static_cast<Index>(values / static_cast<std::size_t>(rows));
  array.name = name;
  if (is_label(field, array)) take_label(field, array);
  known->second = pending_.size();
  pending_.push_back({std::move(field), std::move(array), grid});
}

void ArrayReader::read_of_grid(pugi::xml_node item, const std::string& name) {
  const DataPlace place = reading_.data.place_of(item);  // also opens the file, so that the file is kept
  if (place.format == DataPlace::Format::binary) {
    throw reading_.document.error(item,
                                  fmt::format("the attribute '{}' of the Grid is in a binary file", name),
                                  "write it as XML or HDF");
  }
  reading_.layout->words.push_back(fmt::format("the attribute '{}' of the whole grid", name));
}

bool ArrayReader::is_label(const Field& field, const DataArray& array) const {
  if (array.association == Association::vertices || array.components != 1 || !are_integers(array.values)) {
    return false;
  }
  const std::string& dataset = field.place.dataset;
  return array.name == kLabel || (field.part > 0 && (array.name == reading_.layout->parts[field.part].name ||
                                                     dataset.starts_with("/MeshTags/") ||
                                                     dataset.starts_with("/MeshValueCollection/")));
}

void ArrayReader::take_label(const Field& field, DataArray& array) {
  const std::vector<Index>& rows = reading_.rows[field.part];
  if (labelled_.size() < reading_.cells.types.size()) labelled_.resize(reading_.cells.types.size(), false);
  const auto has_label = [&](Index c) { return labelled_[c]; };
  if (std::any_of(rows.begin(), rows.end(), has_label)) return;
  for (const Index c : rows) labelled_[c] = true;
  array.name = kLabel;
}

void ArrayReader::read_set(int part, pugi::xml_node element) {
  const std::string name = name_of(element);
  const std::string type = attribute(element, "SetType", "Type");
  const bool on_vertices = same_but_for_case(type, "Node");
  if (!on_vertices && !same_but_for_case(type, "Cell")) {
    throw reading_.document.error(element,
                                  fmt::format("the set '{}' is of the type '{}'", name, shortened(type)),
                                  "sets of Node and Cell can be moved with the mesh");
  }
  if (element.child("Attribute")) {
    throw reading_.document.error(element, fmt::format("the set '{}' has attributes of its own", name),
                                  "attributes of Grids can be moved with the mesh");
  }
  const pugi::xml_node item = reading_.item_of(element);
  Field field{Field::Role::members, reading_.data.place_of(item)};
  field.part = on_vertices ? 0 : part;
  field.association = on_vertices ? Association::vertices : Association::cells;
  field.name = name;
  const std::string key = fmt::format("{} {} {} ", key_of(field.place), field.part, on_vertices);
  const auto [known, is_new] = known_sets_.try_emplace(key + name, reading_.layout->fields.size());
  if (!is_new) return reading_.layout->fields[known->second].place.repeat(field.place);
  const std::vector<Index> members = reading_.data.read_indices(field.place);
  const std::vector<Index>& rows = reading_.rows[part];
  const Index count = on_vertices ? reading_.mesh.vertex_count() : index_size(rows);
  std::vector<bool> taken(static_cast<std::size_t>(count), false);
  EntitySet& set = reading_.set_of(field);
  for (const Index member : members) {
    if (member < 0 || member >= count || taken[member]) {
      throw reading_.document.error(
          item,
          fmt::format("the set '{}' names {}{}", name, member, member >= 0 && member < count ? " twice" : ""),
          fmt::format("the Grid has {} to {}", 0, count - 1));
    }
    taken[member] = true;
    set.members.push_back(on_vertices ? static_cast<Index>(member) : rows[member]);
  }
  reading_.layout->fields.push_back(field);
}

void ArrayReader::finish() {
  std::map<std::tuple<std::string, Association, int>, int> counts;
  for (const Pending& pending : pending_)
    ++counts[{pending.array.name, pending.array.association, pending.grid.series}];
  for (Pending& pending : pending_) {
    const bool in_series = pending.grid.series >= 0 &&
                           counts[{pending.array.name, pending.array.association, pending.grid.series}] > 1;
    if (in_series) pending.array.name += fmt::format(" step {}", pending.grid.step);
    pending.field.name = add(std::move(pending.array), pending.field.part);
    reading_.layout->fields.push_back(std::move(pending.field));
  }
  for (GrowingArray& growing : arrays_) {
    make_dense(growing.array, reading_.mesh.cell_count());
    vtk::add_array(reading_.mesh, std::move(growing.array));
  }
}

std::string ArrayReader::add(DataArray array, int part) {
  if (array.association == Association::vertices) return add_growing(std::move(array));
  const std::vector<Index>& rows = reading_.rows[part];
  const auto found = place_of_array_.find({Association::cells, array.name});
  if (found == place_of_array_.end() || !append_rows(arrays_[found->second], array, rows)) {
    if (index_size(rows) != reading_.mesh.cell_count() || !std::is_sorted(rows.begin(), rows.end()))
      array.indices = rows;
    return add_growing(std::move(array));
  }
  return array.name;
}

bool ArrayReader::append_rows(GrowingArray& growing, DataArray& array, const std::vector<Index>& rows) const {
  DataArray& all = growing.array;
  const bool same_type = all.values.index() == array.values.index();
  const bool may_join =
      same_type || (array.name == kLabel && are_integers(all.values) && are_integers(array.values));
  if (all.is_dense() || all.components != array.components || !may_join) return false;
  if (growing.has_row.empty()) {
    growing.has_row.assign(reading_.mesh.cells.shapes.size(), false);
    for (const Index c : all.indices) growing.has_row[c] = true;
  }
  if (std::any_of(rows.begin(), rows.end(), [&](Index c) { return growing.has_row[c]; })) return false;
  if (!same_type) {
    all.values = vtk::integers_of<std::int64_t>(all.values);
    array.values = vtk::integers_of<std::int64_t>(array.values);
  }
  for (const Index c : rows) growing.has_row[c] = true;
  all.indices.insert(all.indices.end(), rows.begin(), rows.end());
  append_values(all.values, std::move(array.values));
  return true;
}

}  // namespace meshorder::xdmf
