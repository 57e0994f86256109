// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "io/all_formats.hpp"
#include "io/exact_values.hpp"
#include "io/hdf5/session.hpp"
#include "io/med/med.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>
#include <variant>

// Writes a file: its contents besides the mesh, then the mesh, its numbers and names.

namespace meshorder::med {
namespace {

/// Name of the group of the only step, in a mesh that does not change over time.
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
  file.set_attribute(group, "CGT", std::int64_t{1});
  file.set_attribute(group, "CGS", std::int64_t{1});
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
  const std::string group = layout.nodes_path();
  const std::string path = group + "/COO";
  const std::optional<std::size_t> type = file.number_type(path);
  const bool floats = type == kFloatAlternative && are_float_points(writing.mesh.points);
  if (type && *type != (floats ? kFloatAlternative : 0)) file.remove(path);
  writing.put(
      path,
      floats ? columns_of<float>(writing.mesh.points, axes) : columns_of<double>(writing.mesh.points, axes),
      writing.mesh.points.size());
  if (!file.text_attribute(group, "PFL")) mark_whole(file, group);
}

/// Returns whether cells, given in ascending order, are consecutive.
bool follow_each_other(const std::vector<Index>& cells) {
  return cells.empty() || cells.back() - cells.front() + 1 == index_size(cells);
}

/// Returns the nodes of cells of a type, from 1: the first node of each cell, then the second of each, …
std::vector<Index> node_columns(const Writing& writing, const GeometryType& type,
                                const std::vector<Index>& cells) {
  const std::span<const int> order = writing.layout.in_mesh_order ? std::span<const int>() : mesh_order(type);
  std::vector<Index> columns(cells.size() * static_cast<std::size_t>(type.nodes));
  const auto nodes = static_cast<std::size_t>(type.nodes);
  for (std::size_t k = 0; k < nodes; ++k) {
    const std::size_t place = order.empty() ? k : static_cast<std::size_t>(order[k]);
    Index* const column = columns.data() + k * cells.size();
    const auto first =
        static_cast<std::size_t>(cells.empty() ? 0 : writing.mesh.cells.offsets[cells.front()]);
    if (follow_each_other(cells)) {
      const Index* const rows = writing.mesh.cells.vertices.data() + first;
      for (std::size_t c = 0; c < cells.size(); ++c) column[c] = rows[c * nodes + place] + 1;
      continue;
    }
    for (std::size_t c = 0; c < cells.size(); ++c) column[c] = writing.mesh.cells[cells[c]][place] + 1;
  }
  return columns;
}

/// Returns the numbers or texts of an array for some vertices or cells; nullopt if an item has no row.
template <class Result, class Array>
std::optional<std::vector<Result>> rows_for(const Array& values, const std::vector<Index>& row_of,
                                            const std::vector<Index>& items) {
  std::vector<Result> result;
  result.reserve(items.size());
  for (const Index item : items) {
    const Index row = row_of.empty() ? item : row_of[static_cast<std::size_t>(item)];
    if (row < 0) return {};
    result.push_back(static_cast<Result>(values[static_cast<std::size_t>(row)]));
  }
  return result;
}

/// Writes the data of vertices, or of cells, besides coordinates and nodes.
class ItemWriter {
 public:
  ItemWriter(Writing& writing, Association association)
      : writing_(writing),
        association_(association),
        families_(write_families(writing, association)),
        names_(find_array(writing.mesh, kNames, association)),
        global_numbers_(find_array(writing.mesh, kGlobalNumbers, association)) {
    const bool on_vertices = association == Association::vertices;
    const Index count = on_vertices ? writing.mesh.vertex_count() : writing.mesh.cell_count();
    const bool has_texts = names_ != nullptr && names_->components == 1 &&
                           std::holds_alternative<std::vector<std::string>>(names_->values);
    if (!has_texts) names_ = nullptr;
    if (names_ != nullptr) {
      (void)writing.take(kNames, association);
      name_rows_ = rows_by_item(*names_, count);
      note_cut_names();
    }
    // in a mesh of another format, an array of that name becomes a field
    const bool are_whole = !writing.layout.is_made && global_numbers_ != nullptr &&
                           global_numbers_->components == 1 &&
                           (global_numbers_->values.index() == kInt32Alternative ||
                            global_numbers_->values.index() == kInt64Alternative);
    if (!are_whole) global_numbers_ = nullptr;
    if (global_numbers_ != nullptr) {
      (void)writing.take(kGlobalNumbers, association);
      global_rows_ = rows_by_item(*global_numbers_, count);
    }
  }

  /// Writes the data of these vertices or cells into their group.
  void write(const std::string& group, const Items& of_file, const std::vector<Index>& items) {
    write_numbers(group + "/NUM", of_file, items);
    write_families_of(group + "/FAM", of_file, items);
    write_names(group + "/NOM", items);
    write_global_numbers(group + "/GLB", items);
  }

