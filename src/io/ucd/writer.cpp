// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/deck/numbers.hpp"
#include "io/exact_values.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/ucd/ucd.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <variant>

namespace meshorder::ucd {
namespace {

const CellKind* kind_of(Shape shape, int nodes) {
  const auto* const found = std::find_if(kCellKinds.begin(), kCellKinds.end(), [&](const CellKind& kind) {
    return kind.shape == shape && kind.nodes == nodes;
  });
  return found == kCellKinds.end() ? nullptr : found;
}

bool holds(const Mesh& /*mesh*/, Shape shape, int vertices) { return kind_of(shape, vertices) != nullptr; }

class Writer {
 public:
  Writer(const Mesh& mesh, const FilePath& path, Notes& notes)
      : mesh_(mesh),
        own_(dynamic_cast<const UcdMetadata*>(mesh.format_metadata.get())),
        notes_(notes),
        out_(path),
        nodes_(mesh.vertex_ids, kMaxIndex, 0),
        cells_(mesh.cell_ids, kMaxIndex, 0) {}

  void write() {
    collect_arrays();
    if (own_ != nullptr) out_.write(own_->comments_before);
    out_.print("{} {} {} {} {}\n", mesh_.vertex_count(), mesh_.cell_count(), values_of(Association::vertices),
               values_of(Association::cells), own_ != nullptr ? own_->model_values : 0);
    write_rows(out_, mesh_.vertex_count(), [&](Text& row, Index v) {
      row.integer("", nodes_.of(v));
      for (const double coordinate : mesh_.points[v]) row.real(" ", coordinate);
      row.write("\n");
    });
    write_cells();
    write_data(Association::vertices, nodes_);
    write_data(Association::cells, cells_);
    if (own_ != nullptr) out_.write(own_->model_data);
    out_.commit();
    note_losses();
  }

 private:
  struct Array {
    const DataArray* array;
    std::string label;  ///< the line with the array's label and unit
  };

  [[nodiscard]] const std::vector<Array>& arrays_of(Association association) const {
    return association == Association::vertices ? node_arrays_ : cell_arrays_;
  }

  [[nodiscard]] Offset values_of(Association association) const {
    Offset values = 0;
    for (const Array& array : arrays_of(association)) values += array.array->components;
    return values;
  }

  /// Finds the arrays that the file can hold, and the lines of their labels. Labels of cells are written as
  /// materials instead.
  void collect_arrays() {
    DistinctNames of_nodes;
    DistinctNames of_cells;
    (void)of_cells.take(kLabel);
    for (const DataArray& array : mesh_.data) {
      if (&array == label_array(mesh_, Association::cells)) continue;
      if (!array.is_dense() || are_texts(array.values)) {
        note_array_unsupported(array, "AVS UCD", notes_);
        continue;
      }
      const bool on_nodes = array.association == Association::vertices;
      (on_nodes ? node_arrays_ : cell_arrays_)
          .push_back({&array, label_of(array, on_nodes ? of_nodes : of_cells)});
      if (!are_exact<double>(array.values)) {
        notes_.push_back(fmt::format(
            "the array '{}' loses digits: data of AVS UCD are real numbers of 53 bits", array.name));
      }
    }
  }

  std::string label_of(const DataArray& array, DistinctNames& names) {
    if (own_ != nullptr) {
      const auto known = own_->labels.find(std::pair(array.association, array.name));
      if (known != own_->labels.end()) return known->second;
    }
    std::string plain = plain_name(array.name, ",");
    plain = trimmed(plain);
    const std::string name = names.take(plain.empty() ? "data" : plain);
    note_renamed_array(array, name, notes_);
    return name + ", ";
  }

  void write_cells() {
    const Labels materials = labels_of(mesh_, Association::cells);
    write_rows(out_, mesh_.cell_count(), [&](Text& row, Index c) {
      std::array<Index, 8> as_given{};
      const auto cell = mesh_.cells[c];
      const CellKind& kind = *kind_of(mesh_.cells.shapes[c], static_cast<int>(cell.size()));
      row.integer("", cells_.of(c));
      row.integer(" ", materials.any() ? materials.values[c] : 0);
      row.write(" ");
      row.write(kind.name);
      for (std::size_t k = 0; k < cell.size(); ++k)
        as_given[static_cast<std::size_t>(kind.places[k])] = cell[k];
      for (std::size_t k = 0; k < cell.size(); ++k) row.integer(" ", nodes_.of(as_given[k]));
      row.write("\n");
    });
    const auto missing = std::count(materials.given.begin(), materials.given.end(), false);
    if (missing > 0) notes_.push_back(fmt::format("{} cells have no label and get the material 0", missing));
  }

  void write_data(Association association, const NewNumbers& numbers) {
    const std::vector<Array>& arrays = arrays_of(association);
    if (arrays.empty()) return;
    out_.integer("", index_size(arrays));
    for (const Array& array : arrays) out_.integer(" ", array.array->components);
    out_.write("\n");
    for (const Array& array : arrays) out_.print("{}\n", array.label);
    const Index rows = association == Association::vertices ? mesh_.vertex_count() : mesh_.cell_count();
    write_rows(out_, rows, [&](Text& text, Index row) {
      text.integer("", numbers.of(row));
      for (const Array& array : arrays) add_values(text, *array.array, row);
      text.write("\n");
    });
  }

  static void add_values(Text& text, const DataArray& array, Index row) {
    with_numbers(array.values, [&]<class Value>(const std::vector<Value>& values) {
      for (Index k = 0; k < array.components; ++k) {
        const Value value = values[Offset{row} * array.components + k];
        // a float is written as the same double, which reads back exactly
        if constexpr (std::is_same_v<Value, float>) {
          text.real(" ", double{value});
        } else {
          text.number(" ", value);
        }
      }
    });
  }

  void note_losses() {
    for (const EntitySet& set : mesh_.sets) note_set_unsupported(set, "AVS UCD", notes_);
    note_unfit_ids(mesh_, "AVS UCD", kMaxIndex, notes_, 0);
    if (own_ == nullptr) note_metadata_unsupported(mesh_, "AVS UCD", notes_);
  }

  const Mesh& mesh_;
  const UcdMetadata* own_;  // nullptr if the mesh comes from another format
  Notes& notes_;
  OutputFile out_;
  NewNumbers nodes_;
  NewNumbers cells_;
  std::vector<Array> node_arrays_;
  std::vector<Array> cell_arrays_;
};

}  // namespace

std::vector<std::string> UcdMetadata::contents() const {
  std::vector<std::string> result;
  for (const auto& [array, line] : labels) {
    const std::size_t comma = line.find(',');
    if (comma == std::string::npos) continue;
    const std::string_view unit = trimmed(std::string_view(line).substr(comma + 1));
    if (!unit.empty()) result.push_back(fmt::format("the unit '{}' of '{}'", unit, array.second));
  }
  if (!model_data.empty()) result.emplace_back("data of the model");
  return result;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) { Writer(mesh, path, notes).write(); }

}  // namespace meshorder::ucd

namespace meshorder {

Format ucd_format() {
  return {.name = "UCD",
          .extensions = {".avs", ".ucd"},
          .groups_cells_by_type = false,
          .read = ucd::read,
          .write = ucd::write,
          .holds = ucd::holds,
          .first_number = 1,
          .has_numbers = true};
}

}  // namespace meshorder
