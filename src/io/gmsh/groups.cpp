// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/gmsh/gmsh.hpp"
#include "io/names.hpp"
#include "io/stream/read_limits.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

// Physical groups and their entities: read from a file, or made for a mesh of another format.

namespace meshorder::gmsh {
namespace {

/// The dimension and tag of a cell's entity, from the arrays of the mesh.
struct CellEntities {
  explicit CellEntities(const Mesh& mesh)
      : tags(integers_of(mesh, kCellEntity, Association::cells)),
        dimensions(integers_of(mesh, kCellDimension, Association::cells)),
        cells(mesh.cells) {}

  [[nodiscard]] Entity operator()(Index c) const {
    return {dimensions.empty() ? dimension(cells.shapes[c]) : dimensions[c], tags.empty() ? 0 : tags[c]};
  }

  std::vector<std::int32_t> tags;
  std::vector<std::int32_t> dimensions;
  const Cells& cells;
};

/// Calls `work(c, value)` for each cell whose entity `entity_of(c)` is in the table.
template <class Value, class EntityOf, class Work>
void for_cells_of(const std::map<Entity, Value>& table, const Mesh& mesh, const EntityOf& entity_of,
                  const Work& work) {
  Entity last{};
  const Value* value = nullptr;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const Entity entity = entity_of(c);
    if (c == 0 || entity != last) {  // successive cells mostly have the same entity
      const auto found = table.find(entity);
      value = found == table.end() ? nullptr : &found->second;
      last = entity;
    }
    if (value) work(c, *value);
  }
}

// ---- for a mesh of another format: cells with the same label and the same sets form an entity

struct Box {
  Point least{};
  Point greatest{};
  bool empty = true;

  void add(const Point& point) {
    for (std::size_t k = 0; k < 3; ++k) {
      least[k] = empty ? point[k] : std::min(least[k], point[k]);
      greatest[k] = empty ? point[k] : std::max(greatest[k], point[k]);
    }
    empty = false;
  }
};

struct Group {
  std::int32_t dimension;
  std::int32_t wanted;  ///< the preferred tag
  std::vector<std::int32_t> physicals;
  std::int32_t tag = 0;
  Box box;

  [[nodiscard]] bool has(std::int32_t physical) const {
    return std::find(physicals.begin(), physicals.end(), physical) != physicals.end();
  }
};

struct Groups {
  std::vector<Group> groups;
  std::vector<Index> of_cell;
};

/// Returns the labels if they are valid numbers of physical groups; else returns no labels and adds a note.
std::vector<std::int32_t> labels_for_groups(const Mesh& mesh, Notes& notes) {
  const DataArray* array = find_array(mesh, kLabel, Association::cells);
  std::vector<std::int32_t> labels = integers_of(mesh, kLabel, Association::cells);
  const bool usable =
      array && array->components == 1 && !labels.empty() &&
      std::all_of(labels.begin(), labels.end(), [](std::int32_t label) { return label >= 0; });
  if (usable) return labels;
  if (array) {
    notes.push_back(
        "the labels of cells are written as data: Gmsh's physical groups are positive numbers for all cells");
  }
  return {};
}

Groups groups_by_label(const Mesh& mesh, const std::vector<std::int32_t>& labels,
                       const std::vector<std::int32_t>& entities) {
  Groups result;
  result.of_cell.resize(mesh.cells.shapes.size());
  std::map<std::array<std::int32_t, 3>, Index> known;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const std::int32_t label = labels.empty() ? 0 : labels[c];
    const std::int32_t entity = entities.empty() ? 0 : entities[c];
    const std::int32_t dim = dimension(mesh.cells.shapes[c]);
    const auto [found, is_new] = known.try_emplace({dim, label, entity}, index_size(result.groups));
    if (is_new) {
      Group group{dim, entity > 0 ? entity : std::max(label, 1), {}, 0, {}};
      if (label > 0) group.physicals.push_back(label);
      result.groups.push_back(std::move(group));
    }
    result.of_cell[c] = found->second;
  }
  return result;
}

