// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "io/all_formats.hpp"
#include "io/cell_division.hpp"
#include "io/cgns/cgns.hpp"
#include "io/cgns/cgns_library.hpp"
#include "io/cgns/numbering.hpp"
#include "io/labels.hpp"
#include "io/named_parts.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

// Chooses the nodes of a file and writes them with the values of the mesh.

namespace meshorder::cgns {
namespace {

void move_positions(std::vector<Index>& positions, std::span<const Index> places) {
  for (Index& position : positions) {
    if (position >= 0) position = places[position];
  }
}

/// Returns values, one for each vertex or cell, at their new positions; drops those with position −1.
std::vector<Index> moved_values(const std::vector<Index>& values, std::span<const Index> places) {
  std::vector<Index> result(values.size());
  Index kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (places[i] < 0) continue;
    result[places[i]] = values[i];
    ++kept;
  }
  result.resize(static_cast<std::size_t>(kept));
  return result;
}

/// Returns whether the vertices of a cell are the corners of a polyhedron's faces, each once.
/// `polyhedron_with`: for each vertex, the last polyhedron found to have this corner. Call once for each
/// polyhedron.
bool has_corners_of(Index polyhedron, std::span<const Index> cell, const CgnsMetadata& metadata,
                    std::vector<Index>& polyhedron_with) {
  std::size_t corners = 0;
  for (const Index face : metadata.polyhedra->faces_of(polyhedron)) {
    for (const Index corner : metadata.polyhedra->corners_of(Polyhedra::polygon_of(face))) {
      if (std::exchange(polyhedron_with[metadata.vertex_at(corner)], polyhedron) != polyhedron) ++corners;
    }
  }
  if (cell.size() != corners) return false;
  return std::all_of(cell.begin(), cell.end(),
                     [&](Index vertex) { return std::exchange(polyhedron_with[vertex], -1) == polyhedron; });
}

/// Returns whether the cells that are polygons or polyhedra still have the vertices that the metadata give.
/// O(size of the mesh).
bool polyhedra_fit(const Mesh& mesh, const CgnsMetadata& metadata) {
  if (metadata.polyhedra == nullptr) return true;
  Index cells = 0;
  for (Index p = 0; p < index_size(metadata.cell_of_polygon); ++p) {
    const Index c = metadata.cell_of_polygon[p];
    if (c < 0) continue;
    ++cells;
    if (!std::ranges::equal(mesh.cells[c], metadata.polyhedra->corners_of(p), {}, {},
                            [&](Index corner) { return metadata.vertex_at(corner); })) {
      return false;
    }
  }
  std::vector<Index> polyhedron_with(mesh.points.size(), -1);
  for (Index p = 0; p < index_size(metadata.cell_of_polyhedron); ++p) {
    const Index c = metadata.cell_of_polyhedron[p];
    if (c < 0) continue;
    ++cells;
    if (dimension(mesh.cells.shapes[c]) < 3 || !has_corners_of(p, mesh.cells[c], metadata, polyhedron_with)) {
      return false;
    }
  }
  return cells == std::count_if(metadata.section_of_cell.begin(), metadata.section_of_cell.end(),
                                [&](Index s) { return metadata.sections[s].is_of_polyhedra(); });
}

/// Returns whether the vertices, the cells and their types still agree with the metadata.
bool still_fits(const Mesh& mesh, const CgnsMetadata& metadata) {
  if (index_size(metadata.section_of_cell) != mesh.cell_count()) return false;
  if (!metadata.zone_of_vertex.empty() && index_size(metadata.zone_of_vertex) != mesh.vertex_count()) {
    return false;
  }
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const Section& section = metadata.sections[metadata.section_of_cell[c]];
    const ElementType* const type = element_type(section.type);
    const Shape shape = mesh.cells.shapes[c];
    const int nodes = mesh.cells.vertex_count(c);
    const bool fits = type != nullptr                  ? type->shape == shape && type->nodes == nodes
                      : section.type == kMixedElements ? element_type_of(shape, nodes) != nullptr
                                                       : true;
    if (!fits) return false;
  }
  return polyhedra_fit(mesh, metadata);
}

/// Updates the lists whose sets have changed in the mesh, and marks them as shortened. Clears the lists whose
/// sets are gone.
void take_sets(const Mesh& mesh, CgnsMetadata& metadata) {
  for (PointList& list : metadata.lists) {
    if (list.set.empty()) continue;
    const auto set = std::find_if(mesh.sets.begin(), mesh.sets.end(), [&](const EntitySet& one) {
      return one.name == list.set && one.association == list.association;
    });
    if (set == mesh.sets.end()) {
      list.members.clear();
      continue;
    }
    if (unique_members(list.members) == set->members) continue;
    // only members of the list's zone: a condition belongs to one zone
    list.members.clear();
    for (const Index member : set->members) {
      if (metadata.zone_of(list.association, member) == list.zone) list.members.push_back(member);
    }
    list.is_shortened = true;
  }
}

