// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Wavefront OBJ, as "Object Files (.obj)", appendix B1 of the Advanced Visualizer manual, gives it
// (https://paulbourke.net/dataformats/obj/): polygons, lines and points with texture coordinates and normals
// of their corners, groups, materials and other states. Free-form curves and surfaces are not read.
#include "base/checksum.hpp"
#include "io/all_formats.hpp"
#include "io/names.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/surface/obj_parts.hpp"
#include "io/surface/surface_data.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>

namespace meshorder {
namespace {
using obj::kStates;

bool obj_holds(const Mesh& /*mesh*/, Shape shape, int vertices) {
  if (shape == Shape::polygon) return vertices >= 3;
  if (shape == Shape::polyline) return vertices >= 2;
  return shape == Shape::poly_vertex || (dimension(shape) <= 2 && vertices == corners(shape, 0));
}

/// Returns the 32- or 64-bit integers that an array gives to all cells; empty for other arrays, and if an
/// integer exceeds 32 bits.
std::vector<std::int32_t> cell_integers(const DataArray& array) {
  if (!array.is_dense() || array.components != 1) return {};
  if (const auto* same = std::get_if<std::vector<std::int32_t>>(&array.values)) return *same;
  const auto* wide = std::get_if<std::vector<std::int64_t>>(&array.values);
  if (!wide || !fit_32_bits(*wide)) return {};
  return {wide->begin(), wide->end()};
}

/// Writes one mesh: lists first, then cells in their order, with each state where it changes.
class ObjWriter {
 public:
  ObjWriter(const Mesh& mesh, const FilePath& path, Notes& notes)
      : mesh_(mesh),
        notes_(notes),
        native_(dynamic_cast<const obj::ObjMetadata*>(mesh.format_metadata.get())),
        out_(path) {}

  void write() {
    find_vertex_data();
    find_corner_data();
    find_states();
    find_groups();
    name_groups();
    if (native_) out_.write(native_->comments + native_->libraries);
    write_vertices();
    write_lists();
    write_unused_names();
    write_rows(out_, mesh_.cell_count(), [&](Text& row, Index cell) {
      add_changes(row, cell);
      add_cell(row, cell);
    });
    out_.commit();
    note_losses();
  }

 private:
  void find_vertex_data() {
    colors_ = gather(mesh_, kColor, Association::vertices);
    if (colors_.width > 0) {
      written_.insert(colors_.from.begin(), colors_.from.end());
      if (colors_.width == 4) notes_.emplace_back("the alpha of colours is not written: OBJ cannot hold it");
    } else {
      find_partial_colors();
    }
    const DataArray* weights = find_array(mesh_, obj::kWeight, Association::vertices);
    if (!native_ || !weights || weights->components != 1) return;
    if (const auto* values = std::get_if<std::vector<double>>(&weights->values)) {
      weights_ = values;
      weight_rows_ = rows_by_item(*weights, mesh_.vertex_count());
      written_.insert(weights);
    }
  }

  void find_partial_colors() {
    const DataArray* array = find_array(mesh_, kColor.name, Association::vertices);
    if (!array || array->components != 3) return;
    colors_.values = as_reals(array->values);
    if (colors_.values.empty()) return;
    colors_.width = 3;
    colors_.integers = are_integers(array->values);
    color_rows_ = rows_by_item(*array, mesh_.vertex_count());
    written_.insert(array);
  }

  /// Finds the indices of corners if the mesh came from OBJ. Otherwise finds the normals and texture
  /// coordinates of vertices, which become lists as long as the list of vertices.
  void find_corner_data() {
    texture_.assign(mesh_.cells.shapes.size(), nullptr);
    normals_.assign(mesh_.cells.shapes.size(), nullptr);
    if (native_) {
      for (const DataArray& array : mesh_.data) {
        if (array.name == obj::corner_array("texture", array.components)) point_to(array, texture_);
        if (array.name == obj::corner_array("normal", array.components)) point_to(array, normals_);
      }
    } else {
      vertex_texture_ = gather(mesh_, kTexture, Association::vertices);
      vertex_normals_ = gather(mesh_, kNormal, Association::vertices);
      for (const auto* vector : {&vertex_texture_, &vertex_normals_}) {
        written_.insert(vector->from.begin(), vector->from.end());
      }
    }
  }

  void point_to(const DataArray& array, std::vector<const std::int32_t*>& corners) {
    const auto* indices = std::get_if<std::vector<std::int32_t>>(&array.values);
    if (!indices || array.association != Association::cells) return;
    for (Index row = 0; row < row_count(array); ++row) {
      const Index cell = array.is_dense() ? row : array.indices[row];
      if (mesh_.cells.vertex_count(cell) == array.components) {
        corners[cell] = indices->data() + static_cast<Offset>(row) * array.components;
      }
    }
    written_.insert(&array);
  }

