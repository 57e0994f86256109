// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Vega FEM's volumetric meshes (.veg), as its library volumetricMesh reads and writes them; the format is
// described in Vega's user manual, https://viterbi-web.usc.edu/~jbarbic/vega/. The corners of CUBIC elements
// come in VTK's order.
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/deck/numbers.hpp"
#include "io/named_parts.hpp"
#include "io/names.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"
#include "io/vega/parts.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <type_traits>

namespace meshorder {
namespace {
using vega::Kind;
using vega::VegaSection;

bool vega_holds(const Mesh& /*mesh*/, Shape shape, int vertices) {
  return (shape == Shape::tetrahedron && vertices == 4) || (shape == Shape::hexahedron && vertices == 8);
}

constexpr std::int64_t kLargestNumber =
    std::numeric_limits<std::int64_t>::max();  // number of a vertex or cell

/// Writes one mesh. A mesh from a Vega file keeps its order of sections; other meshes get the usual order.
class VegaWriter {
 public:
  VegaWriter(const Mesh& mesh, const FilePath& path, Notes& notes)
      : mesh_(mesh),
        parts_(mesh),
        notes_(notes),
        native_(dynamic_cast<const vega::VegaMetadata*>(mesh.format_metadata.get())),
        vertices_(native_ ? mesh.vertex_ids : none_, kLargestNumber, 0, native_ ? native_->vertex_base : 1),
        elements_(native_ ? mesh.cell_ids : none_, kLargestNumber, 0, native_ ? native_->element_base : 1),
        out_(path) {}

  void write() {
    choose_sections();
    note_losses();
    for (const VegaSection& section : sections_) {
      if (section.kind != Kind::set) continue;
      const EntitySet& set = set_of(section);
      names_.emplace(&set, name_of(set));
    }
    for (const VegaSection& section : sections_) write_section(section);
    if (native_) out_.write(native_->closing_comments);
    out_.commit();
  }

 private:
  void choose_sections() {
    std::vector<bool> has_section(mesh_.sets.size(), false);
    if (native_) {
      for (const VegaSection& section : native_->sections) {
        if (section.kind == Kind::set && !is_cell_set(section.set)) continue;
        if (section.kind == Kind::region && !has_set(section.region_set)) {
          notes_.push_back("the region of the set '" + section.region_set +
                           "' is not written: the mesh no longer has the set");
          continue;
        }
        if (section.kind == Kind::set) has_section[section.set] = true;
        sections_.push_back(section);
      }
    } else {
      add_section(Kind::vertices);
      add_section(Kind::elements);
    }
    for (std::size_t i = 0; i < mesh_.sets.size(); ++i) {
      if (!has_section[i] && is_cell_set(i)) add_section(Kind::set, i);
    }
  }

  void add_section(Kind kind, std::size_t set = 0) {
    VegaSection& section = sections_.emplace_back();
    section.kind = kind;
    section.set = set;
  }

  [[nodiscard]] bool has_set(const std::string& name) const {
    return name == vega::kAllElements || parts_.set(name, Association::cells) != nullptr;
  }

  [[nodiscard]] bool is_cell_set(std::size_t i) const {
    return i < mesh_.sets.size() && mesh_.sets[i].association == Association::cells;
  }

  void note_losses() {
    for (const EntitySet& set : mesh_.sets) {
      if (set.association == Association::vertices) note_set_unsupported(set, "Vega", notes_);
    }
    for (const DataArray& array : mesh_.data) {
      if (&array == vertex_attributes() || &array == element_attributes() || &array == markers()) continue;
      if (native_ && is_cell_label(array) && array.values == Values(vega::region_numbers(*native_, mesh_)))
        continue;
      if (!native_ && is_cell_label(array)) {
        write_labels_as_sets(array);
      } else {
        note_array_unsupported(array, "Vega", notes_);
      }
    }
    if (native_) {
      for (const std::string& name : native_->included) {
        notes_.push_back("the file '" + name + "', which was included, is written inline");
      }
      note_unfit_ids(mesh_, "Vega", kLargestNumber, notes_, 0);
    } else {
      note_ids_unsupported(mesh_, "Vega", notes_);
      note_metadata_unsupported(mesh_, "Vega", notes_);
    }
  }