/// Returns whether an array has one number in each row, and the fields cover the vertex or cell of each row.
bool fits(const DataArray& array, const std::vector<const Field*>& fields, const Mesh& mesh,
          const Numbering& numbering) {
  if (array.components != 1 || are_texts(array.values)) return false;
  std::vector<bool> has_place(item_count(mesh, array.association));
  for (const Field* const field : fields) {
    for (const Index item : numbering.rows_of(*field)) has_place[item] = true;
  }
  const auto has_value = [&](Index item) { return has_place[item]; };
  return array.is_dense() ? std::find(has_place.begin(), has_place.end(), false) == has_place.end()
                          : std::all_of(array.indices.begin(), array.indices.end(), has_value);
}

/// Sets `has_left` in the fields of each array that no longer fits them.
void release_arrays(const Mesh& mesh, CgnsMetadata& metadata, const Numbering& numbering) {
  std::map<std::pair<Association, std::string>, std::vector<const Field*>> by_array;
  for (const Field& field : metadata.fields) {
    if (field.role != Field::Role::values || field.has_left) continue;
    by_array[{field.association, field.array}].push_back(&field);
  }
  const NamedParts parts(mesh);
  std::set<std::pair<Association, std::string>> released;
  for (const auto& [key, fields] : by_array) {
    const DataArray* const array = parts.array(key.second, key.first);
    if (array != nullptr && !fits(*array, fields, mesh, numbering)) released.insert(key);
  }
  for (Field& field : metadata.fields) {
    if (released.contains({field.association, field.array})) field.has_left = true;
  }
}

/// Removes nodes that have nothing left to write: sections without cells, conditions and solutions without
/// members, and arrays that are gone. Also removes data in the order of a list whose members changed, and
/// notes this.
class Pruner {
 public:
  Pruner(const Mesh& mesh, const CgnsMetadata& metadata, const Numbering& numbering, Notes& notes)
      : mesh_(mesh), metadata_(metadata), numbering_(numbering), notes_(notes) {}

  void prune(Node& node) const {
    if (node.label == "Zone_t") prune_regions(node);
    std::erase_if(node.children, [&](const Node& child) { return is_gone(child); });
    if (const Node* const list = shortened_list(node)) {
      const auto before = node.children.size();
      std::erase_if(node.children, [&](const Node& child) {
        return child.label == "BCDataSet_t" || child.label == "InwardNormalList_t" ||
               child.name == "InwardNormalList" || child.name == "PointListDonor" ||
               child.name == "CellListDonor";
      });
      if (node.children.size() != before) {
        notes_.push_back(fmt::format("the data of '{}' are left out: its {} has other members now", node.name,
                                     list->name));
      }
    }
    for (Node& child : node.children) prune(child);
  }

 private:
  /// Removes regions that name a condition or connectivity that is gone. Removes the data of regions that
  /// name a condition or connectivity whose members have changed.
  void prune_regions(Node& zone) const {
    std::set<std::string> gone;
    std::set<std::string> changed;
    for (const Node& group : zone.children) {
      if (group.label != "ZoneBC_t" && group.label != "ZoneGridConnectivity_t") continue;
      for (const Node& part : group.children) {
        if (is_gone(part)) gone.insert(part.name);
        if (shortened_list(part) != nullptr) changed.insert(part.name);
      }
    }
    std::erase_if(zone.children, [&](Node& region) {
      const std::string part = region.label == "ZoneSubRegion_t" ? named_part(region) : "";
      if (gone.contains(part)) {
        notes_.push_back(fmt::format("the region '{}' is left out: it belongs to '{}', which has no members",
                                     region.name, part));
        return true;
      }
      const auto is_data = [](const Node& child) { return child.label == "DataArray_t"; };
      if (changed.contains(part) && std::erase_if(region.children, is_data) > 0) {
        notes_.push_back(
            fmt::format("the data of '{}' are left out: '{}' has other members now", region.name, part));
      }
      return false;
    });
  }

  /// Returns the name of the condition or connectivity that a region refers to; empty if there is none.
  static std::string named_part(const Node& region) {
    for (const std::string_view name : {"BCRegionName", "GridConnectivityRegionName"}) {
      if (const Node* const part = region.child(name)) return part->text();
    }
    return {};
  }

  /// Returns whether a node has a field with nothing to write: an empty section or list, or an array that is
  /// gone or no longer fits.
  [[nodiscard]] bool has_gone_field(const Node& node) const {
    if (node.field < 0) return false;
    const Field& field = metadata_.fields[node.field];
    switch (field.role) {
      case Field::Role::connectivity:
        return numbering_.elements_of(field.place).empty();
      case Field::Role::values:
        return field.has_left || find_array(mesh_, field.array, field.association) == nullptr;
      case Field::Role::list:
        return metadata_.lists[field.place].members.empty();
      default:
        return false;
    }
  }

