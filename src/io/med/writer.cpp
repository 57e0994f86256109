// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "io/all_formats.hpp"
#include "io/exact_values.hpp"
#include "io/hdf5/session.hpp"
#include "io/labels.hpp"
#include "io/med/med.hpp"
#include "io/unsupported.hpp"
#include "mesh/reorder.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>
#include <variant>

// Writes a file: the kept bytes, then points, cells, fields and equivalences.

namespace meshorder::med {
namespace {

/// Name of the only step's group in a mesh that does not change over time.
constexpr std::string_view kStep = "-0000000000000000001-0000000000000000001";
constexpr std::size_t kInt32Alternative = 6;
constexpr std::size_t kInt64Alternative = 8;
constexpr std::size_t kFloatAlternative = 1;

/// Returns the names of the axes, each padded to 16 characters.
std::string axis_names(int axes) {
  std::string names;
  for (int k = 0; k < axes; ++k) names += fmt::format("{:<16}", static_cast<char>('X' + k));
  return names;
}

/// Returns the coordinates in one list, axis after axis.
template <class Number>
Values columns_of(const std::vector<Point>& points, int axes) {
  std::vector<Number> columns;
  columns.reserve(points.size() * static_cast<std::size_t>(axes));
  for (std::size_t k = 0; k < static_cast<std::size_t>(axes); ++k) {
    for (const Point& point : points) columns.push_back(static_cast<Number>(point[k]));
  }
  return columns;
}

/// Marks a group as having values for all its items.
void mark_whole(hdf5::File& file, const std::string& group) {
  set_attributes(file, group, {{"CGT", 1}, {"CGS", 1}});
  file.set_attribute(group, "PFL", std::string(kNoProfile));
}

void write_points(Writing& writing) {
  const MedLayout& layout = writing.layout;
  hdf5::File& file = writing.file;
  const std::string mesh = layout.mesh_path();
  const int axes = coordinates_of(writing.mesh.points, layout.axes);
  if (axes != layout.axes) {
    file.set_attribute(mesh, "ESP", std::int64_t{axes});
    file.set_attribute(mesh, "NOM", axis_names(axes));
    file.set_attribute(mesh, "UNI", std::string(kShortName * static_cast<std::size_t>(axes), ' '));
  }
  const std::string group = layout.path_of(nullptr);
  const std::string path = group + "/COO";
  const std::optional<std::size_t> type = file.number_type(path);
  const bool floats = type == kFloatAlternative && are_float_points(writing.mesh.points);
  if (type && *type != (floats ? kFloatAlternative : 0)) file.remove(path);
  writing.put(
      path,
      floats ? columns_of<float>(writing.mesh.points, axes) : columns_of<double>(writing.mesh.points, axes),
      writing.mesh.vertex_count());
  if (!file.text_attribute(group, "PFL")) mark_whole(file, group);
}

/// Returns the nodes of the cells of a type, from 1: the first node of each cell, then the second of each, …
std::vector<Index> node_columns(const Writing& writing, const GeometryType& type, const Range& range) {
  const std::span<const int> order = writing.layout.in_mesh_order ? std::span<const int>() : mesh_order(type);
  const auto nodes = static_cast<std::size_t>(type.nodes);
  const auto count = static_cast<std::size_t>(range.count);
  const Index* const rows = writing.mesh.cells[range.first].data();
  std::vector<Index> columns(count * nodes);
  for (std::size_t k = 0; k < nodes; ++k) {
    const std::size_t place = order.empty() ? k : static_cast<std::size_t>(order[k]);
    for (std::size_t c = 0; c < count; ++c) columns[k * count + c] = rows[c * nodes + place] + 1;
  }
  return columns;
}

/// Returns the numbers of the vertices or cells in a range.
std::vector<std::int64_t> part_of(const std::vector<std::int64_t>& numbers, const Range& range) {
  const auto begin = numbers.begin() + range.first;
  return {begin, begin + range.count};
}

/// An array (null: not in the mesh) and its row for each vertex or cell.
struct RowsOfArray {
  const DataArray* array = nullptr;
  std::vector<Index> table = {};

