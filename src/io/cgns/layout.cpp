// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/cell_division.hpp"
#include "io/cgns/cgns.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/unsupported.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <utility>

// Makes the nodes of a file: all nodes for a mesh of another format, else nodes for new arrays and sets.

namespace meshorder::cgns {
namespace {

constexpr std::size_t kLongestName = 32;

int bind(CgnsMetadata& metadata, Field field) {
  metadata.fields.push_back(std::move(field));
  return static_cast<int>(metadata.fields.size()) - 1;
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

/// `starts`: the first cells of runs of consecutive cells. Returns, by the first cell of a run, the name of
/// the smallest set that contains the run; leaves out runs that no set contains.
std::map<Index, std::string> names_of_runs(const Mesh& mesh, const std::vector<Index>& starts) {
  std::map<Index, std::string> names;
  std::map<Index, std::size_t> sizes;
  for (const EntitySet& set : mesh.sets) {
    if (set.association == Association::vertices) continue;
    std::map<Index, Index> counts;  // members of each run
    for (const Index c : set.members) {
      ++counts[*(std::upper_bound(starts.begin(), starts.end(), c) - 1)];
    }
    for (const auto& [start, count] : counts) {
      const auto next = std::upper_bound(starts.begin(), starts.end(), start);
      const Index end = next == starts.end() ? mesh.cell_count() : *next;
      const bool is_smaller = !sizes.contains(start) || set.members.size() < sizes[start];
      if (count == end - start && is_smaller) {
        names[start] = set.name;
        sizes[start] = set.members.size();
      }
    }
  }
  return names;
}

bool needs_three_coordinates(const Mesh& mesh, int cell_dimension) {
  return mesh.dimension == 3 || cell_dimension == 3 ||
         std::any_of(mesh.points.begin(), mesh.points.end(), [](const Point& p) { return p[2] != 0; });
}

class MetadataMaker {
 public:
  explicit MetadataMaker(const Mesh& mesh) : mesh_(mesh) {}

  std::shared_ptr<CgnsMetadata> make() {
    CgnsMetadata& metadata = *metadata_;
    metadata.cell_dimension = std::max(1, mesh_.cells.highest_dimension());
    metadata.zones.push_back({"Zone", "I4", 0});
    const int coordinates = needs_three_coordinates(mesh_, metadata.cell_dimension) ? 3 : 2;
    Node zone{.name = "Zone", .label = "Zone_t"};
    zone.field = bind(metadata, {.role = Field::Role::zone_size});
    zone.children.push_back(text_node("ZoneType", "ZoneType_t", "Unstructured"));
    zone.children.push_back(grid(coordinates));
    add_sections(zone);
    Node base = integer_node("Base", "CGNSBase_t", {metadata.cell_dimension, coordinates});
    base.children.push_back(std::move(zone));
    Tree tree;
    tree.root.children.push_back(version());
    tree.root.children.push_back(std::move(base));
    metadata.tree = std::make_shared<const Tree>(std::move(tree));
    return metadata_;
  }

 private:
  static Node version() {
    constexpr float kVersion = 3.3F;  // later versions have the same form of the nodes written here
    Node node{.name = "CGNSLibraryVersion", .label = "CGNSLibraryVersion_t", .type = "R4", .dimensions = {1}};
    node.bytes.resize(sizeof(kVersion));
    std::memcpy(node.bytes.data(), &kVersion, sizeof(kVersion));
    return node;
  }

  Node grid(int coordinates) {
    Node node{.name = "GridCoordinates", .label = "GridCoordinates_t"};
    for (int k = 0; k < coordinates; ++k) {
      Node axis{.name = std::string("Coordinate") + "XYZ"[k], .label = "DataArray_t"};
      axis.field = bind(*metadata_, {.role = Field::Role::coordinate, .axis = k, .type = "R8"});
      node.children.push_back(std::move(axis));
    }
    return node;
  }

  /// Makes a section of each run of cells that have the same type and the same label or sets.
  void add_sections(Node& zone) {
    const CellDivision division = divide_cells(mesh_, {.sets = true});
    const Labels labels = labels_of(mesh_, Association::cells);
    metadata_->has_labels =
        labels.any() && (division.by_labels || std::all_of(labels.values.begin(), labels.values.end(),
                                                           [](std::int64_t label) { return label == 0; }));
    std::vector<Index> starts;
    for (Index c = 0; c < mesh_.cell_count(); ++c) {
      if (c == 0 || division.key_of_cell[c] != division.key_of_cell[c - 1]) starts.push_back(c);
    }
    const std::map<Index, std::string> names = names_of_runs(mesh_, starts);
    NodeNames node_names(zone);
    metadata_->section_of_cell.reserve(mesh_.cells.shapes.size());
    Notes ignored;
    for (std::size_t s = 0; s < starts.size(); ++s) {
      const Index first = starts[s];
      const Index end = s + 1 < starts.size() ? starts[s + 1] : mesh_.cell_count();
      const CellPart& key = division.keys[division.key_of_cell[first]];
      const ElementType* const type_if_any = element_type_of(key.shape, key.nodes);
      if (type_if_any == nullptr) {
        throw InvalidArgument(fmt::format(
            "CGNS: a {} is written only with the cells and faces of the file that it was read from",
            type_name(key.shape, key.nodes)));
      }
      const ElementType& type = *type_if_any;
      const auto named = names.find(first);
      const bool is_boundary = dimension(key.shape) < metadata_->cell_dimension;
      const std::string name = is_boundary && named != names.end() ? named->second
                               : division.by_labels                ? name_of_label(type, key.label)
                                                                   : std::string(type.name);
      add_section(zone, node_names.take(name, ignored), type, first, end - first);
      if (metadata_->has_labels) zone.children.back().children.push_back(label_node(key.label));
    }
  }

  void add_section(Node& zone, const std::string& name, const ElementType& type, Index first, Index count) {
    const auto s = static_cast<int>(metadata_->sections.size());
    metadata_->sections.push_back(
        {.name = name, .type = type.number, .first = std::int64_t{first} + 1, .count = count});
    metadata_->section_of_cell.resize(static_cast<std::size_t>(first) + static_cast<std::size_t>(count), s);
    if (dimension(type.shape) == metadata_->cell_dimension) metadata_->zones[0].cell_count += count;
    Node node = integer_node(name, "Elements_t", {type.number, 0});
    Node range{.name = "ElementRange", .label = "IndexRange_t"};
    range.field = bind(*metadata_, {.role = Field::Role::range, .place = s});
    Node connectivity{.name = "ElementConnectivity", .label = "DataArray_t"};
    connectivity.field = bind(*metadata_, {.role = Field::Role::connectivity, .place = s});
    node.children.push_back(std::move(range));
    node.children.push_back(std::move(connectivity));
    zone.children.push_back(std::move(node));
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

std::string type_of_values(const Values& values) {
  return std::visit(
      [](const auto& numbers) -> std::string {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        if constexpr (std::is_same_v<Number, float>) return "R4";
        if constexpr (std::is_floating_point_v<Number>) return "R8";
        if constexpr (std::is_integral_v<Number>) {
          return sizeof(Number) < 4 || std::is_same_v<Number, std::int32_t> ? "I4" : "I8";
        }
        return {};
      },
      values);
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
  Addition(const Mesh& mesh, CgnsMetadata& metadata, Notes& notes)
      : mesh_(mesh), metadata_(metadata), notes_(notes), tree_(*metadata.tree) {
    for (Node& base : tree_.root.children) {
      if (base.label != "CGNSBase_t") continue;
      for (const Zone& zone : metadata_.zones) zones_.push_back(base.child(zone.name));
    }
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
      if (type_of_values(array.values).empty()) {
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
    for (Node& base : tree_.root.children) {
      if (base.label != "CGNSBase_t") continue;
      std::set<std::string> names;
      for (const Node& child : base.children) names.insert(child.name);
      for (Node& family : families_) {
        if (names.insert(family.name).second) base.children.push_back(std::move(family));
      }
    }
    metadata_.tree = std::make_shared<const Tree>(std::move(tree_));
  }

 private:
  [[nodiscard]] int zone_of(Association association, Index position) const {
    if (association == Association::cells)
      return metadata_.sections[metadata_.section_of_cell[position]].zone;
    return metadata_.zone_of(position);
  }

  /// Returns the names of the children of `parent`: a zone, or a node in it or in one of its sections.
  NodeNames& names_below(const Node& parent, int zone, int section = -1) {
    const std::string path = &parent == zones_[zone] ? fmt::format("{}", zone)
                                                     : fmt::format("{}/{}/{}", zone, section, parent.name);
    return names_.try_emplace(path, parent).first->second;
  }

  [[nodiscard]] int dimension_of(Index cell) const { return dimension(mesh_.cells.shapes[cell]); }

  /// Divides the members by zone and by the dimension of the cells (0 for vertices).
  [[nodiscard]] std::map<std::pair<int, int>, std::vector<Index>> parts_of(
      Association association, const std::vector<Index>& members) const {
    std::map<std::pair<int, int>, std::vector<Index>> parts;
    for (const Index member : members) {
      const int dimension = association == Association::cells ? dimension_of(member) : 0;
      parts[{zone_of(association, member), dimension}].push_back(member);
    }
    return parts;
  }

  /// Returns the number of vertices of a zone, or of its cells of the base's dimension.
  [[nodiscard]] Index full_count(Association association, int zone) {
    if (full_counts_.empty()) {
      for (const Association of : {Association::vertices, Association::cells}) {
        const Index count = of == Association::vertices ? mesh_.vertex_count() : mesh_.cell_count();
        for (Index i = 0; i < count; ++i) {
          if (of == Association::cells && dimension_of(i) != metadata_.cell_dimension) continue;
          ++full_counts_[{of, zone_of(of, i)}];
        }
      }
    }
    return full_counts_[{association, zone}];
  }

  // ---- arrays

  void add_array(const DataArray& array) {
    if (array.components > 1) {
      notes_.push_back(fmt::format(
          "the array '{0}' of {1} components is written as the data '{0}{2}' to '{0}{3}'", array.name,
          array.components, suffix_of(array, 0), suffix_of(array, array.components - 1)));
    }
    const bool on_vertices = array.association == Association::vertices;
    const auto parts =
        parts_of(array.association,
                 array.is_dense() ? index_range(0, on_vertices ? mesh_.vertex_count() : mesh_.cell_count())
                                  : array.indices);
    for (const auto& [place, members] : parts) {
      const auto [zone, dimension] = place;
      if (!on_vertices && dimension < metadata_.cell_dimension) {
        add_to_sections(array, members);
        continue;
      }
      const bool is_full = index_size(members) == full_count(array.association, zone);
      Node& solution =
          is_full ? full_solution(zone, array.association) : part_solution(zone, array.association, members);
      add_components(array, solution, {.place = zone, .list = is_full ? -1 : list_of(solution)});
    }
  }

  /// Adds a node for each component of an array. `rows` gives the vertices or cells that have the values.
  void add_components(const DataArray& array, Node& parent, const Field& rows) {
    NodeNames& names = names_below(parent, rows.place, rows.section);
    for (Index k = 0; k < array.components; ++k) {
      Node node{.name = names.take(array.name + suffix_of(array, k), notes_), .label = "DataArray_t"};
      Field field = rows;
      field.type = type_of_values(array.values);
      field.array = array.name;
      field.component = k;
      field.association = array.association;
      node.field = bind(metadata_, std::move(field));
      parent.children.push_back(std::move(node));
    }
  }

  /// Adds values of cells of lower dimensions to sections in which every cell has a value.
  void add_to_sections(const DataArray& array, const std::vector<Index>& members) {
    std::map<int, Index> counts;
    for (const Index member : members) ++counts[metadata_.section_of_cell[member]];
    for (const auto& [s, count] : counts) {
      const Section& section = metadata_.sections[s];
      if (count != section_count(s)) {
        notes_.push_back(
            fmt::format("{} values of the array '{}' are not written: CGNS has no place for values on a part "
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

  /// Returns the present number of cells of a section.
  [[nodiscard]] Index section_count(int s) {
    if (section_counts_.empty()) {
      section_counts_.resize(metadata_.sections.size());
      for (const Index of_cell : metadata_.section_of_cell) ++section_counts_[of_cell];
    }
    return section_counts_[s];
  }

  [[nodiscard]] int list_of(const Node& solution) const {
    const Node* const list = solution.child("PointList");
    return metadata_.fields[static_cast<std::size_t>(list->field)].place;
  }

  Node& new_node(int zone, const std::string& name, const std::string& label) {
    NodeNames& names = names_below(*zones_[zone], zone);
    Notes ignored;
    zones_[zone]->children.push_back({.name = names.take(name, ignored), .label = label});
    return zones_[zone]->children.back();
  }

  /// Returns the solution on all vertices or cells of a zone; adds it at the first call.
  Node& full_solution(int zone, Association association) {
    const bool on_vertices = association == Association::vertices;
    std::string& name = full_solutions_[{zone, association}];
    if (name.empty()) {
      Node& node = new_node(zone, on_vertices ? "VertexSolution" : "CellSolution", "FlowSolution_t");
      node.children.push_back(
          text_node("GridLocation", "GridLocation_t", on_vertices ? "Vertex" : "CellCenter"));
      name = node.name;
    }
    return *zones_[zone]->child(name);
  }

  Node list_node(int zone, Association association, std::vector<Index> members, std::string set) {
    Node node{.name = "PointList", .label = "IndexArray_t"};
    node.field = bind(metadata_, {.role = Field::Role::list,
                                  .place = static_cast<int>(metadata_.lists.size()),
                                  .association = association});
    metadata_.lists.push_back(
        {.zone = zone, .association = association, .members = std::move(members), .set = std::move(set)});
    return node;
  }

  /// Returns a solution on exactly these vertices or cells of a zone; adds it if there is none.
  Node& part_solution(int zone, Association association, const std::vector<Index>& members) {
    const std::string_view location = association == Association::vertices ? "Vertex" : "CellCenter";
    for (const std::string& name : part_solutions_[zone]) {
      Node& known = *zones_[zone]->child(name);
      const PointList& list = metadata_.lists[list_of(known)];
      if (list.association == association && list.members == members) return known;
    }
    Node& node = new_node(zone, fmt::format("{}Part", location), "FlowSolution_t");
    node.children.push_back(text_node("GridLocation", "GridLocation_t", location));
    node.children.push_back(list_node(zone, association, members, ""));
    part_solutions_[zone].push_back(node.name);
    return node;
  }

  // ---- sets

  void add_set(const EntitySet& set) {
    if (set.members.empty()) return note_set_unsupported(set, "CGNS", notes_);
    std::map<int, std::vector<Index>> members_of_zone;
    for (const Index member : set.members)
      members_of_zone[zone_of(set.association, member)].push_back(member);
    for (auto& [zone, members] : members_of_zone) {
      int highest = 0;
      if (set.association == Association::cells) {
        for (const Index member : members) highest = std::max(highest, dimension_of(member));
      }
      const bool is_region = set.association == Association::cells && highest == metadata_.cell_dimension;
      Node& parent = is_region ? *zones_[zone] : conditions(zone);
      NodeNames& names = names_below(parent, zone);
      Node node{.name = names.take(set.name, notes_), .label = "ZoneSubRegion_t"};
      if (is_region) {
        node.type = "I4";
        node = integer_node(node.name, node.label, {metadata_.cell_dimension});
      } else {
        node = text_node(node.name, "BC_t", "FamilySpecified");
      }
      node.children.push_back(text_node("GridLocation", "GridLocation_t",
                                        set.association == Association::vertices
                                            ? "Vertex"
                                            : location_name(highest, metadata_.cell_dimension)));
      node.children.push_back(list_node(zone, set.association, std::move(members), set.name));
      node.children.push_back(text_node("FamilyName", "FamilyName_t", family_for(node.name)));
      parent.children.push_back(std::move(node));
    }
  }

  /// Returns the name of the family for a boundary part of that name, and adds the family unless it exists.
  /// Programs identify the parts of a boundary by families. The name gets a suffix if a zone has the same
  /// name.
  std::string family_for(const std::string& name) {
    const bool is_of_zone =
        std::any_of(zones_.begin(), zones_.end(), [&](const Node* zone) { return zone->name == name; });
    constexpr std::string_view kEnd = "_family";
    std::string family(is_of_zone ? utf8_prefix(name, kLongestName - kEnd.size()) : name);
    if (is_of_zone) family += kEnd;
    if (family_names_.insert(family).second) families_.push_back({.name = family, .label = "Family_t"});
    return family;
  }

  Node& conditions(int zone) {
    if (Node* const known = zones_[zone]->child_of_label("ZoneBC_t")) return *known;
    return new_node(zone, "ZoneBC", "ZoneBC_t");
  }

  const Mesh& mesh_;
  CgnsMetadata& metadata_;
  Notes& notes_;
  Tree tree_;
  std::vector<Node*> zones_;
  std::vector<Node> families_;
  std::set<std::string> family_names_;
  std::map<std::string, NodeNames> names_;  // names of the children of a node, by the node's path
  std::map<std::pair<Association, int>, Index> full_counts_;
  std::vector<Index> section_counts_;
  std::map<std::pair<int, Association>, std::string> full_solutions_;
  std::map<int, std::vector<std::string>> part_solutions_;
};

}  // namespace

std::string name_of_label(const ElementType& type, std::int64_t label) {
  return fmt::format("{}_{}", type.name, label);
}

std::shared_ptr<CgnsMetadata> layout_of(const Mesh& mesh) { return MetadataMaker(mesh).make(); }

void add_missing(const Mesh& mesh, CgnsMetadata& metadata, Notes& notes) {
  Addition(mesh, metadata, notes).add();
}

}  // namespace meshorder::cgns
