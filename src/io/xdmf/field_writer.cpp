// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/exact_values.hpp"
#include "io/unsupported.hpp"
#include "io/xdmf/writer.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>

namespace meshorder::xdmf {
namespace {

bool is_identity(const std::vector<Index>& rows, Index count) {
  if (index_size(rows) != count) return false;
  for (Index i = 0; i < count; ++i) {
    if (rows[i] != i) return false;
  }
  return true;
}

}  // namespace

pugi::xml_node Writer::element_of(const Field& field) const { return items_[field.place.named_by].parent(); }

void Writer::part_references() {
  const auto for_each_place = [&](const auto& visit) {
    for (Field& field : fields_) {
      visit(field, field.place.item, field.place.named_by);
      for (DataPlace::Repeat& repeat : field.place.repeats) visit(field, repeat.item, repeat.named_by);
    }
  };
  std::map<std::size_t, const Field*> first;  // first field of each DataItem
  std::set<std::size_t> shared;
  for_each_place([&](const Field& field, std::size_t item, std::size_t /*named_by*/) {
    if (first.emplace(item, &field).first->second != &field) shared.insert(item);
  });
  for_each_place([&](const Field& /*field*/, std::size_t& item, std::size_t named_by) {
    if (item == named_by || !shared.contains(item)) return;
    pugi::xml_node own = items_[named_by];
    own.remove_attributes();
    for (const pugi::xml_attribute attribute : items_[item].attributes()) {
      if (!own.append_copy(attribute)) throw std::bad_alloc();
    }
    set_text(own, items_[item].text().get());
    item = named_by;
  });
}

void Writer::write_field(const Field& field) {
  switch (field.role) {
    case Field::Role::points:
      return write_points(field);
    case Field::Role::connectivity:
      return write_topology(field);
    case Field::Role::members:
      return write_set(field);
    default:
      return write_array(field);
  }
}

void Writer::write_points(const Field& field) {
  const bool is_flat = same_but_for_case(attribute(element_of(field), "GeometryType", "Type"), "XY");
  const std::size_t width = field.axis >= 0 ? 1 : is_flat ? 2 : 3;
  const auto coordinate = [&](std::size_t v, std::size_t k) {
    return mesh_.points[v][field.axis >= 0 ? static_cast<std::size_t>(field.axis) : k];
  };
  const std::size_t count = mesh_.points.size() * width;
  constexpr std::size_t kFloatAlternative = 1;
  const bool floats = field.place.alternative == kFloatAlternative && are_float_points(mesh_.points);
  const Values values =
      numbers_of_type(floats ? kFloatAlternative : 0, [&]<class Number>(std::vector<Number>& numbers) {
        numbers.resize(count);
        for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
          for (std::size_t k = 0; k < width; ++k)
            numbers[v * width + k] = static_cast<Number>(coordinate(v, k));
        }
      });
  put(field.place, values, width);
}

void Writer::write_topology(const Field& field) {
  const std::vector<Index>& rows = rows_[field.part];
  pugi::xml_node topology = element_of(field);
  const bool was_mixed = same_but_for_case(attribute(topology, "TopologyType", "Type"), "Mixed");
  const TopologyType* const type = was_mixed ? nullptr : common_type(rows);
  const auto nodes =
      type == nullptr ? std::size_t{1} : static_cast<std::size_t>(mesh_.cells.vertex_count(rows.front()));
  if (!was_mixed && !rows.empty()) {
    const std::string name = attribute(topology, "TopologyType", "Type");
    if (type == nullptr || topology_type(name) != type) {
      set_either(topology, "TopologyType", "Type", std::string(type == nullptr ? "Mixed" : type->name));
    }
    if (type != nullptr && (layout_.is_made || type->nodes == 0)) {
      set_attribute(topology, "NodesPerElement", std::to_string(nodes));
    }
  }
  announce_cells(topology, rows.size());
  for (const DataPlace::Repeat& repeat : field.place.repeats) {
    announce_cells(items_[repeat.named_by].parent(), rows.size());
  }
  if (type != nullptr && field.base == 0 && is_identity(rows, mesh_.cell_count()) &&
      !is_turned(rows.front())) {
    return put_indices(field.place, mesh_.cells.vertices, nodes);
  }
  put_indices(field.place, numbers_of(rows, type == nullptr, field.base), nodes);
}

void Writer::announce_cells_of(const Field& field) const {
  const pugi::xml_node topology = element_of(field);
  const auto nodes =
      static_cast<std::uint64_t>(topology_type(attribute(topology, "TopologyType", "Type"))->nodes);
  announce_cells(topology, field.place.count() / nodes);
}

void Writer::announce_cells(pugi::xml_node topology, std::uint64_t cells) const {
  if (layout_.is_made || topology.attribute("NumberOfElements")) {
    set_attribute(topology, "NumberOfElements", std::to_string(cells));
  } else if (topology.attribute("Dimensions")) {
    set_attribute(topology, "Dimensions", std::to_string(cells));
  }
}

bool Writer::is_turned(Index c) const {
  constexpr int kCorners = 6;
  return !layout_.inward_wedges && mesh_.cells.shapes[c] == Shape::wedge &&
         mesh_.cells.vertex_count(c) == kCorners;
}

