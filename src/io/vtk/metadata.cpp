// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/exact_values.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"
#include "io/vtk/vtk.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace meshorder::vtk {
namespace {

/// Returns the members of a set from an array of marks or ranks; nullopt if the array has neither marks nor
/// ranks.
template <class Number>
std::optional<std::vector<Index>> members_of(const std::vector<Number>& marks) {
  Index count = 0;
  bool ranks = false;
  for (const Number mark : marks) {
    if (std::cmp_less(mark, 0) || std::cmp_greater(mark, marks.size())) return {};
    count += mark != 0 ? 1 : 0;
    ranks = ranks || mark > 1;
  }
  std::vector<Index> members(count, -1);
  Index next = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i] == 0) continue;
    const Index place = ranks ? static_cast<Index>(marks[i]) - 1 : next++;
    if (place >= count || members[place] >= 0) return {};
    members[place] = static_cast<Index>(i);
  }
  return members;
}

/// Returns a name as a file can hold it: XML allows no control characters, and legacy files encode them.
std::string held_name(const std::string& name, NamePlace place) {
  if (name.empty()) return "array";
  if (place == NamePlace::xml) return xml_text(name);
  if (place == NamePlace::legacy) return name == "NULL_ARRAY" ? name + '_' : name;  // readers skip NULL_ARRAY
  return name_in_hdf5(name);
}

/// Returns the metadata of a mesh that came from VTK, or empty metadata; notes metadata of another format.
const VtkMetadata& metadata_of(const Mesh& mesh, Notes& notes) {
  static const VtkMetadata none;
  if (!mesh.format_metadata) return none;
  if (const auto* own = dynamic_cast<const VtkMetadata*>(mesh.format_metadata.get())) return *own;
  note_metadata_unsupported(mesh, "VTK", notes);
  return none;
}

}  // namespace

DataArray full_array(const DataArray& array, Index count) {
  DataArray copy{array.name, array.association, array.components, {}, {}, array.component_names};
  if (array.is_dense() && row_count(array) == count) {
    copy.values = array.values;
  } else {
    std::vector<Index> rows = rows_by_item(array, count);
    rows.resize(static_cast<std::size_t>(count), -1);  // the table is empty if the array has no rows
    copy.values = rows_of_values(array.values, array.components, rows);
  }
  return copy;
}

std::vector<std::string> VtkMetadata::contents() const {
  std::vector<std::string> result;
  for (const DataArray& field : fields) result.push_back("the field '" + field.name + "' of the whole mesh");
  if (legacy) {
    for (const auto& table : legacy->lookup_tables) result.push_back("the lookup table '" + table.name + "'");
  }
  for (const auto& [array, fact] : facts) {
    if (!fact.information.empty() || !fact.xml_information.empty())
      result.push_back("the information of the array '" + fact.array + "'");
  }
  return result;
}

std::shared_ptr<const FormatMetadata> VtkMetadata::moved(std::span<const Index> new_vertices,
                                                         std::span<const Index> new_cells) const {
  if (polyhedra.empty()) return nullptr;
  auto result = std::make_shared<VtkMetadata>(*this);
  result->polyhedra = polyhedra.moved(new_vertices, new_cells);
  return result;
}

const ArrayFacts* find_facts(const VtkMetadata& metadata, std::optional<Association> association,
                             std::string_view array) {
  const auto found = metadata.facts.find({association, std::string(array)});
  return found == metadata.facts.end() ? nullptr : &found->second;
}

DataArray marks_of(const EntitySet& set, Index count) {
  DataArray result{.name = std::string(kSetPrefix) + set.name, .association = set.association};
  if (std::adjacent_find(set.members.begin(), set.members.end(), std::greater_equal<>()) ==
      set.members.end()) {
    std::vector<std::uint8_t> marks(count, 0);
    for (const Index member : set.members) marks[member] = 1;
    result.values = std::move(marks);
    return result;
  }
  std::vector<std::int32_t> ranks(count, 0);
  std::int32_t rank = 0;
  for (const Index member : set.members) {
    if (ranks[member] == 0) ranks[member] = ++rank;
  }
  result.values = std::move(ranks);
  return result;
}

void add_points(std::vector<Point>& points, const Values& coordinates,
                const std::function<InputError(std::size_t k)>& not_finite) {
  const std::size_t first = points.size();
  resize_large(points, first + size_of(coordinates) / 3);
  with_numbers(coordinates, [&](const auto& numbers) {
    const auto* number = numbers.data();
    for (std::size_t p = first; p < points.size(); ++p) {
      for (double& x : points[p]) {
        x = static_cast<double>(*number++);
        if (!std::isfinite(x)) throw not_finite(p - first);
      }
    }
  });
}

