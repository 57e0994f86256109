// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/all_formats.hpp"
#include "io/deck/numbers.hpp"
#include "io/gmsh/gmsh.hpp"
#include "io/labels.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <span>

// Writes the sections of a file. See reader.cpp for the specification.

namespace meshorder {
namespace gmsh {
namespace {

bool holds(const Mesh& /*mesh*/, Shape shape, int nodes) { return find_type(shape, nodes) != nullptr; }

/// Returns the type of each cell; the array kCellType decides between types of the same shape and number of
/// nodes.
std::vector<const ElementType*> types_of_cells(const Mesh& mesh) {
  const std::vector<std::int32_t> numbers = integers_of(mesh, kCellType, Association::cells);
  std::vector<const ElementType*> types;
  types.reserve(mesh.cells.shapes.size());
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const Shape shape = mesh.cells.shapes[c];
    const int nodes = mesh.cells.vertex_count(c);
    const ElementType* last = types.empty() ? nullptr : types.back();
    if (!last || last->shape != shape || last->nodes != nodes || !numbers.empty()) {
      last = find_type(shape, nodes);
      const ElementType* kept = numbers.empty() ? nullptr : find_type(numbers[c]);
      if (kept && kept->shape == shape && kept->nodes == nodes) last = kept;
    }
    types.push_back(last);
  }
  return types;
}

/// Returns ids if they are valid in Gmsh (at least `smallest`, distinct); else returns no ids and adds a
/// note.
std::vector<std::int64_t> usable_ids(const std::vector<std::int64_t>& ids, std::string_view what,
                                     std::int64_t smallest, Notes& notes) {
  if (ids.empty() || can_be_numbers(ids, std::numeric_limits<std::int64_t>::max(), smallest)) return ids;
  notes.push_back(fmt::format("the {} are renumbered: Gmsh's numbers are positive and distinct", what));
  return {};
}

bool is_parametric_2(const GmshMetadata& layout) {
  return layout.is_version_2() &&
         std::any_of(layout.sections.begin(), layout.sections.end(),
                     [](const MshSection& section) { return section.name == "ParametricNodes"; });
}

/// Returns whether the mesh still has the arrays that a file of this layout needs.
bool still_fits(const Mesh& mesh, const GmshMetadata& layout) {
  const bool has_node_entities = !integers_of(mesh, kNodeEntity, Association::vertices, 2).empty();
  if (layout.is_version_2()) return !is_parametric_2(layout) || (has_node_entities && parameters_of(mesh));
  return has_node_entities &&
         integers_of(mesh, kCellEntity, Association::cells).size() == mesh.cells.shapes.size();
}

/// Fills `output` with the ids, entities and tags of a mesh that came from a Gmsh file.
void take_layout(const GmshMetadata& layout, WriteContext& output, Notes& notes) {
  const Mesh& mesh = output.mesh;
  const auto place = [&](std::string_view name, Association association, Index components = 1) {
    const DataArray* const array = find_array(mesh, name, association);
    const bool fits = array && (components == kAnyComponents || array->components == components);
    if (fits) output.placed.push_back(array);
  };
  constexpr std::int64_t kSmallestRead = 0;
  output.node_ids = usable_ids(mesh.vertex_ids, "vertices", kSmallestRead, notes);
  output.cell_ids = usable_ids(mesh.cell_ids, "cells", kSmallestRead, notes);
  place(kCellEntity, Association::cells);
  if (layout.is_version_2()) {
    if (!integers_of(mesh, kLabel, Association::cells).empty()) place(kLabel, Association::cells);
    if (layout.is_version_1()) return;
    place(kCellPartitions, Association::cells, kAnyComponents);
    place(kCellTagCount, Association::cells);
    if (!is_parametric_2(layout)) return;
    output.node_entities = integers_of(mesh, kNodeEntity, Association::vertices, 2);
    place(kNodeEntity, Association::vertices, 2);
    place(kNodeParameters, Association::vertices, 4);
    return;
  }
  output.cell_tags = integers_of(mesh, kCellEntity, Association::cells);
  output.cell_dimensions = integers_of(mesh, kCellDimension, Association::cells);
  if (output.cell_dimensions.empty()) {
    output.cell_dimensions.reserve(mesh.cells.shapes.size());
    for (const Shape shape : mesh.cells.shapes) output.cell_dimensions.push_back(dimension(shape));
  }
  output.node_entities = integers_of(mesh, kNodeEntity, Association::vertices, 2);
  place(kCellDimension, Association::cells);
  place(kNodeEntity, Association::vertices, 2);
  place(kNodeParameters, Association::vertices, 4);
  if (layout.has(SectionKind::ghosts) && ghosts_of(mesh)) output.placed.push_back(ghosts_of(mesh));
  // labels that changed after reading differ from the groups of the entities, so they are written as data
  const std::vector<std::int32_t> labels = integers_of(mesh, kLabel, Association::cells);
  if (!labels.empty() && labels == labels_of_entities(mesh, layout)) place(kLabel, Association::cells);
}

/// Notes the sets that differ from the physical groups and periodic nodes of the layout.
void note_sets(const Mesh& mesh, const GmshMetadata& layout, Notes& notes) {
  const std::vector<EntitySet> of_layout = physical_sets(mesh, layout);
  using Name = std::pair<Association, std::string_view>;
  std::multimap<Name, const EntitySet*> physical;
  for (const EntitySet& set : of_layout) physical.emplace(Name(set.association, set.name), &set);
  std::set<std::string> periodic;
  for (const PeriodicLink& link : layout.periodic) {
    for (const NodePairs& pairs : link.pairs) periodic.insert({pairs.nodes, pairs.masters});
  }
  for (const EntitySet& set : mesh.sets) {
    if (set.association == Association::vertices && periodic.contains(set.name)) continue;
    std::vector<Index> members = set.members;
    std::sort(members.begin(), members.end());
    const auto [first, last] = physical.equal_range({set.association, set.name});
    const bool held =
        std::any_of(first, last, [&](const auto& other) { return members == other.second->members; });
    if (!held) note_set_unsupported(set, "Gmsh", notes);
  }
}

/// Adds a data section for every array that has no place in the file yet.
void add_views(GmshMetadata& layout, const WriteContext& output, Notes& notes) {
  std::set<std::pair<Association, std::string>> viewed;
  for (const View& view : layout.views) {
    if (view.array) viewed.emplace(view.association, *view.array);
  }
  for (const DataArray& array : output.mesh.data) {
    const auto& placed = output.placed;
    const bool has_view = viewed.contains({array.association, array.name});
    if (has_view || std::find(placed.begin(), placed.end(), &array) != placed.end()) continue;
    add_view(layout, array, notes);
  }
}

void write_section(NumberWriter& sink, const WriteContext& output, const MshSection& section) {
  if (section.name.empty()) return;  // version 1 has no section of the format
  const bool version_2 = output.layout.is_version_2();
  sink.out.print("${}\n", section.name);
  switch (section.kind) {
    case SectionKind::format:
      sink.out.print("{}\n", output.layout.header);
      if (!sink.binary) break;
      sink.int32(1);
      sink.out.write("\n");
      break;
    case SectionKind::verbatim:
      break;
    case SectionKind::nodes:
      version_2 ? write_nodes_2(sink, output) : write_nodes_4(sink, output);
      break;
    case SectionKind::elements:
      version_2 ? write_elements_2(sink, output) : write_elements_4(sink, output);
      break;
    case SectionKind::periodic:
      write_periodic(sink, output);
      break;
    case SectionKind::ghosts:
      write_ghosts(sink, output);
      break;
    case SectionKind::view:
      write_view(sink, output, output.layout.views[section.view]);
      break;
  }
  const bool has_binary = section.kind != SectionKind::format && section.kind != SectionKind::verbatim &&
                          !(version_2 && section.kind == SectionKind::periodic);
  if (sink.binary && has_binary) sink.out.write("\n");
  sink.out.write(section.text);
  sink.out.print("{}{}\n", output.layout.is_version_1() ? "$END" : "$End", section.name);
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const auto* own = dynamic_cast<const GmshMetadata*>(mesh.format_metadata.get());
  const bool keeps_layout = own && still_fits(mesh, *own);
  GmshMetadata layout = keeps_layout ? *own : GmshMetadata{};
  WriteContext output{mesh, layout, types_of_cells(mesh), {}, {}, {}, {}, {}, {}, NamedParts(mesh)};
  output.placed.push_back(label_array(mesh, Association::cells, kCellType));
  if (keeps_layout) {
    refit_views(layout, output.parts, notes);
    take_layout(layout, output, notes);
    note_sets(mesh, layout, notes);
  } else {
    note_metadata_unsupported(mesh, "Gmsh", notes);
    output.node_ids = usable_ids(mesh.vertex_ids, "vertices", 1, notes);
    output.cell_ids = usable_ids(mesh.cell_ids, "cells", 1, notes);
    classify(layout, output, notes);
  }
  add_views(layout, output, notes);

  OutputFile out(path);
  const std::string file = path.string();
  NumberWriter sink(out, file, layout.binary, layout.order);
  for (const MshSection& section : layout.sections) write_section(sink, output, section);
  out.commit();
}

}  // namespace

std::vector<std::string> GmshMetadata::contents() const {
  std::vector<std::string> result;
  std::set<std::string> known;
  const auto add = [&](std::string what) {
    if (known.insert(what).second) result.push_back(std::move(what));
  };
  for (const MshSection& section : sections) {
    if (section.kind != SectionKind::verbatim) continue;
    // other formats keep the groups as labels and sets, but not their numbers
    const bool has_names = section.name == "PhysicalNames";
    add(has_names ? "the numbers of named physical groups" : "Gmsh's $" + section.name);
  }
  if (!periodic.empty()) add(fmt::format("the pairs of {} periodic entities", periodic.size()));
  const bool timed = std::any_of(views.begin(), views.end(), [](const View& view) {
    return (!view.reals.empty() && view.reals[0] != 0) || view.integers[0] != 0;
  });
  if (timed) add("the times and steps of data");
  return result;
}

void write_cell_nodes(RowWriter& to, const WriteContext& output, Index c, bool wide) {
  const auto nodes = output.mesh.cells[c];
  const std::span<const int> order = vtk_order(output.types[c]->shape, output.types[c]->nodes);
  const auto put = [&](std::span<const Index> vertices) {
    if (wide)
      return to.all<std::int64_t>(vertices.size(),
                                  [&](std::size_t k) { return output.node_id(vertices[k]); });
    for (const Index v : vertices) to.int32(output.node_id(v));
  };
  if (order.empty()) return put(nodes);
  std::array<Index, 27> sorted{};
  for (std::size_t k = 0; k < order.size(); ++k) sorted[order[k]] = nodes[k];
  put(std::span(sorted).first(order.size()));
}

const std::vector<double>* parameters_of(const Mesh& mesh) {
  const DataArray* array = find_array(mesh, kNodeParameters, Association::vertices);
  if (!array || array->components != 4 || !array->is_dense()) return nullptr;
  return std::get_if<std::vector<double>>(&array->values);
}

std::vector<std::int32_t> integers_of(const Mesh& mesh, std::string_view name, Association association,
                                      Index components) {
  const DataArray* array = find_array(mesh, name, association);
  if (!array || (!array->is_dense() && array->components != 1)) return {};
  if (components != kAnyComponents && array->components != components) return {};
  std::vector<std::int32_t> given =
      with_integers(array->values, []<class Number>(const std::vector<Number>& values) {
        const bool fit = std::all_of(values.begin(), values.end(),
                                     [](Number value) { return std::in_range<std::int32_t>(value); });
        return fit ? std::vector<std::int32_t>(values.begin(), values.end()) : std::vector<std::int32_t>();
      });
  if (array->is_dense() || given.empty()) return given;
  std::vector<std::int32_t> all(static_cast<std::size_t>(item_count(mesh, association)), 0);
  for (std::size_t k = 0; k < given.size(); ++k) all[array->indices[k]] = given[k];
  return all;
}

}  // namespace gmsh

Format gmsh_format() {
  return {.name = "Gmsh",
          .extensions = {".msh"},
          .groups_cells_by_type = false,
          .read = gmsh::read,
          .write = gmsh::write,
          .holds = gmsh::holds,
          .first_number = 1,
          .has_numbers = true};
}

}  // namespace meshorder