  void find_states() {
    for (std::size_t i = 0; i < kStates.size(); ++i) {
      const DataArray* array = find_array(mesh_, kStates[i].array, Association::cells);
      if (!array || (!native_ && i != obj::kMaterial)) continue;
      states_[i] = cell_integers(*array);
      if (states_[i].empty()) continue;
      written_.insert(array);
      if (!native_) notes_.emplace_back("labels of cells are written as materials (usemtl) of their numbers");
    }
  }

  /// Finds the sets that contain each cell, as ascending positions in the list of sets.
  void find_groups() {
    group_offsets_.assign(mesh_.cells.shapes.size() + 1, 0);
    for (const EntitySet& set : mesh_.sets) {
      if (set.association != Association::cells) continue;
      for (const Index cell : set.members) ++group_offsets_[cell + 1];
    }
    for (std::size_t c = 1; c < group_offsets_.size(); ++c) group_offsets_[c] += group_offsets_[c - 1];
    groups_.resize(group_offsets_.back());
    std::vector<Offset> next(group_offsets_.begin(), group_offsets_.end() - 1);
    for (Index s = 0; s < index_size(mesh_.sets); ++s) {
      if (mesh_.sets[s].association != Association::cells) continue;
      for (const Index cell : mesh_.sets[s].members) groups_[next[cell]++] = s;
    }
  }

  [[nodiscard]] std::span<const Index> groups_of(Index cell) const {
    return {groups_.data() + group_offsets_[cell], groups_.data() + group_offsets_[cell + 1]};
  }

  /// Returns a set's name as one word, as names of groups must be. Backslashes at its end, which would join
  /// the next line to it, become underscores.
  static std::string one_word(const EntitySet& set) {
    std::string name = plain_name(set.name.empty() ? "unnamed" : set.name, " ");
    for (std::size_t at = name.size(); at > 0 && name[at - 1] == '\\'; --at) name[at - 1] = '_';
    return name;
  }

  void name_groups() {
    DistinctNames names;
    for (const EntitySet& set : mesh_.sets)
      group_names_.push_back(set.association == Association::cells ? names.take(one_word(set))
                                                                   : std::string());
  }

  void write_vertices() {
    // colours in whole numbers go up to 255, colours of OBJ up to 1
    const double scale = colors_.integers ? 255 : 1;
    write_rows(out_, mesh_.vertex_count(), [&](Text& row, Index v) {
      row.write("v");
      row.reals(mesh_.points[v]);
      const Index color = color_rows_.empty() ? v : color_rows_[v];
      const Index weight = weight_rows_.empty() ? v : weight_rows_[v];
      if (colors_.width > 0 && color >= 0) {
        for (const double x : colors_[color].first(3)) row.real(" ", x / scale);
      } else if (weights_ && weight >= 0) {
        row.number(" ", (*weights_)[weight]);
      }
      row.write("\n");
    });
  }

  void write_lists() {
    if (native_) {
      out_.write(native_->texture);
      out_.write(native_->normals);
      return;
    }
    write_list("vt", vertex_texture_);
    write_list("vn", vertex_normals_);
  }

  void write_list(std::string_view keyword, const GatheredVector& vectors) {
    if (vectors.width == 0) return;
    write_rows(out_, mesh_.vertex_count(), [&](Text& row, Index v) {
      row.write(keyword);
      row.reals(vectors[v]);
      row.write("\n");
    });
  }

  [[nodiscard]] std::string state_name(std::size_t i, std::int32_t value) const {
    if (i == obj::kSmoothing) return value == 0 ? "off" : std::to_string(value);
    if (native_) {
      const auto found = native_->names[i].find(value);
      if (found != native_->names[i].end()) return found->second;
      if (value == 0) return "";
    }
    return std::to_string(value);
  }

  void add_state(Text& text, std::size_t i, std::int32_t value) const {
    const std::string name = state_name(i, value);
    text.print("{}{}{}\n", kStates[i].keyword, name.empty() ? "" : " ", name);
  }

  /// Writes the names that no cell has, which the file would otherwise lose.
  void write_unused_names() {
    Text text;
    for (std::size_t s = 0; s < mesh_.sets.size(); ++s) {
      if (mesh_.sets[s].association != Association::cells || !mesh_.sets[s].members.empty()) continue;
      text.print("g {}\n", group_names_[s]);
      in_group_ = true;
    }
    for (std::size_t i = 0; native_ && i < kStates.size(); ++i) {
      if (states_[i].empty()) continue;
      const std::set<std::int32_t> used(states_[i].begin(), states_[i].end());
      for (const auto& [value, name] : native_->names[i]) {
        if (used.contains(value)) continue;
        add_state(text, i, value);
        current_[i] = state_name(i, value);
      }
    }
    out_.write(text.view());
  }

  /// Returns the names of groups, ordered as in the file if a statement there has these names.
  [[nodiscard]] std::string names_in_statement(std::span<const Index> groups) const {
    std::string names;
    Index previous = -1;  // a set may hold a cell twice
    for (const Index s : groups) {
      if (s != previous) names.append(names.empty() ? "" : " ").append(group_names_[s]);
      previous = s;
    }
    if (!native_) return names;
    const auto found = native_->group_statements.find(names);
    return found != native_->group_statements.end() ? found->second : names;
  }