/// Splits groups: those cells of each group that are in the set become a new group with `physical`.
void split_by_set(Groups& groups, const EntitySet& set, std::int32_t physical) {
  std::map<Index, Index> inside;  // new group by old group
  std::set<Index> parts;          // the new groups
  for (const Index c : set.members) {
    const Index group = groups.of_cell[c];
    if (parts.contains(group)) continue;  // the set has this cell twice
    const auto [found, is_new] = inside.try_emplace(group, index_size(groups.groups));
    if (is_new) {
      Group part = groups.groups[group];
      if (!part.has(physical)) part.physicals.push_back(physical);
      groups.groups.push_back(std::move(part));
      parts.insert(found->second);
    }
    groups.of_cell[c] = found->second;
  }
}

/// Gives each group with cells a box and a tag. The first group that wants a tag gets this tag, all other
/// groups get new tags.
void assign_tags(const Mesh& mesh, Groups& groups) {
  std::array<std::int32_t, 4> last{};
  for (const Group& group : groups.groups) {
    last[group.dimension] = std::max(last[group.dimension], group.wanted);
  }
  std::set<Entity> taken;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    Group& group = groups.groups[groups.of_cell[c]];
    if (group.tag == 0) {
      group.tag = group.wanted;
      while (!taken.insert({group.dimension, group.tag}).second) {
        std::int32_t& next = last[group.dimension];
        next = next == std::numeric_limits<std::int32_t>::max() ? 1 : next + 1;
        group.tag = next;
      }
    }
    for (const Index v : mesh.cells[c]) group.box.add(mesh.points[v]);
  }
}

/// Returns each node's entity: from the array kNodeEntity if that array is valid, else, for all nodes, the
/// first entity of the highest dimension. Adds new entities to `entities`.
std::vector<std::int32_t> entities_of_nodes(const Mesh& mesh, std::map<Entity, Group>& entities,
                                            WriteContext& output) {
  std::vector<std::int32_t> kept = integers_of(mesh, kNodeEntity, Association::vertices, 2);
  const DataArray* array = find_array(mesh, kNodeEntity, Association::vertices);
  bool usable = !kept.empty();
  for (std::size_t i = 0; usable && i < kept.size(); i += 2) {
    usable = kept[i] >= 0 && kept[i] <= 3 && kept[i + 1] > 0;
  }
  if (usable) {
    output.placed.push_back(array);
    if (parameters_of(mesh))
      output.placed.push_back(find_array(mesh, kNodeParameters, Association::vertices));
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Entity entity{kept[2 * static_cast<std::size_t>(v)], kept[2 * static_cast<std::size_t>(v) + 1]};
      const auto [found, is_new] =
          entities.try_emplace(entity, Group{entity.first, 0, {}, entity.second, {}});
      found->second.box.add(mesh.points[v]);
    }
    return kept;
  }
  const Entity last = entities.empty() ? Entity{0, 1} : entities.rbegin()->first;
  const auto first_of_dimension = entities.lower_bound({last.first, 0});
  const Entity all = entities.empty() ? last : first_of_dimension->first;
  std::vector<std::int32_t> result;
  result.reserve(2 * mesh.points.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) result.insert(result.end(), {all.first, all.second});
  return result;
}

std::string entities_text(const std::map<Entity, Group>& entities) {
  std::array<int, 4> counts{};
  for (const auto& [entity, group] : entities) ++counts[entity.first];
  std::string text = fmt::format("{} {} {} {}\n", counts[0], counts[1], counts[2], counts[3]);
  for (const auto& [entity, group] : entities) {
    text += fmt::format("{} {}", entity.second, fmt::join(group.box.least, " "));
    if (entity.first > 0) text += fmt::format(" {}", fmt::join(group.box.greatest, " "));
    text += fmt::format(" {}", group.physicals.size());
    for (const std::int32_t physical : group.physicals) text += fmt::format(" {}", physical);
    text += entity.first > 0 ? " 0\n" : "\n";
  }
  return text;
}

std::string names_text(const std::vector<PhysicalName>& names) {
  std::string text = fmt::format("{}\n", names.size());
  for (const PhysicalName& name : names)
    text += fmt::format("{} {} \"{}\"\n", name.dimension, name.tag, name.name);
  return text;
}