void add_array(Mesh& mesh, DataArray array) {
  if (array.name == kCellTypes && find_array(mesh, kCellTypes, array.association) != nullptr) return;
  if (array.name.starts_with(kSetPrefix) && array.components == 1 && array.is_dense()) {
    auto members = with_integers(array.values, [](const auto& values) { return members_of(values); });
    if (members) {
      mesh.sets.push_back({array.name.substr(kSetPrefix.size()), array.association, std::move(*members)});
      return;
    }
  }
  mesh.data.push_back(std::move(array));
}

std::string name_in_hdf5(std::string name) {
  if (name.empty()) return "array";
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '/' || c == '\0'; }, '_');
  return name == "." ? "_" : name;
}

bool is_from_vtk(const Mesh& mesh) {
  return dynamic_cast<const VtkMetadata*>(mesh.format_metadata.get()) != nullptr;
}

WriteContext::WriteContext(const Mesh& written, Notes& warnings, NamePlace names)
    : mesh(written), notes(warnings), metadata(metadata_of(mesh, notes)), types(cell_types(mesh)) {
  const Index unfit = first_unfit_polyhedron(mesh.cells, types, metadata.polyhedra, mesh.vertex_count());
  if (unfit >= 0) {
    throw InvalidArgument("mesh: the faces of cell " + std::to_string(unfit) +
                          ", a polyhedron, are not on its vertices");
  }
  collect_arrays(names);
}

void WriteContext::add_made(DataArray array) {
  made_.push_back(std::make_unique<DataArray>(std::move(array)));
  arrays.push_back(made_.back().get());
}

void WriteContext::collect_arrays(NamePlace place) {
  std::map<Association, DistinctNames> names;  // distinct, as VTK looks arrays up by name
  const auto name_of = [&](const DataArray& array) {
    std::string name = names[array.association].take(held_name(array.name, place));
    note_renamed_array(array, name, notes);
    return name;
  };
  for (const DataArray& array : mesh.data) {
    // the types that the reader kept are written as cell types, any other array of that name as an array
    const auto* const kept = std::get_if<std::vector<std::uint8_t>>(&array.values);
    const bool holds_types = kept != nullptr && array.is_dense() && *kept == types;
    if (array.association == Association::cells && array.name == kCellTypes && holds_types) continue;
    const std::string name = name_of(array);
    if (array.is_dense() && name == array.name) {
      arrays.push_back(&array);
      continue;
    }
    if (!array.is_dense()) note_filled(array, missing_word(array.values), notes);
    add_made(full_array(array, item_count(mesh, array.association)));
    made_.back()->name = name;
  }

  for (const EntitySet& set : mesh.sets) {
    DataArray marks = marks_of(set, item_count(mesh, set.association));
    marks.name = name_of(marks);
    if (!is_from_vtk(mesh)) {
      notes.push_back(fmt::format("the set '{}' of {} is written as the array '{}'", set.name,
                                  to_string(set.association), marks.name));
    }
    add_made(std::move(marks));
  }

  const auto add_ids = [&](const std::vector<std::int64_t>& ids, const char* wanted,
                           Association association) {
    if (ids.empty()) return;
    DataArray array{wanted, association, 1, label_values(ids), {}, {}};
    array.name = name_of(array);
    notes.push_back(
        fmt::format("the ids of {} are written as the array '{}'", to_string(association), array.name));
    add_made(std::move(array));
  };
  add_ids(mesh.vertex_ids, "vertex_id", Association::vertices);
  add_ids(mesh.cell_ids, "cell_id", Association::cells);
}

const ArrayRole* WriteContext::role(Association association, Role role) const {
  std::set<std::string_view> written;
  for (const DataArray* array : arrays) {
    if (array->association == association) written.insert(array->name);
  }
  const auto found = std::find_if(metadata.roles.begin(), metadata.roles.end(), [&](const ArrayRole& known) {
    const Role kind = known.role == Role::color_scalars ? Role::scalars : known.role;
    return known.association == association && kind == role && written.contains(known.array);
  });
  return found == metadata.roles.end() ? nullptr : &*found;
}

bool WriteContext::points_are_floats() const {
  return metadata.float_points && are_float_points(mesh.points);
}

}  // namespace meshorder::vtk