  static bool is_cell_label(const DataArray& array) {
    return array.association == Association::cells && array.name == kLabel && array.components == 1 &&
           array.is_dense() &&
           (std::holds_alternative<std::vector<std::int32_t>>(array.values) ||
            std::holds_alternative<std::vector<std::int64_t>>(array.values));
  }

  /// Writes the cells of each label as a set: without materials there can be no regions.
  void write_labels_as_sets(const DataArray& array) {
    std::map<std::int64_t, EntitySet> sets;
    with_integers(array.values, [&](const auto& values) {
      for (Index c = 0; c < mesh_.cell_count(); ++c) sets[values[c]].members.push_back(c);
    });
    for (auto& [label, set] : sets) {
      set.name = fmt::format("label_{}", label);
      add_section(Kind::set, mesh_.sets.size() + label_sets_.size());
      label_sets_.push_back(std::move(set));
    }
    notes_.push_back("labels of cells are written as sets named label_N");
  }

  [[nodiscard]] const DataArray* attributes(Association association, int width) const {
    if (!native_ || width == 0) return nullptr;
    const DataArray* array = find_array(mesh_, vega::kAttributes, association);
    const bool fits = array && array->is_dense() && array->components == width &&
                      std::holds_alternative<std::vector<double>>(array->values);
    return fits ? array : nullptr;
  }
  [[nodiscard]] const DataArray* vertex_attributes() const {
    return attributes(Association::vertices, native_ ? native_->vertex_attributes : 0);
  }
  [[nodiscard]] const DataArray* element_attributes() const {
    return attributes(Association::cells, native_ ? native_->element_attributes : 0);
  }
  [[nodiscard]] const DataArray* markers() const {
    if (!native_ || !native_->vertex_markers) return nullptr;
    const DataArray* array = find_array(mesh_, kLabel, Association::vertices);
    const bool fits = array && array->is_dense() && array->components == 1 &&
                      std::holds_alternative<std::vector<std::int32_t>>(array->values);
    return fits ? array : nullptr;
  }

  void write_section(const VegaSection& section) {
    out_.write(section.comments);
    switch (section.kind) {
      case Kind::vertices:
        return write_vertices();
      case Kind::elements:
        return write_elements();
      case Kind::set:
        return write_set(set_of(section));
      case Kind::region:
        return out_.print("*REGION\n{}, {}\n\n", written_name(section.region_set), section.region_material);
      case Kind::material:
        out_.print("*MATERIAL {}\n", section.title);
        break;
      case Kind::other:
        out_.print("{}\n", section.title);
        break;
    }
    for (const std::string& line : section.lines) out_.print("{}\n", line);
    out_.write("\n");
  }

  static void add_values(Text& text, const DataArray* array, Index row) {
    if (!array) return;
    const auto& values = std::get<std::vector<double>>(array->values);
    for (Index k = 0; k < array->components; ++k) {
      text.real(" ", values[static_cast<Offset>(row) * array->components + k]);
    }
  }

  void write_vertices() {
    const DataArray* extra = vertex_attributes();
    const DataArray* marker = markers();
    out_.print("*VERTICES\n{} 3 {} {}\n", mesh_.vertex_count(), extra ? extra->components : 0,
               marker ? 1 : 0);
    write_rows(out_, mesh_.vertex_count(), [&](Text& row, Index v) {
      row.integer("", vertices_.of(v));
      for (const double x : mesh_.points[v]) row.real(" ", x);
      add_values(row, extra, v);
      if (marker) row.integer(" ", std::get<std::vector<std::int32_t>>(marker->values)[v]);
      row.write("\n");
    });
    out_.write("\n");
  }