/// Number of cells by dimension and label.
using LabelCounts = std::map<std::pair<std::int32_t, std::int32_t>, Index>;

/// The labels that are the numbers of sets. In a mesh that came from Gmsh, a cell's label is the number of
/// its first physical group, and each named group is a set. If a group is the first group of each of its
/// cells, its set has exactly the cells with the group's number as label. Other sets also have cells with
/// other labels.
class NumbersOfSets {
 public:
  NumbersOfSets(const Mesh& mesh, const std::vector<std::int32_t>& labels)
      : number_(mesh.sets.size(), 0), inside_(mesh.sets.size()) {
    if (labels.empty()) return;
    const auto key = [&](Index c) { return std::pair{dimension(mesh.cells.shapes[c]), labels[c]}; };
    for (Index c = 0; c < mesh.cell_count(); ++c) ++all_[key(c)];
    for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
      if (mesh.sets[s].association == Association::vertices) continue;
      for (const Index c : mesh.sets[s].members) ++inside_[s][key(c)];
    }
    for (const bool only : {true, false}) {
      for (std::size_t s = 0; s < mesh.sets.size(); ++s) claim(s, only);
    }
  }

  /// Returns the label that is the number of a set, 0 if there is none.
  [[nodiscard]] std::int32_t operator[](std::size_t set) const { return number_[set]; }

 private:
  /// Gives set s a label as its number if one fits. `only`: all cells of the set must have that label.
  void claim(std::size_t s, bool only) {
    if (number_[s] != 0) return;
    for (const auto& [key, count] : inside_[s]) {
      if (key.second == 0 || !may_have(s, key.second, only)) continue;
      number_[s] = key.second;
      for (const auto& [member, ignored] : inside_[s]) taken_.insert({member.first, key.second});
      return;
    }
  }

  [[nodiscard]] bool may_have(std::size_t s, std::int32_t label, bool only) const {
    return std::all_of(inside_[s].begin(), inside_[s].end(), [&](const auto& entry) {
      const auto& [key, count] = entry;
      if (key.second == label) return count == all_.at(key) && !taken_.contains(key);
      const std::pair same_dimension{key.first, label};
      return !only && taken_.contains(key) && !taken_.contains(same_dimension) &&
             inside_[s].contains(same_dimension) == all_.contains(same_dimension);
    });
  }

  std::vector<std::int32_t> number_;
  LabelCounts all_;
  std::vector<LabelCounts> inside_;  ///< for each set, counts by dimension and label
  std::set<std::pair<std::int32_t, std::int32_t>> taken_;
};

/// Turns sets of cells into physical groups, numbered by labels (see NumbersOfSets) or anew; returns names.
std::vector<PhysicalName> groups_by_sets(const Mesh& mesh, Groups& groups,
                                         const std::vector<std::int32_t>& labels, Notes& notes) {
  const NumbersOfSets numbers(mesh, labels);
  std::int64_t next = labels.empty() ? 1 : std::int64_t{*std::max_element(labels.begin(), labels.end())} + 1;
  std::vector<PhysicalName> names;
  DistinctNames distinct;
  for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
    const EntitySet& set = mesh.sets[s];
    if (set.association == Association::vertices || set.members.empty() ||
        next > std::numeric_limits<std::int32_t>::max()) {
      note_set_unsupported(set, "Gmsh", notes);
      continue;
    }
    const auto physical = numbers[s] != 0 ? numbers[s] : static_cast<std::int32_t>(next++);
    split_by_set(groups, set, physical);
    std::set<std::int32_t> dimensions;
    for (const Index c : set.members) dimensions.insert(dimension(mesh.cells.shapes[c]));
    const std::string name = distinct.take(name_in_quotes(set.name));
    note_renamed_set(set, name, notes);
    for (const std::int32_t dim : dimensions) names.push_back({dim, physical, name});
  }
  return names;
}

}  // namespace