 private:
  void write_numbers(const std::string& path, const Items& of_file, const std::vector<Index>& items) {
    const bool on_vertices = association_ == Association::vertices;
    const std::vector<std::int64_t>& ids = on_vertices ? writing_.mesh.vertex_ids : writing_.mesh.cell_ids;
    // a mesh has no vertex ids if its file numbers the vertices 1, 2, …
    if (ids.empty() && !(of_file.has_numbers && on_vertices)) return writing_.file.remove(path);
    std::vector<std::int64_t> numbers(items.size());
    std::iota(numbers.begin(), numbers.end(), std::int64_t{1});
    if (!ids.empty()) {
      const std::vector<std::int64_t> usual = std::move(numbers);
      numbers = *rows_for<std::int64_t>(ids, {}, items);
      if (!of_file.has_numbers && numbers == usual) return writing_.file.remove(path);
    }
    writing_.put_integers(path, numbers, items.size());
  }

  void write_families_of(const std::string& path, const Items& of_file, const std::vector<Index>& items) {
    if (!of_file.has_families && !has_families(items)) return;
    const std::vector<std::int64_t> numbers = families_.empty()
                                                  ? std::vector<std::int64_t>(items.size(), 0)
                                                  : *rows_for<std::int64_t>(families_, {}, items);
    writing_.put_integers(path, numbers, items.size());
  }

  void note_cut_names() {
    const auto& texts = std::get<std::vector<std::string>>(names_->values);
    if (std::none_of(texts.begin(), texts.end(),
                     [](const std::string& text) { return text.size() > kShortName; }))
      return;
    writing_.notes.push_back(
        fmt::format("the names of {} are cut to {} characters", to_string(association_), kShortName));
  }

  [[nodiscard]] bool has_families(const std::vector<Index>& items) const {
    return !families_.empty() && std::any_of(items.begin(), items.end(), [&](Index item) {
      return families_[static_cast<std::size_t>(item)] != 0;
    });
  }

  void write_names(const std::string& path, const std::vector<Index>& items) {
    std::vector<std::string> names;
    bool any = false;
    for (const Index item : items) {
      if (names_ == nullptr) break;
      const Index row = name_rows_.empty() ? item : name_rows_[static_cast<std::size_t>(item)];
      const auto& texts = std::get<std::vector<std::string>>(names_->values);
      names.push_back(row < 0 ? std::string() : texts[static_cast<std::size_t>(row)]);
      any = any || row >= 0;
    }
    if (!any) return writing_.file.remove(path);
    writing_.file.write_texts(path, names, kShortName, ' ');
    writing_.file.set_attribute(path, "CGT", std::int64_t{1});
    writing_.file.set_attribute(path, "NBR", static_cast<std::int64_t>(items.size()));
  }

  void write_global_numbers(const std::string& path, const std::vector<Index>& items) {
    std::optional<std::vector<std::int64_t>> numbers;
    if (global_numbers_ != nullptr) {
      with_integers(global_numbers_->values, [&](const auto& values) {
        numbers = rows_for<std::int64_t>(values, global_rows_, items);
      });
    }
    if (!numbers) return writing_.file.remove(path);
    writing_.put_integers(path, *numbers, items.size());
  }