  /// Returns the row of a vertex or cell, −1 if it has none.
  [[nodiscard]] Index operator[](Index item) const { return table.empty() ? item : table[item]; }
};

/// Writes the data, besides coordinates and nodes, of vertices or of cells.
class ItemWriter {
 public:
  ItemWriter(Writing& writing, Association association)
      : writing_(writing), association_(association), families_(write_families(writing, association)) {
    const DataArray* const names = find_array(writing.mesh, kNames, association);
    if (names != nullptr && names->components == 1 && are_texts(names->values)) {
      names_ = placed(names);
      note_cut_names();
    }
    const DataArray* const numbers = find_array(writing.mesh, kGlobalNumbers, association);
    // in a mesh of another format, an array of that name becomes a field
    if (!writing.layout.is_made && numbers != nullptr && numbers->components == 1 &&
        (numbers->values.index() == kInt32Alternative || numbers->values.index() == kInt64Alternative)) {
      global_numbers_ = placed(numbers);
    }
  }

  /// Writes the data of the vertices (null) or of the cells of a type into their group.
  void write(const GeometryType* type) {
    const std::string group = writing_.layout.path_of(type);
    const Range range = range_in(writing_.ranges, type);
    const auto known = writing_.layout.items.find(type);
    const Items of_file = known == writing_.layout.items.end() ? Items{} : known->second;
    write_numbers(group + "/NUM", of_file.has_numbers, range);
    write_families_of(group + "/FAM", of_file.has_families, range);
    write_names(group + "/NOM", range);
    write_global_numbers(group + "/GLB", range);
  }

 private:
  /// Marks an array as written; returns its rows.
  RowsOfArray placed(const DataArray* array) {
    writing_.placed.insert(array);
    return {array, rows_by_item(*array, item_count(writing_.mesh, association_))};
  }

  void write_numbers(const std::string& path, bool had_numbers, const Range& range) {
    const bool on_vertices = association_ == Association::vertices;
    const std::vector<std::int64_t>& ids = on_vertices ? writing_.mesh.vertex_ids : writing_.mesh.cell_ids;
    // a mesh has no vertex ids if its file numbers the vertices 1, 2, …
    if (ids.empty() && !(had_numbers && on_vertices)) return writing_.file.remove(path);
    std::vector<std::int64_t> numbers(range.count);
    std::iota(numbers.begin(), numbers.end(), std::int64_t{1});
    if (!ids.empty()) {
      const std::vector<std::int64_t> usual = std::exchange(numbers, part_of(ids, range));
      if (!had_numbers && numbers == usual) return writing_.file.remove(path);
    }
    writing_.put_integers(path, std::move(numbers));
  }

  void write_families_of(const std::string& path, bool had_families, const Range& range) {
    if (families_.empty() && !had_families) return;
    const std::vector<std::int64_t> numbers =
        families_.empty() ? std::vector<std::int64_t>(range.count) : part_of(families_, range);
    const auto is_set = [](std::int64_t family) { return family != 0; };
    if (had_families || std::any_of(numbers.begin(), numbers.end(), is_set)) {
      writing_.put_integers(path, numbers);
    }
  }

  void note_cut_names() {
    const auto& texts = std::get<std::vector<std::string>>(names_.array->values);
    if (std::any_of(texts.begin(), texts.end(),
                    [](const std::string& text) { return text.size() > kShortName; })) {
      writing_.notes.push_back(
          fmt::format("the names of {} are cut to {} characters", to_string(association_), kShortName));
    }
  }

  void write_names(const std::string& path, const Range& range) {
    std::vector<std::string> names;
    bool any = false;
    for (Index item = range.first; names_.array != nullptr && item < range.first + range.count; ++item) {
      const Index row = names_[item];
      const auto& texts = std::get<std::vector<std::string>>(names_.array->values);
      names.push_back(row < 0 ? std::string() : texts[row]);
      any = any || row >= 0;
    }
    if (!any) return writing_.file.remove(path);
    writing_.file.write_texts(path, names, kShortName, ' ');
    set_attributes(writing_.file, path, {{"CGT", 1}, {"NBR", range.count}});
  }