  void write_elements() {
    const DataArray* extra = element_attributes();
    const int width = mesh_.cell_count() == 0 ? 4 : mesh_.cells.vertex_count(0);
    out_.print("*ELEMENTS\n{}\n{} {} {}\n", word_of(width), mesh_.cell_count(), width,
               extra ? extra->components : 0);
    write_rows(out_, mesh_.cell_count(), [&](Text& row, Index c) {
      row.integer("", elements_.of(c));
      for (const Index v : mesh_.cells[c]) row.integer(" ", vertices_.of(v));
      add_values(row, extra, c);
      row.write("\n");
    });
    out_.write("\n");
  }

  /// Returns the element word of the file that was read, such as TETS, if it still fits, else the usual word.
  [[nodiscard]] std::string word_of(int width) const {
    const std::string usual = width == 4 ? "TET" : "CUBIC";
    const bool fits = native_ && same_but_for_case(native_->element_word.substr(0, usual.size()), usual);
    return fits ? native_->element_word : usual;
  }

  [[nodiscard]] const EntitySet& set_of(const VegaSection& section) const {
    return section.set < mesh_.sets.size() ? mesh_.sets[section.set]
                                           : label_sets_[section.set - mesh_.sets.size()];
  }

  /// Returns the name that is written for the set `of_set`.
  [[nodiscard]] const std::string& written_name(const std::string& of_set) const {
    const auto found = names_.find(parts_.set(of_set, Association::cells));
    return found == names_.end() ? of_set : found->second;  // not the name of a set: all elements
  }

  /// Returns a free name for the set that fits Vega's lines; notes a new name.
  std::string name_of(const EntitySet& set) {
    const std::string name = plain_name(set.name, "#");
    const std::string_view words = trimmed(name);
    std::string result = set_names_.take(words.empty() ? "set" : words);
    note_renamed_set(set, result, notes_);
    return result;
  }

  void write_set(const EntitySet& set) {
    constexpr std::size_t kPerLine = 8;
    out_.print("*SET {}\n", names_.at(&set));
    for (std::size_t i = 0; i < set.members.size(); ++i) {
      const bool last = i + 1 == set.members.size();
      const bool full = (i + 1) % kPerLine == 0;
      out_.print("{}{}", elements_.of(set.members[i]), last ? "\n" : full ? ",\n" : ", ");
    }
    out_.write("\n");
  }

  const Mesh& mesh_;
  NamedParts parts_;
  Notes& notes_;
  const vega::VegaMetadata* native_;
  std::vector<std::int64_t> none_;
  // a mesh from a Vega file keeps the file's numbers, although Vega itself counts lines when it reads
  NewNumbers vertices_;
  NewNumbers elements_;
  OutputFile out_;
  std::vector<VegaSection> sections_;
  std::vector<EntitySet> label_sets_;
  DistinctNames set_names_;
  std::map<const EntitySet*, std::string> names_;  ///< the name that each set gets in the file
};

std::string vega_conflict(const Mesh& mesh) {
  const std::vector<Shape>& shapes = mesh.cells.shapes;
  const bool one_shape =
      std::adjacent_find(shapes.begin(), shapes.end(), std::not_equal_to<>()) == shapes.end();
  return one_shape ? "" : "Vega cannot hold both tetrahedra and hexahedra in one file";
}

void write_vega(const Mesh& mesh, const FilePath& path, Notes& notes) {
  VegaWriter(mesh, path, notes).write();
}

std::int64_t first_number_of(const Mesh& mesh, Association of) {
  const auto* const own = dynamic_cast<const vega::VegaMetadata*>(mesh.format_metadata.get());
  if (own == nullptr) return 1;
  return of == Association::vertices ? own->vertex_base : own->element_base;
}

}  // namespace

Format vega_format() {
  return {.name = "Vega",
          .extensions = {".veg"},
          .groups_cells_by_type = false,
          .read = vega::read,
          .write = write_vega,
          .holds = vega_holds,
          .conflict = vega_conflict,
          .first_number_of = first_number_of};
}

}  // namespace meshorder