const TopologyType* Writer::common_type(const std::vector<Index>& rows) const {
  if (rows.empty()) return nullptr;
  const Shape shape = mesh_.cells.shapes[rows.front()];
  const int vertices = mesh_.cells.vertex_count(rows.front());
  const bool common = std::all_of(rows.begin(), rows.end(), [&](Index c) {
    return mesh_.cells.shapes[c] == shape && mesh_.cells.vertex_count(c) == vertices;
  });
  return common ? topology_type_of(shape, vertices) : nullptr;
}

std::vector<Index> Writer::numbers_of(const std::vector<Index>& rows, bool mixed, int base) const {
  constexpr std::array<std::size_t, 6> kTurned{0, 2, 1, 3, 5, 4};
  std::size_t size = 0;
  for (const Index c : rows) size += static_cast<std::size_t>(mesh_.cells.vertex_count(c)) + (mixed ? 2 : 0);
  std::vector<Index> numbers;
  numbers.reserve(size);
  for (const Index c : rows) {
    const auto cell = mesh_.cells[c];
    if (mixed) {
      const TopologyType& type = *topology_type_of(mesh_.cells.shapes[c], static_cast<int>(cell.size()));
      numbers.push_back(type.number);
      if (type.nodes == 0) numbers.push_back(static_cast<Index>(cell.size()));
    }
    if (is_turned(c)) {
      for (const std::size_t k : kTurned) numbers.push_back(cell[k] + base);
    } else {
      for (const Index v : cell) numbers.push_back(v + base);
    }
  }
  return numbers;
}

void Writer::write_array(const Field& field) {
  const DataArray* array = parts_.array(field.name, field.association);
  std::optional<DataArray> made;
  if (array == nullptr) {
    made = marks_named(field.name, field.association);
    array = made ? &*made : nullptr;
  }
  if (array == nullptr || are_texts(array->values)) return void(gone_.insert(&field));
  const std::optional<Values> own = values_of(*array, field.association, field.part);
  const Values& values = own ? *own : array->values;
  if (size_of(values) != field.place.count()) {
    const std::string type = attribute_type(array->components);
    set_either(element_of(field), "AttributeType", "Type", type);
    for (const DataPlace::Repeat& repeat : field.place.repeats)
      set_either(items_[repeat.named_by].parent(), "AttributeType", "Type", type);
  }
  put(field.place, values, static_cast<std::size_t>(array->components));
}

void Writer::write_set(const Field& field) {
  const EntitySet* const set = parts_.set(field.name, field.association);
  if (set == nullptr) return void(gone_.insert(&field));
  const bool on_cells = field.association == Association::cells;
  std::vector<Index> place;
  if (on_cells) place = places_in(rows_[field.part]);
  std::vector<Index> numbers;
  for (const Index member : set->members) {
    const Index row = on_cells ? place[member] : member;
    if (row >= 0) numbers.push_back(row);
  }
  put_indices(field.place, numbers, 1);
}

void Writer::remove_gone() {
  if (gone_.empty()) return;
  std::set<pugi::xml_node> elements;
  for (const Field* const field : gone_) {
    const auto remove = [&](std::size_t item, std::size_t named_by) {
      elements.insert(items_[named_by].parent());
      if (item != named_by) elements.insert(items_[item]);
    };
    remove(field->place.item, field->place.named_by);
    for (const DataPlace::Repeat& repeat : field->place.repeats) remove(repeat.item, repeat.named_by);
  }
  std::erase_if(elements, [&](pugi::xml_node element) {  // this element is removed with the element around it
    while ((element = element.parent()) && !elements.contains(element)) {
    }
    return static_cast<bool>(element);
  });
  for (pugi::xml_node element : elements) element.parent().remove_child(element);
  std::set<std::pair<std::string, std::string>> named;
  for (const pugi::xml_node item : elements_named(xml_, "DataItem")) {
    named.insert(split_hdf5_name(item.text().get()));
  }
  for (const Field* const field : gone_) {
    const DataPlace& place = field->place;
    if (place.format == DataPlace::Format::hdf && named.emplace(place.file, place.dataset).second)
      files_.at(place.file).file->remove(place.dataset);
  }
}

std::vector<Index> Writer::places_in(const std::vector<Index>& rows) const {
  std::vector<Index> place(mesh_.cells.shapes.size(), -1);
  for (Index r = 0; r < index_size(rows); ++r) place[rows[r]] = r;
  return place;
}

std::optional<Values> Writer::values_of(const DataArray& array, Association association, int part) {
  const bool on_vertices = association == Association::vertices;
  const Index count = item_count(mesh_, association);
  const std::vector<Index> row_of = rows_by_item(array, count);
  std::vector<Index> rows_of_cells;
  if (!on_vertices) {
    const std::vector<Index>& cells = rows_[part];
    if (array.is_dense() && !is_identity(cells, count))
      return rows_of_values(array.values, array.components, cells);
    if (!array.is_dense()) {
      for (const Index c : cells) rows_of_cells.push_back(row_of[c]);
    }
  }
  if (array.is_dense()) return {};
  const std::vector<Index>& rows = on_vertices ? row_of : rows_of_cells;
  if (std::find(rows.begin(), rows.end(), -1) != rows.end()) {
    Notes note;
    note_filled(array, missing_word(array.values), note);
    if (std::find(notes_.begin(), notes_.end(), note.front()) == notes_.end()) notes_.push_back(note.front());
  }
  return rows_of_values(array.values, array.components, rows);
}

}  // namespace meshorder::xdmf