  /// Writes the global numbers, unless a vertex or cell has none.
  void write_global_numbers(const std::string& path, const Range& range) {
    std::vector<std::int64_t> numbers;
    if (global_numbers_.array != nullptr) {
      with_integers(global_numbers_.array->values, [&](const auto& values) {
        for (Index item = range.first; item < range.first + range.count; ++item) {
          if (const Index row = global_numbers_[item]; row >= 0) numbers.push_back(values[row]);
        }
      });
    }
    if (global_numbers_.array == nullptr || index_size(numbers) < range.count) {
      return writing_.file.remove(path);
    }
    writing_.put_integers(path, std::move(numbers));
  }

  Writing& writing_;
  Association association_;
  std::vector<std::int64_t> families_;
  RowsOfArray names_;
  RowsOfArray global_numbers_;
};

void write_cells(Writing& writing) {
  const MedLayout& layout = writing.layout;
  hdf5::File& file = writing.file;
  ItemWriter items(writing, Association::cells);
  for (const GeometryType& type : geometry_types()) {
    const std::string group = layout.path_of(&type);
    const Range range = range_in(writing.ranges, &type);
    if (range.count == 0) {
      file.remove(group);
      continue;
    }
    const std::string path = group + "/NOD";
    const std::vector<Index> columns = node_columns(writing, type, range);
    file.write(path, std::span<const Index>(columns), {columns.size()});
    set_attributes(file, path, {{"CGT", 1}, {"NBR", range.count}});
    if (!file.text_attribute(group, "PFL")) {
      mark_whole(file, group);
      file.set_attribute(group, "GEO", std::int64_t{type.number});
    }
    items.write(&type);
  }
  if (!file.integer_attribute(layout.cells_path(), "CGT"))
    file.set_attribute(layout.cells_path(), "CGT", std::int64_t{1});
}

void write_equivalences(Writing& writing) {
  for (const Equivalence& equivalence : writing.layout.equivalences) {
    std::vector<Index> numbers = equivalence.members;
    for (Index& number : numbers) number += 1 - range_in(writing.ranges, equivalence.type).first;
    if (numbers.empty()) {
      writing.file.remove(equivalence.dataset.substr(0, equivalence.dataset.rfind('/')));
      continue;
    }
    writing.file.write(equivalence.dataset, std::span<const Index>(numbers), {numbers.size()});
    writing.file.set_attribute(equivalence.dataset, "NBR", std::int64_t{std::ssize(numbers) / 2});
  }
}

void note_texts(Writing& writing) {
  for (const DataArray& array : writing.mesh.data) {
    if (are_texts(array.values) && !writing.placed.contains(&array))
      note_array_unsupported(array, "MED", writing.notes);
  }
}

bool needs_version_4(const Mesh& mesh) {
  constexpr int kNodes = 18;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (mesh.cells.shapes[c] == Shape::wedge && mesh.cells.vertex_count(c) == kNodes) return true;
  }
  return false;
}

}  // namespace

void set_attributes(hdf5::File& file, const std::string& path, Numbers numbers) {
  for (const auto& [name, number] : numbers) file.set_attribute(path, name, number);
}

void Writing::put(const std::string& path, const Values& values, Index rows) {
  file.write(path, values, {size_of(values)});
  set_attributes(file, path, {{"CGT", 1}, {"NBR", rows}});
}

void Writing::put_integers(const std::string& path, std::vector<std::int64_t> values) {
  const Index rows = index_size(values);
  const Values held = label_values(std::move(values));
  if (held.index() == kInt64Alternative && file.number_type(path) != kInt64Alternative) file.remove(path);
  put(path, held, rows);
}