  [[nodiscard]] bool is_gone(const Node& node) const {
    if (has_gone_field(node)) return true;
    return std::any_of(node.children.begin(), node.children.end(), [&](const Node& child) {
      if (!has_gone_field(child)) return false;
      const Field::Role role = metadata_.fields[static_cast<std::size_t>(child.field)].role;
      return role == Field::Role::connectivity || role == Field::Role::list;
    });
  }

  [[nodiscard]] const Node* shortened_list(const Node& node) const {
    for (const Node& child : node.children) {
      if (child.field < 0) continue;
      const Field& field = metadata_.fields[static_cast<std::size_t>(child.field)];
      if (field.role == Field::Role::list && metadata_.lists[field.place].is_shortened) return &child;
    }
    return nullptr;
  }

  const Mesh& mesh_;
  const CgnsMetadata& metadata_;
  const Numbering& numbering_;
  Notes& notes_;
};

/// Returns the metadata of a mesh that was read from CGNS, null for other meshes.
const CgnsMetadata* own_metadata(const Mesh& mesh) {
  return dynamic_cast<const CgnsMetadata*>(mesh.format_metadata.get());
}

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  const ElementType* const type = element_type_of(shape, vertices);
  constexpr int kLastOfSecondOrder = 21;
  const CgnsMetadata* const own = own_metadata(mesh);
  if (type == nullptr) {
    return own != nullptr && ((shape == Shape::polygon && !own->cell_of_polygon.empty()) ||
                              (shape == Shape::polyhedron && !own->cell_of_polyhedron.empty()));
  }
  return type->number <= kLastOfSecondOrder || own != nullptr;
}

/// Returns the positions of cells in the file: cells of lower dimensions, the boundaries, follow the others.
Permutation places(const Mesh& mesh, std::vector<Index>& blocks) {
  return places_by_division(divide_cells(mesh, {.sets = true}), blocks);
}

}  // namespace

std::shared_ptr<const FormatMetadata> CgnsMetadata::moved(std::span<const Index> vertices,
                                                          std::span<const Index> cells) const {
  auto result = std::make_shared<CgnsMetadata>(*this);
  for (PointList& list : result->lists) {
    const std::span<const Index> places = list.association == Association::vertices ? vertices : cells;
    if (places.empty()) continue;
    move_positions(list.members, places);
    list.is_shortened = std::erase(list.members, Index{-1}) > 0 || list.is_shortened;
  }
  if (!cells.empty()) {
    result->section_of_cell = moved_values(section_of_cell, cells);
    move_positions(result->cell_of_polygon, cells);
    move_positions(result->cell_of_polyhedron, cells);
    for (Parents& of_section : result->parents) {
      if (!of_section.of_polygons) move_positions(of_section.rows, cells);
      move_positions(of_section.cells, cells);
    }
  }
  if (!vertices.empty() && polyhedra != nullptr) {
    if (vertex_places.empty()) {
      result->vertex_places.assign(vertices.begin(), vertices.end());
    } else {
      move_positions(result->vertex_places, vertices);
    }
  }
  if (!vertices.empty() && !zone_of_vertex.empty()) {
    result->zone_of_vertex = moved_values(zone_of_vertex, vertices);
  }
  return result;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const CgnsMetadata* const own = own_metadata(mesh);
  std::shared_ptr<CgnsMetadata> metadata;
  if (own != nullptr && still_fits(mesh, *own)) {
    metadata = std::make_shared<CgnsMetadata>(*own);
  } else {
    metadata = layout_of(mesh);
    note_metadata_unsupported(mesh, "CGNS", notes);
    note_number_markers(mesh, "labels of their sections, without boundary conditions", notes);
  }
  const Numbering numbering(mesh, *metadata);
  take_sets(mesh, *metadata);
  release_arrays(mesh, *metadata, numbering);
  add_missing(mesh, *metadata, numbering, notes);
  note_ids_unsupported(mesh, "CGNS", notes);
  if (!std::is_sorted(metadata->zone_of_vertex.begin(), metadata->zone_of_vertex.end())) {
    notes.push_back(
        "the vertices are written zone by zone; positions in the file differ from the maps; --group-by zone "
        "keeps zones together");
  }
  Tree tree = *metadata->tree;
  Pruner(mesh, *metadata, numbering, notes).prune(tree.root);
  write_tree(tree, path, [&](Node& node) { fill(node, mesh, *metadata, numbering); });
}

}  // namespace meshorder::cgns

namespace meshorder {

Format cgns_format() {
  return {.name = "CGNS",
          .extensions = {".cgns"},
          .groups_cells_by_type = false,
          .read = cgns::read,
          .write = cgns::write,
          .holds = cgns::holds,
          .places = cgns::places,
          .first_number = 1,
          .library = "CGNS",
          .load_library = cgns::load_library};
}

}  // namespace meshorder
