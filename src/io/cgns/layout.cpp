// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/cell_division.hpp"
#include "io/cgns/numbering.hpp"
#include "io/exact_values.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <set>
#include <utility>

// Makes the nodes of a file: all nodes for a mesh of another format, else nodes for new arrays and sets.

namespace meshorder::cgns {
namespace {

constexpr std::size_t kLongestName = 32;

/// Makes a node and the field of its values.
Node field_node(CgnsMetadata& metadata, std::string name, std::string label, Field field) {
  metadata.fields.push_back(std::move(field));
  return {.name = std::move(name), .label = std::move(label), .field = index_size(metadata.fields) - 1};
}

/// Chooses valid names for the children of one node: up to 32 characters, no slash, all different.
class NodeNames {
 public:
  explicit NodeNames(const Node& parent) {
    for (const Node& child : parent.children) names_.insert(child.name);
  }

  std::string take(const std::string& wanted, Notes& notes) {
    std::string name = plain_name(wanted, "/");
    const std::size_t first = name.find_first_not_of(' ');
    name = first == std::string::npos ? "_" : name.substr(first, name.find_last_not_of(' ') - first + 1);
    if (name == "." || name == "..") name = "_";
    name = std::string(utf8_prefix(name, kLongestName));
    const auto numbered = [&](int k) {
      const std::string end = fmt::format(" {}", k);
      return std::string(utf8_prefix(name, kLongestName - end.size())) + end;
    };
    name = numbers_.free_name(name, numbered,
                              [&](const std::string& free) { return names_.insert(free).second; });
    if (name != wanted) notes.push_back(fmt::format("the name '{}' becomes '{}'", wanted, name));
    return name;
  }

 private:
  std::set<std::string> names_;
  NameNumbers numbers_;
};

// ---- a file for a mesh of another format

/// Returns, for each section, the smallest set of cells that contains the section; null if there is none.
std::vector<const EntitySet*> sets_around(const Mesh& mesh, const CgnsMetadata& metadata) {
  std::vector<const EntitySet*> smallest(metadata.sections.size());
  for (const EntitySet& set : mesh.sets) {
    if (set.association == Association::vertices) continue;
    std::map<Index, Index> counts;  // number of members in each section
    for (const Index c : set.members) ++counts[metadata.section_of_cell[c]];
    for (const auto& [s, count] : counts) {
      const bool is_smaller = smallest[s] == nullptr || set.members.size() < smallest[s]->members.size();
      if (count == metadata.sections[s].count && is_smaller) smallest[s] = &set;
    }
  }
  return smallest;
}

class MetadataMaker {
 public:
  explicit MetadataMaker(const Mesh& mesh) : mesh_(mesh) {}

  std::shared_ptr<CgnsMetadata> make() {
    CgnsMetadata& metadata = *metadata_;
    metadata.cell_dimension = std::max(1, mesh_.cells.highest_dimension());
    metadata.zones.push_back({"Zone", "I4", 0});
    const bool is_solid = mesh_.dimension == 3 || metadata.cell_dimension == 3;
    const int coordinates = is_solid ? 3 : coordinates_of(mesh_.points, 2);
    Node zone = field_node(metadata, "Zone", "Zone_t", {.role = Field::Role::zone_size});
    zone.children = {text_node("ZoneType", "ZoneType_t", "Unstructured"), grid(coordinates)};
    add_sections(zone);
    Node base = integer_node("Base", "CGNSBase_t", {metadata.cell_dimension, coordinates});
    base.children = {std::move(zone)};
    metadata.tree = std::make_shared<const Tree>(Tree{.root = {.children = {version(), std::move(base)}}});
    return metadata_;
  }

 private:
  static Node version() {
    constexpr float kVersion = 3.3F;  // later versions store these nodes in the same way
    Node node{.name = "CGNSLibraryVersion", .label = "CGNSLibraryVersion_t", .type = "R4", .dimensions = {1}};
    node.bytes.resize(sizeof(kVersion));
    std::memcpy(node.bytes.data(), &kVersion, sizeof(kVersion));
    return node;
  }

  Node grid(int coordinates) {
    Node node{.name = "GridCoordinates", .label = "GridCoordinates_t"};
    for (int k = 0; k < coordinates; ++k) {
      node.children.push_back(field_node(*metadata_, std::string("Coordinate") + "XYZ"[k], "DataArray_t",
                                         {.role = Field::Role::coordinate, .axis = k, .type = "R8"}));
    }
    return node;
  }

