// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/all_formats.hpp"
#include "io/labels.hpp"
#include "io/medit/medit.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

namespace meshorder::medit {
namespace {

/// The sections of cells: their order, their cells, and each cell's position.
struct SectionOrder {
  std::array<std::vector<Index>, kCellKinds.size()> cells;
  std::array<Index, kCellKinds.size()> counts{};
  std::vector<std::size_t> kinds;
  std::vector<Index> place;  ///< position of each cell in its section
};

/// Orders sections by their first cells. If types are interleaved, orders the sections from volumes to edges,
/// as group_cells_by_type does.
SectionOrder layout_of(const Mesh& mesh) {
  SectionOrder layout;
  layout.place.reserve(mesh.cell_count());
  bool together = true;
  std::size_t last = kCellKinds.size();
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const std::size_t kind = kind_of(mesh.cells.shapes[c], mesh.cells.vertex_count(c));
    auto& cells = layout.cells[kind];
    if (cells.empty()) layout.kinds.push_back(kind);
    together = together && (cells.empty() || kind == last);
    last = kind;
    layout.place.push_back(index_size(cells));
    cells.push_back(c);
  }
  if (!together) {
    std::sort(layout.kinds.begin(), layout.kinds.end(), [](std::size_t a, std::size_t b) {
      const auto rank = [](const CellKind& kind) {
        return std::array{-dimension(kind.shape), static_cast<int>(kind.shape), kind.nodes};
      };
      return rank(kCellKinds[a]) < rank(kCellKinds[b]);
    });
  }
  for (std::size_t kind = 0; kind < kCellKinds.size(); ++kind)
    layout.counts[kind] = index_size(layout.cells[kind]);
  return layout;
}

struct WriteContext {
  const Mesh& mesh;
  const MeditMetadata* own;  ///< nullptr if the mesh comes from another format
  SectionOrder layout;
  Labels vertex_labels;
  Labels cell_labels;
};

/// Returns the version to write: 4 if a reference needs 64 bits, else the version of the file that the mesh
/// came from (2 if that file is not Medit's).
std::int64_t version(const WriteContext& from) {
  const std::int64_t wanted = from.own ? from.own->version : 2;
  return fit_32_bits(from.vertex_labels.values) && fit_32_bits(from.cell_labels.values) ? wanted : 4;
}

void write_vertices(OutputFile& out, const WriteContext& from) {
  const Mesh& mesh = from.mesh;
  out.print("\nVertices\n{}\n", mesh.vertex_count());
  write_rows(out, mesh.vertex_count(), [&](Text& row, Index v) {
    for (int k = 0; k < mesh.dimension; ++k) row.real(k == 0 ? "" : " ", mesh.points[v][k]);
    row.integer(" ", from.vertex_labels.any() ? from.vertex_labels.values[v] : 0);
    row.write("\n");
  });
}

/// Returns the positions of a kind's nodes in the file; empty for VTK's order.
std::vector<int> places(const WriteContext& from, std::size_t kind) {
  if (!from.own) return {};
  const auto found = from.own->places.find(kind);
  return found == from.own->places.end() ? std::vector<int>{} : found->second;
}

void write_cells(OutputFile& out, const WriteContext& from, std::size_t kind) {
  const auto& cells = from.layout.cells[kind];
  const std::vector<int> order = places(from, kind);
  out.print("\n{}\n{}\n", kCellKinds[kind].keyword, cells.size());
  write_rows(out, index_size(cells), [&](Text& row, Index i) {
    const Index c = cells[i];
    const auto cell = from.mesh.cells[c];
    std::array<Index, 27> as_given{};
    for (std::size_t k = 0; k < cell.size(); ++k) as_given[order.empty() ? k : order[k]] = cell[k];
    for (std::size_t k = 0; k < cell.size(); ++k)
      row.integer(k == 0 ? "" : " ", std::int64_t{as_given[k]} + 1);
    row.integer(cell.empty() ? "" : " ", from.cell_labels.any() ? from.cell_labels.values[c] : 0);
    row.write("\n");
  });
}

/// Writes the order of nodes in second-order cells.
void write_ordering(OutputFile& out, std::size_t kind) {
  const auto nodes = reference_nodes(kCellKinds[kind].shape);
  out.print("\n{}Ordering\n{}\n", kCellKinds[kind].keyword, nodes.size());
  for (const auto& node : nodes) out.print("{}\n", fmt::join(node, " "));
}

// ---- sections that refer to vertices or cells

/// Returns the position of a vertex or cell among the items that a section refers to; −1 if it is not among
/// them.
Index position_in(const WriteContext& from, const Target& target, Index item) {
  if (!target) return item;
  const std::size_t kind = counted_kind(*target, from.layout.counts);
  const auto& cells = from.mesh.cells;
  return kind_of(cells.shapes[item], cells.vertex_count(item)) == kind ? from.layout.place[item] : -1;
}

/// Returns the kind of section of that form and name if all `items` fit it, else nullptr.
const ReferenceKind* fitting_kind(Form form, const WriteContext& from, std::string_view name,
                                  Association association, const std::vector<Index>& items) {
  const auto found = std::ranges::find_if(kReferenceKinds, [&](const ReferenceKind& kind) {
    const Association of = target_of(kind.columns.front()) ? Association::cells : Association::vertices;
    return kind.form == form && kind.keyword == name && of == association;
  });
  if (found == kReferenceKinds.end()) return nullptr;
  const Target target = target_of(found->columns.front());
  const bool fit =
      std::ranges::all_of(items, [&](Index item) { return position_in(from, target, item) >= 0; });
  return fit ? &*found : nullptr;
}

void write_set(OutputFile& out, const WriteContext& from, const EntitySet& set, Notes& notes) {
  const ReferenceKind* kind = fitting_kind(Form::list, from, set.name, set.association, set.members);
  if (!kind) return note_set_unsupported(set, "Medit", notes);
  out.print("\n{}\n{}\n", set.name, set.members.size());
  const Target target = target_of(kind->columns.front());
  for (const Index member : set.members) out.print("{}\n", position_in(from, target, member) + 1);
}

void print_value(OutputFile& out, const Values& values, Offset at) {
  with_numbers(values, [&](const auto& numbers) { out.print(" {}", numbers[at]); });
}

/// Writes a section, except lines that name a vertex or cell without a position in the file.
void write_section_rows(OutputFile& out, const WriteContext& from, const MeditMetadata::Rows& section,
                        Notes& notes) {
  const std::string_view columns = section.columns;
  const auto others = static_cast<std::size_t>(std::count(columns.begin(), columns.end(), '.'));
  const std::size_t named = columns.size() - others;
  std::vector<std::string> lines;
  const std::size_t rows = named > 0 ? section.items.size() / named : section.kept.size() / others;
  for (std::size_t row = 0; row < rows; ++row) {
    const Index* item = section.items.data() + row * named;
    const double* kept = section.kept.data() + row * others;
    std::string line;
    bool whole = true;
    for (const char column : columns) {
      if (!line.empty()) line += ' ';
      if (column == '.') {
        line += fmt::format("{}", *kept++);
        continue;
      }
      const Index place = *item < 0 ? -1 : position_in(from, target_of(column), *item);
      ++item;
      whole = whole && place >= 0;
      line += std::to_string(place + 1);
    }
    if (whole) lines.push_back(std::move(line));
  }
  out.print("\n{}\n{}\n", section.keyword, lines.size());
  for (const std::string& line : lines) out.print("{}\n", line);
  if (lines.size() < rows) {
    notes.push_back(
        fmt::format("{} lines of {} are left out with their cells", rows - lines.size(), section.keyword));
  }
}

/// Writes an array on all vertices as the section of the same name; returns false if the array fits no
/// section.
bool write_sizes(OutputFile& out, const DataArray& array) {
  const bool known = std::any_of(kSizeKinds.begin(), kSizeKinds.end(), [&](const SizeKind& kind) {
    return kind.keyword == array.name && kind.components == array.components;
  });
  if (!known || !array.is_dense() || array.association != Association::vertices) return false;
  out.print("\n{}\n", array.name);
  for (Index v = 0; v < row_count(array); ++v) {
    for (Index k = 0; k < array.components; ++k) {
      print_value(out, array.values, Offset{v} * array.components + k);
    }
    out.write("\n");
  }
  return true;
}

/// Writes an array as the section of the same name if the mesh came from this format and the array fits; else
/// notes that it is not written.
void write_array(OutputFile& out, const WriteContext& from, const DataArray& array, Notes& notes) {
  const ReferenceKind* kind = nullptr;
  const bool numbers = !are_texts(array.values);
  if (from.own && numbers && write_sizes(out, array)) return;
  if (from.own && numbers && !array.is_dense()) {
    kind = fitting_kind(Form::table, from, array.name, array.association, array.indices);
  }
  if (!kind) return note_array_unsupported(array, "Medit", notes);
  out.print("\n{}\n{}\n", array.name, array.indices.size());
  for (Index row = 0; row < index_size(array.indices); ++row) {
    out.print("{}", position_in(from, target_of(kind->columns.front()), array.indices[row]) + 1);
    for (Index k = 0; k < array.components; ++k) {
      print_value(out, array.values, Offset{row} * array.components + k);
    }
    out.write("\n");
  }
}

// ---- the file

void write_sections(OutputFile& out, const WriteContext& from, bool before_vertices) {
  if (!from.own) return;
  for (const MeditMetadata::VerbatimSection& section : from.own->sections) {
    if (section.before_vertices == before_vertices) out.print("\n{}\n", section.text);
  }
}

void note_missing_labels(const Labels& labels, std::string_view what, Notes& notes) {
  const auto missing = std::count(labels.given.begin(), labels.given.end(), false);
  if (missing > 0) notes.push_back(fmt::format("{} {} have no label and get the reference 0", missing, what));
}

void write_all_cells(OutputFile& out, const WriteContext& from) {
  for (const std::size_t kind : from.layout.kinds) write_cells(out, from, kind);
  if (!from.own) {
    for (const std::size_t kind : from.layout.kinds) {
      if (kind >= kLinearKinds) write_ordering(out, kind);
    }
    return;
  }
  for (const std::size_t kind : from.own->empty_sections) {
    if (from.layout.counts[kind] == 0) write_cells(out, from, kind);
  }
}

bool holds(const Mesh& /*mesh*/, Shape shape, int vertices) {
  return kind_of(shape, vertices) < kCellKinds.size();
}

}  // namespace

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const WriteContext from{mesh, dynamic_cast<const MeditMetadata*>(mesh.format_metadata.get()),
                          layout_of(mesh), labels_of(mesh, Association::vertices),
                          labels_of(mesh, Association::cells)};
  OutputFile out(path);
  if (from.own) out.write(from.own->comments_before);
  out.print("MeshVersionFormatted {}\nDimension {}\n", version(from), mesh.dimension);
  write_sections(out, from, true);
  write_vertices(out, from);
  write_all_cells(out, from);
  for (const EntitySet& set : mesh.sets) write_set(out, from, set, notes);
  for (const DataArray& array : mesh.data) {
    if (&array != label_array(mesh, array.association)) write_array(out, from, array, notes);
  }
  if (from.own) {
    for (const MeditMetadata::Rows& section : from.own->rows) write_section_rows(out, from, section, notes);
  }
  write_sections(out, from, false);
  out.print("\nEnd{}\n", from.own ? from.own->after_end : "");
  out.commit();

  note_missing_labels(from.vertex_labels, "vertices", notes);
  note_missing_labels(from.cell_labels, "cells", notes);
  note_ids_unsupported(mesh, "Medit", notes);
  if (!from.own) note_metadata_unsupported(mesh, "Medit", notes);
  note_solutions(path, "does not fit the new mesh", notes);
}

}  // namespace meshorder::medit

namespace meshorder {

Format medit_format() {
  return {.name = "Medit",
          .extensions = {".mesh"},
          .groups_cells_by_type = true,
          .read = medit::read,
          .write = medit::write,
          .holds = medit::holds,
          .first_number = 1};
}

}  // namespace meshorder