std::vector<EntitySet> physical_sets(const Mesh& mesh, const GmshMetadata& metadata) {
  // groups of different dimensions with the same name become one set
  std::vector<EntitySet> sets;
  std::map<std::string, Index> set_of_name;
  std::map<Entity, std::vector<Index>> sets_of_group;
  for (const PhysicalName& name : metadata.names) {
    const auto [found, is_new] = set_of_name.try_emplace(name.name, index_size(sets));
    if (is_new) sets.push_back({name.name, Association::cells, {}});
    sets_of_group[{name.dimension, name.tag}].push_back(found->second);
  }
  if (sets.empty()) return sets;

  // in version 2 the cells have physical groups, in version 4 the entities have them
  std::map<Entity, std::vector<Index>> sets_of_entity;
  for (const auto& [entity, physicals] : metadata.physicals) {
    std::set<Index> of_entity;
    for (const std::int32_t physical : physicals) {
      const auto found = sets_of_group.find({entity.first, physical});
      if (found != sets_of_group.end()) of_entity.insert(found->second.begin(), found->second.end());
    }
    if (!of_entity.empty()) sets_of_entity[entity].assign(of_entity.begin(), of_entity.end());
  }
  const auto add = [&](Index c, const std::vector<Index>& of_cell) {
    if (of_cell.size() > 1) claim_memory(of_cell.size() * sizeof(Index), "items in several groups");
    for (const Index s : of_cell) sets[s].members.push_back(c);
  };
  if (metadata.is_version_2()) {
    const std::vector<std::int32_t> labels = integers_of(mesh, kLabel, Association::cells);
    const auto group_of = [&](Index c) -> Entity {
      return {dimension(mesh.cells.shapes[c]), labels.empty() ? 0 : labels[c]};
    };
    for_cells_of(sets_of_group, mesh, group_of, add);
  } else {
    for_cells_of(sets_of_entity, mesh, CellEntities(mesh), add);
  }
  std::erase_if(sets, [](const EntitySet& set) { return set.members.empty(); });
  return sets;
}

std::vector<std::int32_t> labels_of_entities(const Mesh& mesh, const GmshMetadata& metadata) {
  if (metadata.physicals.empty()) return {};
  std::vector<std::int32_t> labels(mesh.cells.shapes.size(), 0);
  bool any = false;
  for_cells_of(metadata.physicals, mesh, CellEntities(mesh),
               [&](Index c, const std::vector<std::int32_t>& physicals) {
                 labels[c] = physicals.front();
                 any = true;
               });
  if (!any) labels.clear();
  return labels;
}

void classify(GmshMetadata& layout, WriteContext& output, Notes& notes) {
  const Mesh& mesh = output.mesh;
  const std::vector<std::int32_t> labels = labels_for_groups(mesh, notes);
  if (!labels.empty()) output.placed.push_back(find_array(mesh, kLabel, Association::cells));
  const std::vector<std::int32_t> kept = integers_of(mesh, kCellEntity, Association::cells);
  if (!kept.empty()) output.placed.push_back(find_array(mesh, kCellEntity, Association::cells));

  // groups of cells become entities
  Groups groups = groups_by_label(mesh, labels, kept);
  layout.names = groups_by_sets(mesh, groups, labels, notes);
  assign_tags(mesh, groups);
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const Group& group = groups.groups[groups.of_cell[c]];
    output.cell_dimensions.push_back(group.dimension);
    output.cell_tags.push_back(group.tag);
  }
  if (!kept.empty() && output.cell_tags != kept) {
    notes.push_back(
        fmt::format("the array '{}' is written with new numbers where the cells of an entity of Gmsh "
                    "belong to different groups",
                    kCellEntity));
  }
  std::map<Entity, Group> entities;
  for (const Group& group : groups.groups) {
    if (group.tag > 0) entities.try_emplace({group.dimension, group.tag}, group);
  }
  output.node_entities = entities_of_nodes(mesh, entities, output);

  layout.sections.push_back({SectionKind::format, "MeshFormat", "", 0});
  if (!layout.names.empty()) {
    layout.sections.push_back({SectionKind::verbatim, "PhysicalNames", names_text(layout.names), 0});
  }
  layout.sections.push_back({SectionKind::verbatim, "Entities", entities_text(entities), 0});
  layout.sections.push_back({SectionKind::nodes, "Nodes", "", 0});
  layout.sections.push_back({SectionKind::elements, "Elements", "", 0});
}

}  // namespace meshorder::gmsh
