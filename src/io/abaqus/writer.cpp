// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/abaqus/abaqus.hpp"
#include "io/abaqus/output.hpp"
#include "io/all_formats.hpp"
#include "io/deck/numbers.hpp"
#include "io/labels.hpp"
#include "io/stream/output_file.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace meshorder::abaqus {
namespace {

/// Writes a deck of nodes, elements and sets for a mesh that has no deck of its own.
class PlainWriter {
 public:
  PlainWriter(const Mesh& mesh, const FilePath& path, Notes& notes)
      : mesh_(mesh),
        notes_(notes),
        file_(path),
        out_(file_, "\n"),
        vertices_(mesh.vertex_ids, kLargest),
        cells_(mesh.cell_ids, kLargest) {}

  void write() {
    write_nodes();
    write_elements();
    std::vector<EntitySet> sets = mesh_.sets;
    add_sets_of_labels(sets);
    write_sets(
        out_, sets, [&](Index v) { return vertices_.of(v); }, [&](Index c) { return cells_.of(c); }, notes_);
    file_.commit();
    note_losses();
  }

 private:
  [[nodiscard]] ElementKind kind_of_cell(Index c) const {
    return {mesh_.cells.shapes[c], static_cast<int>(mesh_.cells[c].size())};
  }

  void write_nodes() {
    out_.text("*NODE\n");
    out_.nodes(mesh_.points, mesh_.dimension,
               [&](DeckOutput::Row& row, Index v) { row.number = vertices_.of(v); });
  }

  void write_elements() {
    for (Index first = 0; first < mesh_.cell_count();) {
      const ElementKind kind = kind_of_cell(first);
      Index end = first + 1;
      while (end < mesh_.cell_count() && kind_of_cell(end) == kind) ++end;
      file_.print("*ELEMENT, TYPE={}\n", type_of(kind, mesh_.dimension == 2));
      out_.elements(end - first, [&](DeckOutput::Row& row, Index i) {
        const auto cell = mesh_.cells[first + i];
        row.number = cells_.of(first + i);
        row.nodes.resize(cell.size());
        for (std::size_t k = 0; k < cell.size(); ++k) row.nodes[node_place(kind, k)] = vertices_.of(cell[k]);
      });
      first = end;
    }
  }

  void add_sets_of_labels(std::vector<EntitySet>& sets) {
    const Labels labels = labels_of(mesh_, Association::cells);
    if (!labels.any()) return;
    const bool are_markers = mesh_.format == "su2";  // then label 0 is not a marker
    std::map<std::int64_t, EntitySet> by_label;
    for (Index c = 0; c < mesh_.cell_count(); ++c) {
      if (labels.given[c] && (labels.values[c] != 0 || !are_markers))
        by_label[labels.values[c]].members.push_back(c);
    }
    for (auto& [label, set] : by_label) {
      set.name = fmt::format("label_{}", label);
      sets.push_back(std::move(set));
    }
    notes_.emplace_back("labels of cells are written as sets of the names label_N");
  }

  void note_losses() {
    out_.note_rounded(notes_);
    note_arrays_beside_cell_labels(mesh_, "Abaqus", notes_);
    note_unfit_ids(mesh_, "Abaqus", kLargest, notes_);
    note_metadata_unsupported(mesh_, "Abaqus", notes_);
  }

  const Mesh& mesh_;
  Notes& notes_;
  OutputFile file_;
  DeckOutput out_;
  NewNumbers vertices_;
  NewNumbers cells_;
};

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  return !type_of({shape, vertices}, false).empty() || own_deck(mesh) != nullptr;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  if (const AbaqusMetadata* const own = own_deck(mesh)) return write_into_deck(mesh, *own, path, notes);
  PlainWriter(mesh, path, notes).write();
}

}  // namespace
}  // namespace meshorder::abaqus

namespace meshorder {

Format abaqus_format() {
  return {.name = "Abaqus",
          .extensions = {".inp"},
          .groups_cells_by_type = true,
          .read = abaqus::read,
          .write = abaqus::write,
          .holds = abaqus::holds,
          .first_number = 1};
}

}  // namespace meshorder