  /// Appends the statements that differ from those of the cell before.
  void add_changes(Text& row, Index cell) const {
    const auto groups = groups_of(cell);
    const bool same =
        cell > 0 ? std::ranges::equal(groups, groups_of(cell - 1)) : groups.empty() && !in_group_;
    if (!same) row.print("g{}{}\n", groups.empty() ? "" : " ", names_in_statement(groups));
    for (std::size_t i = 0; i < kStates.size(); ++i) {
      if (states_[i].empty()) continue;
      const bool changes =
          cell == 0 ? state_name(i, states_[i][0]) != current_[i] : states_[i][cell] != states_[i][cell - 1];
      if (changes) add_state(row, i, states_[i][cell]);
    }
  }

  void add_cell(Text& row, Index cell) const {
    const int dimensions = dimension(mesh_.cells.shapes[cell]);
    row.write(dimensions == 2 ? "f" : dimensions == 1 ? "l" : "p");
    const auto vertices = mesh_.cells[cell];
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      Index texture = texture_[cell] ? texture_[cell][k] : -1;
      Index normal = normals_[cell] ? normals_[cell][k] : -1;
      if (vertex_texture_.width > 0 && dimensions > 0) texture = vertices[k];
      if (vertex_normals_.width > 0 && dimensions == 2) normal = vertices[k];
      row.integer(" ", std::int64_t{vertices[k]} + 1);
      if (texture >= 0) {
        row.integer("/", std::int64_t{texture} + 1);
      } else if (normal >= 0) {
        row.write("/");
      }
      if (normal >= 0) row.integer("/", std::int64_t{normal} + 1);
    }
    row.write("\n");
  }

  void note_losses() {
    for (const DataArray& array : mesh_.data) {
      if (!written_.contains(&array)) note_array_unsupported(array, "OBJ", notes_);
    }
    for (std::size_t s = 0; s < mesh_.sets.size(); ++s) {
      const EntitySet& set = mesh_.sets[s];
      if (set.association == Association::vertices) {
        note_set_unsupported(set, "OBJ", notes_);
      } else if (group_names_[s] != set.name) {
        notes_.push_back(fmt::format("the set '{}' is written as the group '{}'", set.name, group_names_[s]));
      }
    }
    note_ids_unsupported(mesh_, "OBJ", notes_);
    if (!native_) note_metadata_unsupported(mesh_, "OBJ", notes_);
  }

  const Mesh& mesh_;
  Notes& notes_;
  const obj::ObjMetadata* native_;
  OutputFile out_;
  std::set<const DataArray*> written_;
  GatheredVector colors_;
  std::vector<Index> color_rows_;
  const std::vector<double>* weights_ = nullptr;
  std::vector<Index> weight_rows_;
  GatheredVector vertex_texture_;
  GatheredVector vertex_normals_;
  std::vector<const std::int32_t*> texture_;  // indices of each cell's corners; null if there are none
  std::vector<const std::int32_t*> normals_;
  std::array<std::vector<std::int32_t>, kStates.size()> states_;
  std::array<std::string, kStates.size()> current_;  // the last names written before the cells
  std::vector<Offset> group_offsets_;
  std::vector<Index> groups_;
  std::vector<std::string> group_names_;  // name for each set; empty for sets of vertices
  bool in_group_ = false;
};

void write_obj(const Mesh& mesh, const FilePath& path, Notes& notes) { ObjWriter(mesh, path, notes).write(); }

/// Returns the groups of cells with the same states and sets, see `Format::together`. O(cells + members).
std::vector<Index> cells_of_equal_statements(const Mesh& mesh) {
  const bool is_native = dynamic_cast<const obj::ObjMetadata*>(mesh.format_metadata.get()) != nullptr;
  std::vector<Checksum> statements(mesh.cells.shapes.size());
  for (std::size_t i = 0; i < kStates.size(); ++i) {
    if (!is_native && i != obj::kMaterial) continue;
    const DataArray* const array = find_array(mesh, kStates[i].array, Association::cells);
    const std::vector<std::int32_t> values =
        array != nullptr ? cell_integers(*array) : std::vector<std::int32_t>{};
    for (std::size_t c = 0; c < values.size(); ++c) statements[c].add(values[c]);
  }
  for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
    if (mesh.sets[s].association != Association::cells) continue;
    for (const Index cell : mesh.sets[s].members) statements[cell].add(s);
  }
  std::unordered_map<std::uint64_t, Index> group_of;
  std::vector<Index> groups;
  groups.reserve(statements.size());
  for (const Checksum& of_cell : statements)
    groups.push_back(group_of.try_emplace(of_cell.value(), index_size(group_of)).first->second);
  return groups;
}

}  // namespace

Format obj_format() {
  return {.name = "OBJ",
          .extensions = {".obj"},
          .groups_cells_by_type = false,
          .read = obj::read,
          .write = write_obj,
          .holds = obj_holds,
          .together = cells_of_equal_statements};
}

}  // namespace meshorder