std::shared_ptr<const FormatMetadata> MedLayout::moved(std::span<const Index> new_vertices,
                                                       std::span<const Index> new_cells) const {
  if (equivalences.empty()) return nullptr;
  auto result = std::make_shared<MedLayout>(*this);
  for (Equivalence& equivalence : result->equivalences) {
    const std::span<const Index> places = equivalence.type == nullptr ? new_vertices : new_cells;
    if (places.empty()) continue;
    std::vector<Index> members;
    for (std::size_t k = 0; k + 1 < equivalence.members.size(); k += 2) {
      const Index first = places[static_cast<std::size_t>(equivalence.members[k])];
      const Index second = places[static_cast<std::size_t>(equivalence.members[k + 1])];
      if (first >= 0 && second >= 0) members.insert(members.end(), {first, second});
    }
    equivalence.members = std::move(members);
  }
  return result;
}

MedLayout new_layout(const Mesh& mesh) {
  MedLayout layout;
  layout.is_made = true;
  layout.mesh = "mesh";
  layout.step = kStep;
  layout.axes = coordinates_of(mesh.points, mesh.dimension);
  hdf5::File file = hdf5::File::in_memory({}, "");
  const std::string infos = "/INFOS_GENERALES";
  file.make_group(infos);
  // all programs that read versions 3 and 4 read 3.0, which has no wedges of 18 nodes
  set_attributes(file, infos, {{"MAJ", needs_version_4(mesh) ? 4 : 3}, {"MIN", 0}, {"REL", 0}});
  const std::string path = layout.mesh_path();
  file.make_group(path);
  set_attributes(file, path,
                 {{"DIM", std::max(mesh.cells.highest_dimension(), 0)},
                  {"ESP", layout.axes},
                  {"TYP", 0},
                  {"REP", 0},
                  {"SRT", 0},
                  {"NXI", -1},
                  {"NXT", -1}});
  file.set_attribute(path, "DES", std::string());
  file.set_attribute(path, "UNT", std::string());
  file.set_attribute(path, "NOM", axis_names(layout.axes));
  file.set_attribute(path, "UNI", std::string(kShortName * static_cast<std::size_t>(layout.axes), ' '));
  const std::string step = layout.step_path();
  file.make_group(step);
  file.set_attribute(step, "PDT", 0.0);
  set_attributes(file, step,
                 {{"NDT", -1}, {"NOR", -1}, {"NXI", -1}, {"NXT", -1}, {"PVI", -1}, {"PVT", -1}, {"CGT", 1}});
  layout.file = std::make_shared<const std::string>(file.bytes());
  return layout;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  Ranges ranges{{nullptr, {0, mesh.vertex_count()}}};
  Range* of_type = nullptr;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (c == 0 || mesh.cells.shapes[c] != mesh.cells.shapes[c - 1] ||
        mesh.cells.vertex_count(c) != mesh.cells.vertex_count(c - 1)) {
      of_type = &ranges[geometry_type(mesh.cells.shapes[c], mesh.cells.vertex_count(c))];
      if (of_type->count > 0) {
        // a program has mixed the cells of a mesh that it read from MED
        Mesh grouped = mesh;
        (void)group_cells_by_type(grouped);
        return write(grouped, path, notes);
      }
      of_type->first = c;
    }
    ++of_type->count;
  }
  const hdf5::Session session;
  const auto* const own = dynamic_cast<const MedLayout*>(mesh.format_metadata.get());
  const MedLayout layout = own != nullptr ? *own : new_layout(mesh);
  hdf5::write_from(path, *layout.file, [&](hdf5::File& file) {
    Writing writing{mesh, layout, file, notes, ranges, {}};
    write_points(writing);
    ItemWriter(writing, Association::vertices).write(nullptr);
    write_cells(writing);
    note_texts(writing);
    write_fields(writing);
    write_equivalences(writing);
    if (own == nullptr) note_metadata_unsupported(mesh, "MED", notes);
  });
}

namespace {

bool holds(const Mesh& /*mesh*/, Shape shape, int vertices) {
  return geometry_type(shape, vertices) != nullptr;
}

}  // namespace

}  // namespace meshorder::med

namespace meshorder {

Format med_format() {
  return {.name = "MED",
          .extensions = {".med"},
          .groups_cells_by_type = true,
          .read = med::read,
          .write = med::write,
          .holds = med::holds,
          .first_number = 1,
          .has_numbers = true,
          .library = "HDF5",
          .load_library = hdf5::load_library};
}

}  // namespace meshorder