  /// Makes a section of each run of consecutive cells with the same type and the same label or sets.
  void add_sections(Node& zone) {
    std::vector<Section>& sections = metadata_->sections;
    const CellDivision division = divide_cells(mesh_, {.sets = true});
    const Labels labels = labels_of(mesh_, Association::cells);
    metadata_->has_labels =
        labels.any() && (division.by_labels || std::all_of(labels.values.begin(), labels.values.end(),
                                                           [](std::int64_t label) { return label == 0; }));
    std::vector<const CellPart*> keys;  // key of each section
    metadata_->section_of_cell.reserve(mesh_.cells.shapes.size());
    for (Index c = 0; c < mesh_.cell_count(); ++c) {
      const CellPart& key = division.keys[division.key_of_cell[c]];
      if (c == 0 || &key != keys.back()) {
        keys.push_back(&key);
        sections.push_back({.type = type_of(key).number, .first = std::int64_t{c} + 1});
      }
      ++sections.back().count;
      metadata_->section_of_cell.push_back(index_size(sections) - 1);
    }
    const std::vector<const EntitySet*> sets = sets_around(mesh_, *metadata_);
    NodeNames names(zone);
    Notes ignored;
    for (std::size_t s = 0; s < sections.size(); ++s) {
      const CellPart& key = *keys[s];
      const bool is_boundary = dimension(key.shape) < metadata_->cell_dimension;
      if (!is_boundary) metadata_->zones[0].cell_count += sections[s].count;
      const std::string name = is_boundary && sets[s] != nullptr ? sets[s]->name
                               : division.by_labels              ? name_of_label(type_of(key), key.label)
                                                                 : std::string(type_of(key).name);
      sections[s].name = names.take(name, ignored);
      zone.children.push_back(section_node(static_cast<int>(s)));
      if (metadata_->has_labels) zone.children.back().children.push_back(label_node(key.label));
    }
  }

  static const ElementType& type_of(const CellPart& key) {
    if (const ElementType* const type = element_type_of(key.shape, key.nodes)) return *type;
    throw InvalidArgument(
        fmt::format("CGNS: a {} is written only with the cells and faces of the file that it was read from",
                    type_name(key.shape, key.nodes)));
  }

  Node section_node(int s) {
    const Section& section = metadata_->sections[s];
    Node node = integer_node(section.name, "Elements_t", {section.type, 0});
    node.children = {
        field_node(*metadata_, "ElementRange", "IndexRange_t", {.role = Field::Role::range, .place = s}),
        field_node(*metadata_, "ElementConnectivity", "DataArray_t",
                   {.role = Field::Role::connectivity, .place = s})};
    return node;
  }

  static Node label_node(std::int64_t label) {
    Node node{.name = std::string(kSectionLabel), .label = "UserDefinedData_t"};
    node.children.push_back(integer_node("Value", "DataArray_t", {static_cast<std::int32_t>(label)}));
    return node;
  }

