// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"
#include "io/vtk/vtk.hpp"
#include "io/xdmf/writer.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace meshorder::xdmf {

std::string attribute_type(Index components) {
  switch (components) {
    case 1:
      return "Scalar";
    case 2:
    case 3:
      return "Vector";
    case 6:
      return "Tensor6";
    case 9:
      return "Tensor";
    default:
      return "Matrix";
  }
}

std::optional<DataArray> Writer::marks_named(const std::string& name, Association association) const {
  if (!name.starts_with(vtk::kSetPrefix)) return {};
  const EntitySet* const set = parts_.set(std::string_view(name).substr(vtk::kSetPrefix.size()), association);
  return set != nullptr ? std::optional(vtk::marks_of(*set, item_count(mesh_, association))) : std::nullopt;
}

void Writer::add_others() {
  std::set<std::pair<Association, std::string>> covered;
  for (const Field& field : layout_.fields) {
    if (field.role == Field::Role::data && covered.emplace(field.association, field.name).second)
      (void)names_[field.association].take(field.name);
  }
  const std::set<std::pair<Association, std::string>> placed = placed_sets();
  for (const DataArray& array : mesh_.data) {
    if (!covered.contains({array.association, array.name}) || are_texts(array.values)) add_array(array);
  }
  for (const EntitySet& set : mesh_.sets) {
    if (placed.contains({set.association, set.name}) ||
        covered.contains({set.association, std::string(vtk::kSetPrefix) + set.name}))
      continue;
    const DataArray marks = vtk::marks_of(set, item_count(mesh_, set.association));
    notes_.push_back(fmt::format("the set '{}' of {} is written as the array '{}'", set.name,
                                 to_string(set.association), marks.name));
    add_array(marks);
  }
  add_ids(mesh_.vertex_ids, "vertex_id", Association::vertices);
  add_ids(mesh_.cell_ids, "cell_id", Association::cells);
}

std::set<std::pair<Association, std::string>> Writer::placed_sets() const {
  std::set<std::pair<Association, std::string>> placed;
  if (layout_.is_made) return placed;
  for (const TopologyPart& part : layout_.parts) {
    if (!part.set.empty()) placed.emplace(Association::cells, part.set);
  }
  for (const Field& field : layout_.fields) {
    if (field.role == Field::Role::members) placed.emplace(field.association, field.name);
  }
  return placed;
}

void Writer::add_ids(const std::vector<std::int64_t>& ids, const char* name, Association association) {
  if (ids.empty()) return;
  notes_.push_back(fmt::format("the ids of {} are written as the array '{}'", to_string(association), name));
  add_array({.name = name, .association = association, .values = ids});
}

void Writer::add_array(const DataArray& array) {
  if (are_texts(array.values)) return note_array_unsupported(array, "XDMF", notes_);
  note_component_names_unsupported(array, "XDMF", notes_);
  const std::string name =
      names_[array.association].take(array.name.empty() ? "array" : xml_text(array.name));
  note_renamed_array(array, name, notes_);
  if (array.association == Association::vertices) {
    const std::optional<Values> values = values_of(array, array.association, 0);
    add_attribute(0, array, name, values ? *values : array.values);
    return;
  }
  for (std::size_t p = 0; p < rows_.size(); ++p) {
    if (!layout_.parts[p].has_own_cells || rows_[p].empty() || !has_rows(array, rows_[p])) continue;
    const auto part = static_cast<int>(p);
    const std::optional<Values> values = values_of(array, array.association, part);
    const bool is_label = name == kLabel && part > 0;
    add_attribute(part, array, is_label ? layout_.parts[p].name : name, values ? *values : array.values);
  }
}

bool Writer::has_rows(const DataArray& array, const std::vector<Index>& cells) const {
  if (array.is_dense()) return true;
  const std::vector<Index> place = places_in(cells);
  return std::any_of(array.indices.begin(), array.indices.end(), [&](Index c) { return place[c] >= 0; });
}

void Writer::add_attribute(int part, const DataArray& array, const std::string& name, const Values& values) {
  // in a series, the first Grid gets the attribute
  pugi::xml_node element = grids_[layout_.parts[part].grid].append_child("Attribute");
  set_attribute(element, "Name", name);
  set_attribute(element, "AttributeType", attribute_type(array.components));
  set_attribute(element, "Center", array.association == Association::vertices ? "Node" : "Cell");
  pugi::xml_node item = element.append_child("DataItem");
  const auto components = static_cast<std::size_t>(array.components);
  const std::vector<std::uint64_t> shape = describe(item, values, components);
  set_attribute(item, "Format", files_.empty() ? "XML" : "HDF");
  if (files_.empty()) {
    set_text(item, text_of_values(values, components));
    return;
  }
  auto& [old_name, output] = *files_.begin();
  put_apart(item, old_name, unused_dataset(output, part, name), values, shape);
}

std::string Writer::unused_dataset(Hdf5Output& output, int part, const std::string& name) {
  // the file may have datasets that the XML does not name
  const auto take = [&](const std::string& path) {
    return output.datasets.insert(path).second && !output.file->has(path);
  };
  const bool is_tags = part > 0 && name.ends_with("_tags");
  if (is_tags) {
    std::string path = "/MeshTags/" + name + "/Values";
    if (take(path)) return path;
  }
  while (true) {
    std::string path = fmt::format("/Attributes/{}", output.next_array++);
    if (take(path)) return path;
  }
}

}  // namespace meshorder::xdmf