  Writing& writing_;
  Association association_;
  std::vector<std::int64_t> families_;
  const DataArray* names_;
  std::vector<Index> name_rows_;
  const DataArray* global_numbers_;
  std::vector<Index> global_rows_;
};

void write_nodes(Writing& writing) {
  write_points(writing);
  const std::vector<Index> all = index_range(0, writing.mesh.vertex_count());
  ItemWriter(writing, Association::vertices).write(writing.layout.nodes_path(), writing.layout.vertices, all);
}

void write_cells(Writing& writing) {
  const MedLayout& layout = writing.layout;
  hdf5::File& file = writing.file;
  ItemWriter items(writing, Association::cells);
  for (const GeometryType& type : geometry_types()) {
    const std::string group = fmt::format("{}/{}", layout.cells_path(), type.name);
    const auto found = writing.cells.find(&type);
    if (found == writing.cells.end()) {
      file.remove(group);
      continue;
    }
    const std::vector<Index>& cells = found->second;
    const std::string path = group + "/NOD";
    const std::vector<Index> columns = node_columns(writing, type, cells);
    file.write(path, std::span<const Index>(columns), {columns.size()});
    file.set_attribute(path, "CGT", std::int64_t{1});
    file.set_attribute(path, "NBR", static_cast<std::int64_t>(cells.size()));
    if (!file.text_attribute(group, "PFL")) {
      mark_whole(file, group);
      file.set_attribute(group, "GEO", std::int64_t{type.number});
    }
    const auto of_file = layout.cells.find(std::string(type.name));
    items.write(group, of_file == layout.cells.end() ? Items{} : of_file->second, cells);
  }
  if (!file.integer_attribute(layout.cells_path(), "CGT"))
    file.set_attribute(layout.cells_path(), "CGT", std::int64_t{1});
}

void write_equivalences(Writing& writing) {
  std::vector<Index> places(writing.mesh.cells.shapes.size(), -1);
  for (const auto& [type, cells] : writing.cells) {
    for (std::size_t k = 0; k < cells.size(); ++k)
      places[static_cast<std::size_t>(cells[k])] = static_cast<Index>(k);
  }
  for (const Equivalence& equivalence : writing.layout.equivalences) {
    std::vector<Index> numbers;
    for (const Index member : equivalence.members) {
      numbers.push_back((equivalence.type == nullptr ? member : places[static_cast<std::size_t>(member)]) +
                        1);
    }
    if (numbers.empty()) {
      writing.file.remove(equivalence.dataset.substr(0, equivalence.dataset.rfind('/')));
      continue;
    }
    writing.file.write(equivalence.dataset, std::span<const Index>(numbers), {numbers.size()});
    writing.file.set_attribute(equivalence.dataset, "NBR", static_cast<std::int64_t>(numbers.size() / 2));
  }
}

void note_texts(Writing& writing) {
  for (const DataArray& array : writing.mesh.data) {
    const bool is_text = std::holds_alternative<std::vector<std::string>>(array.values);
    if (is_text && !writing.placed.contains(&array)) note_array_unsupported(array, "MED", writing.notes);
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

const DataArray* Writing::take(std::string_view name, Association association) {
  const DataArray* const array = find_array(mesh, name, association);
  return array != nullptr && placed.insert(array).second ? array : nullptr;
}

void Writing::put(const std::string& path, const Values& values, std::size_t rows) {
  const std::size_t size = size_of(values);
  file.write(path, values, {size});
  file.set_attribute(path, "CGT", std::int64_t{1});
  file.set_attribute(path, "NBR", static_cast<std::int64_t>(rows));
}

void Writing::put_integers(const std::string& path, const std::vector<std::int64_t>& values,
                           std::size_t rows) {
  const Values held = label_values(values);
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
  file.set_attribute(infos, "MAJ", std::int64_t{needs_version_4(mesh) ? 4 : 3});
  file.set_attribute(infos, "MIN", std::int64_t{0});
  file.set_attribute(infos, "REL", std::int64_t{0});
  const std::string path = layout.mesh_path();
  file.make_group(path);
  file.set_attribute(path, "DIM", std::int64_t{std::max(mesh.cells.highest_dimension(), 0)});
  file.set_attribute(path, "ESP", std::int64_t{layout.axes});
  file.set_attribute(path, "TYP", std::int64_t{0});
  file.set_attribute(path, "REP", std::int64_t{0});
  file.set_attribute(path, "SRT", std::int64_t{0});
  file.set_attribute(path, "NXI", std::int64_t{-1});
  file.set_attribute(path, "NXT", std::int64_t{-1});
  file.set_attribute(path, "DES", std::string());
  file.set_attribute(path, "UNT", std::string());
  file.set_attribute(path, "NOM", axis_names(layout.axes));
  file.set_attribute(path, "UNI", std::string(kShortName * static_cast<std::size_t>(layout.axes), ' '));
  const std::string step = path + "/" + layout.step;
  file.make_group(step);
  file.set_attribute(step, "PDT", 0.0);
  for (const char* const name : {"NDT", "NOR", "NXI", "NXT", "PVI", "PVT"})
    file.set_attribute(step, name, std::int64_t{-1});
  file.set_attribute(step, "CGT", std::int64_t{1});
  layout.file = std::make_shared<const std::string>(file.bytes());
  return layout;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const hdf5::Session session;
  const auto* const own = dynamic_cast<const MedLayout*>(mesh.format_metadata.get());
  const MedLayout layout = own != nullptr ? *own : new_layout(mesh);
  hdf5::write_from(path, *layout.file, [&](hdf5::File& file) {
    Writing writing{mesh, layout, file, notes, {}, {}};
    std::vector<Index>* of_type = nullptr;  // neighbouring cells mostly have the same type
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      if (c == 0 || mesh.cells.shapes[c] != mesh.cells.shapes[c - 1] ||
          mesh.cells.vertex_count(c) != mesh.cells.vertex_count(c - 1)) {
        of_type = &writing.cells[geometry_type(mesh.cells.shapes[c], mesh.cells.vertex_count(c))];
      }
      of_type->push_back(c);
    }
    write_nodes(writing);
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
          .library = "HDF5",
          .load_library = hdf5::load_library};
}

}  // namespace meshorder