  const Mesh& mesh_;
  std::shared_ptr<CgnsMetadata> metadata_ = std::make_shared<CgnsMetadata>();
};

// ---- arrays and sets that the file did not have

/// Returns the type in which new values are written.
std::string type_of_values(const Values& values) {
  // type for each alternative of Values
  constexpr std::array kTypes{"R8", "R4", "I4", "I4", "I4", "I4", "I4", "I8", "I8", "I8"};
  return kTypes.at(values.index());
}

/// Returns the suffix that turns the name of an array into the name of one of its components.
std::string suffix_of(const DataArray& array, Index component) {
  constexpr std::array<std::string_view, 6> kSymmetric{"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
  const auto k = static_cast<std::size_t>(component);
  if (array.components == 1) return {};
  if (array.components <= 3) return {"XYZ"[k]};
  if (index_size(array.component_names) == array.components) return "_" + array.component_names[k];
  if (array.components == 6) return std::string(kSymmetric.at(k));
  if (array.components == 9) return {"XYZ"[k / 3], "XYZ"[k % 3]};
  return fmt::format("_{}", component + 1);
}

/// Returns the GridLocation of elements of this dimension.
std::string_view location_name(int dimension, int cell_dimension) {
  if (dimension == cell_dimension) return "CellCenter";
  return dimension == 2 ? "FaceCenter" : "EdgeCenter";
}

class Addition {
 public:
  Addition(const Mesh& mesh, CgnsMetadata& metadata, const Numbering& numbering, Notes& notes)
      : mesh_(mesh),
        metadata_(metadata),
        numbering_(numbering),
        notes_(notes),
        tree_(*metadata.tree),
        base_(*tree_.root.child_of_label("CGNSBase_t")) {
    for (const Zone& zone : metadata_.zones) zones_.push_back(base_.child(zone.name));
    for (const Node& child : base_.children) names_in_base_.insert(child.name);
  }

  void add() {
    std::set<std::pair<Association, std::string>> known;
    for (const Field& field : metadata_.fields) {
      if (!field.array.empty() && !field.has_left) known.insert({field.association, field.array});
    }
    if (metadata_.zones.size() > 1) known.insert({Association::cells, std::string(kZone)});
    if (metadata_.has_labels) known.insert({Association::cells, std::string(kLabel)});
    for (const DataArray& array : mesh_.data) {
      if (known.contains({array.association, array.name})) continue;
      if (are_texts(array.values)) {
        note_array_unsupported(array, "CGNS", notes_);
      } else {
        add_array(array);
      }
    }
    std::set<std::pair<Association, std::string>> known_sets;
    for (const PointList& list : metadata_.lists) {
      if (!list.set.empty()) known_sets.insert({list.association, list.set});
    }
    for (const EntitySet& set : mesh_.sets) {
      if (!known_sets.contains({set.association, set.name})) add_set(set);
    }
    std::move(families_.begin(), families_.end(), std::back_inserter(base_.children));
    metadata_.tree = std::make_shared<const Tree>(std::move(tree_));
  }

 private:
  /// Returns the names of the children of `parent`, which is a zone or a node in a zone or in a section.
  NodeNames& names_below(const Node& parent, int zone, int section = -1) {
    const std::string path = &parent == zones_[zone] ? fmt::format("{}", zone)
                                                     : fmt::format("{}/{}/{}", zone, section, parent.name);
    return names_.try_emplace(path, parent).first->second;
  }

  /// Returns the dimension of a cell; 0 for a vertex.
  [[nodiscard]] int dimension_of(Association association, Index position) const {
    return association == Association::cells ? dimension(mesh_.cells.shapes[position]) : 0;
  }

  // ---- arrays

  void add_array(const DataArray& array) {
    if (array.components > 1) {
      notes_.push_back(fmt::format(
          "the array '{0}' of {1} components is written as the data '{0}{2}' to '{0}{3}'", array.name,
          array.components, suffix_of(array, 0), suffix_of(array, array.components - 1)));
    }
    std::map<std::pair<int, int>, std::vector<Index>> parts;  // by zone and dimension
    for (Index row = 0; row < row_count(array); ++row) {
      const Index item = array.is_dense() ? row : array.indices[row];
      parts[{metadata_.zone_of(array.association, item), dimension_of(array.association, item)}].push_back(
          item);
    }
    for (const auto& [place, members] : parts) {
      const auto [zone, dimension] = place;
      if (array.association == Association::cells && dimension < metadata_.cell_dimension) {
        add_to_sections(array, members);
        continue;
      }
      Node& solution = solution_on(zone, array.association, members);
      add_components(array, solution, {.place = zone, .list = list_of(solution)});
    }
  }

  /// Adds a node for each component of an array. `rows` gives the vertices or cells that have the values.
  void add_components(const DataArray& array, Node& parent, const Field& rows) {
    NodeNames& names = names_below(parent, rows.place, rows.section);
    for (Index k = 0; k < array.components; ++k) {
      Field field = rows;
      field.type = type_of_values(array.values);
      field.array = array.name;
      field.component = k;
      field.association = array.association;
      parent.children.push_back(field_node(metadata_, names.take(array.name + suffix_of(array, k), notes_),
                                           "DataArray_t", std::move(field)));
    }
  }

  /// Adds values of cells of lower dimensions to sections in which every cell has a value.
  void add_to_sections(const DataArray& array, const std::vector<Index>& members) {
    std::map<int, Index> counts;
    for (const Index member : members) ++counts[metadata_.section_of_cell[member]];
    for (const auto& [s, count] : counts) {
      const Section& section = metadata_.sections[s];
      if (count != index_size(numbering_.cells_of(s))) {
        notes_.push_back(
            fmt::format("{} values of the array '{}' are not written: CGNS cannot hold values on a part "
                        "of a boundary",
                        count, array.name));
        continue;
      }
      Node& parent = *zones_[section.zone]->child(section.name);
      if (parent.child(kSectionValues) == nullptr) {
        parent.children.push_back({.name = std::string(kSectionValues), .label = "UserDefinedData_t"});
      }
      add_components(array, *parent.child(kSectionValues), {.place = section.zone, .section = s});
    }
  }

  /// Returns the list of a solution, −1 if it is on a whole zone.
  [[nodiscard]] int list_of(const Node& solution) const {
    const Node* const list = solution.child("PointList");
    return list == nullptr ? -1 : metadata_.fields[list->field].place;
  }

  Node& new_node(int zone, const std::string& name, const std::string& label) {
    NodeNames& names = names_below(*zones_[zone], zone);
    Notes ignored;
    zones_[zone]->children.push_back({.name = names.take(name, ignored), .label = label});
    return zones_[zone]->children.back();
  }

  Node list_node(int zone, Association association, std::vector<Index> members, std::string set) {
    metadata_.lists.push_back(
        {.zone = zone, .association = association, .members = std::move(members), .set = std::move(set)});
    return field_node(
        metadata_, "PointList", "IndexArray_t",
        {.role = Field::Role::list, .place = index_size(metadata_.lists) - 1, .association = association});
  }

  /// Returns a solution on exactly these vertices or cells of a zone; adds it if there is none.
  Node& solution_on(int zone, Association association, const std::vector<Index>& members) {
    const bool on_vertices = association == Association::vertices;
    const std::int64_t full = on_vertices ? numbering_.vertex_count(zone) : numbering_.centred_count(zone);
    const bool is_full = std::ssize(members) == full;
    std::vector<std::string>& known = solutions_[{zone, association}];
    for (const std::string& name : known) {
      Node& solution = *zones_[zone]->child(name);
      const int list = list_of(solution);
      if (list < 0 ? is_full : metadata_.lists[list].members == members) return solution;
    }
    const std::string_view location = on_vertices ? "Vertex" : "CellCenter";
    const std::string name = !is_full      ? fmt::format("{}Part", location)
                             : on_vertices ? "VertexSolution"
                                           : "CellSolution";
    Node& node = new_node(zone, name, "FlowSolution_t");
    node.children.push_back(text_node("GridLocation", "GridLocation_t", location));
    if (!is_full) node.children.push_back(list_node(zone, association, members, ""));
    known.push_back(node.name);
    return node;
  }

  // ---- sets

  void add_set(const EntitySet& set) {
    if (set.members.empty()) return note_set_unsupported(set, "CGNS", notes_);
    std::map<int, std::vector<Index>> members_of_zone;
    for (const Index member : set.members)
      members_of_zone[metadata_.zone_of(set.association, member)].push_back(member);
    for (auto& [zone, members] : members_of_zone) {
      int highest = 0;
      for (const Index member : members) highest = std::max(highest, dimension_of(set.association, member));
      const bool is_region = set.association == Association::cells && highest == metadata_.cell_dimension;
      Node& parent = is_region ? *zones_[zone] : conditions(zone);
      NodeNames& names = names_below(parent, zone);
      const std::string name = names.take(set.name, notes_);
      Node node = is_region ? integer_node(name, "ZoneSubRegion_t", {metadata_.cell_dimension})
                            : text_node(name, "BC_t", "FamilySpecified");
      const std::string_view location = set.association == Association::vertices
                                            ? "Vertex"
                                            : location_name(highest, metadata_.cell_dimension);
      node.children = {text_node("GridLocation", "GridLocation_t", location),
                       list_node(zone, set.association, std::move(members), set.name),
                       text_node("FamilyName", "FamilyName_t", family_for(name))};
      parent.children.push_back(std::move(node));
    }
  }

  /// Returns the name of the family for a condition or region `name`; adds the family unless it exists.
  /// Programs identify the parts of a boundary by families. The family's name gets a suffix if a zone has the
  /// same name.
  std::string family_for(const std::string& name) {
    const bool is_of_zone =
        std::any_of(zones_.begin(), zones_.end(), [&](const Node* zone) { return zone->name == name; });
    constexpr std::string_view kEnd = "_family";
    std::string family(is_of_zone ? utf8_prefix(name, kLongestName - kEnd.size()) : name);
    if (is_of_zone) family += kEnd;
    if (names_in_base_.insert(family).second) families_.push_back({.name = family, .label = "Family_t"});
    return family;
  }

  Node& conditions(int zone) {
    if (Node* const known = zones_[zone]->child_of_label("ZoneBC_t")) return *known;
    return new_node(zone, "ZoneBC", "ZoneBC_t");
  }

  const Mesh& mesh_;
  CgnsMetadata& metadata_;
  const Numbering& numbering_;
  Notes& notes_;
  Tree tree_;
  Node& base_;
  std::vector<Node*> zones_;
  std::vector<Node> families_;
  std::set<std::string> names_in_base_;
  std::map<std::string, NodeNames> names_;  // names of the children of a node, by the node's path
  std::map<std::pair<int, Association>, std::vector<std::string>> solutions_;  // names of added solutions
};

}  // namespace

std::string name_of_label(const ElementType& type, std::int64_t label) {
  return fmt::format("{}_{}", type.name, label);
}

std::shared_ptr<CgnsMetadata> layout_of(const Mesh& mesh) { return MetadataMaker(mesh).make(); }

void add_missing(const Mesh& mesh, CgnsMetadata& metadata, const Numbering& numbering, Notes& notes) {
  Addition(mesh, metadata, numbering, notes).add();
}

}  // namespace meshorder::cgns
