// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/cgns/reading.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/stream/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <utility>

// Reads nodes that refer to vertices or cells: solutions, conditions, connectivities of zones, parents.

namespace meshorder::cgns {
namespace {

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array<std::string_view, 5> kContainers{"FlowSolution_t", "DiscreteData_t", "GridCoordinates_t",
                                                      "ArbitraryGridMotion_t", "ZoneSubRegion_t"};
constexpr std::array<std::string_view, 2> kVertexLocations{"Vertex", "Null"};
/// Labels of those nodes of a zone that other formats can hold.
constexpr std::array<std::string_view, 8> kHeldByOthers{"ZoneType_t",     "GridCoordinates_t", "Elements_t",
                                                        "FlowSolution_t", "DiscreteData_t",    "ZoneBC_t",
                                                        "Ordinal_t",      "ZoneSubRegion_t"};

/// Returns the texts of a C1 node, one for each row of `dimensions.front()` characters, without padding.
std::vector<std::string> rows_of_text(const Node& node) {
  std::vector<std::string> rows;
  if (node.type != "C1" || node.dimensions.empty() || node.dimensions.front() < 1) return rows;
  const auto width = static_cast<std::size_t>(node.dimensions.front());
  for (std::size_t at = 0; at + width <= node.bytes.size(); at += width) {
    const std::string row = node.bytes.substr(at, width);
    const std::size_t end = row.find_last_not_of(std::string_view(" \0", 2));
    rows.push_back(end == std::string::npos ? std::string() : row.substr(0, end + 1));
  }
  return rows;
}

class AttachmentReader {
 public:
  explicit AttachmentReader(Reading& reading) : reading_(reading), metadata_(*reading.metadata) {}

  void read() {
    for (std::size_t z = 0; z < reading_.zones.size(); ++z) {
      zone_ = static_cast<int>(z);
      has_named_part_ = false;
      read_steps();
      for (Node& node : zone().node->children) read_node(node, zone().path + "/" + node.name);
      if (has_named_part_) mark_lists_of_zone();
    }
    name_sets();
    add_section_sets();
    count_lost();
  }

 private:
  ZonePlaces& zone() { return reading_.zones[zone_]; }

  // ---- positions of numbers

  /// Returns the cell of a zone with this element number, −1 if there is none.
  [[nodiscard]] Index cell_of(const ZonePlaces& of_zone, std::int64_t number) const {
    const auto begin = metadata_.sections.begin() + of_zone.first_section;
    const auto after =
        std::upper_bound(begin, begin + of_zone.section_count, number,
                         [](std::int64_t wanted, const Section& section) { return wanted < section.first; });
    if (after == begin) return -1;
    const Section& section = *(after - 1);
    const std::int64_t place = number - section.first;
    if (place >= section.count) return -1;
    if (section.type == kPolygons) {
      return metadata_.cell_of_polygon[section.first_item + static_cast<Index>(place)];
    }
    return reading_.cells_of_section[after - 1 - metadata_.sections.begin()].first +
           static_cast<Index>(place);
  }

  [[nodiscard]] Index position_of(const ZonePlaces& of_zone, Association association, std::int64_t number,
                                  const std::string& path) const {
    if (association == Association::vertices) {
      return reading_.vertex_of(number, of_zone, [&] { return path; });
    }
    const Index cell = cell_of(of_zone, number);
    if (cell < 0) {
      reading_.fail(path, fmt::format("element {} does not exist", number),
                    "the numbers are those of the sections of the zone");
    }
    return cell;
  }

  /// Reads a node that lists vertices or elements by number or as a range.
  [[nodiscard]] PointList list_in(const Node& node, int of_zone, Association association,
                                  const std::string& path) const {
    const ZonePlaces& owner = reading_.zones[of_zone];
    PointList list{.zone = of_zone, .association = association};
    list.is_range = node.label == "IndexRange_t";
    list.number_type = node.type;
    const std::vector<std::int64_t> numbers = whole_numbers(reading_, node, path);
    const auto add = [&](std::int64_t number) {
      list.members.push_back(position_of(owner, association, number, path));
    };
    if (!list.is_range) {
      list.members.reserve(numbers.size());
      for (const std::int64_t number : numbers) add(number);
      return list;
    }
    if (numbers.size() != 2 || numbers[0] > numbers[1]) {
      reading_.fail(path, "is not a range of two numbers", "a zone without structure has one index");
    }
    (void)position_of(owner, association, numbers[0], path);
    (void)position_of(owner, association, numbers[1], path);
    const std::int64_t after_first = numbers[1] - numbers[0];
    if (after_first >= item_count(reading_.mesh, association)) {
      reading_.fail(path, "has more numbers than there are elements");
    }
    claim_memory(2 * sizeof(Index) * (static_cast<std::uint64_t>(after_first) + 1), path);
    for (std::int64_t number = numbers[0]; number <= numbers[1]; ++number) add(number);
    return list;
  }

  /// Stores a list as the contents of a node. Returns the index of the list.
  int bind_list(Node& node, PointList list) {
    const auto place = static_cast<int>(metadata_.lists.size());
    reading_.bind(node, {.role = Field::Role::list, .place = place, .association = list.association});
    metadata_.lists.push_back(std::move(list));
    return place;
  }

  int read_list(Node& node, int of_zone, Association association, const std::string& path) {
    return bind_list(node, list_in(node, of_zone, association, path));
  }

  // ---- nodes by their labels

  void read_node(Node& node, const std::string& path) {
    if (node.label == "ZoneBC_t") {
      for (Node& child : node.children) {
        if (child.label == "BC_t") read_condition(child, path + "/" + child.name);
      }
    } else if (node.label == "ZoneGridConnectivity_t") {
      for (Node& child : node.children) read_connection(child, path + "/" + child.name);
    } else if (node.label == "Elements_t") {
      read_section(node, path);
    } else if (is_one_of(node.label, kContainers)) {
      read_container(node, path);
    } else if (node.label == "UserDefinedData_t") {
      read_user_data(node, path);
    }
  }

  /// Reads the node's child that lists vertices or elements. Returns the index of the list, −1 if there is
  /// none.
  int read_own_list(Node& node, Association association, const std::string& path) {
    int place = -1;
    for (Node& child : node.children) {
      const bool of_elements = child.name == "ElementList" || child.name == "ElementRange";
      if (!of_elements && child.name != "PointList" && child.name != "PointRange") continue;
      if (place >= 0) reading_.fail(path, "has two lists of points");
      place =
          read_list(child, zone_, of_elements ? Association::cells : association, path + "/" + child.name);
    }
    if (place >= 0) metadata_.lists[place].orders_data = has_data_of_list(node);
    return place;
  }

  /// Returns whether a node may have values for the members of its list, in the order of the list.
  static bool has_data_of_list(const Node& node) {
    constexpr std::array<std::string_view, 5> kLabels{"BCDataSet_t", "BCData_t", "DataArray_t",
                                                      "InwardNormalList_t", "UserDefinedData_t"};
    constexpr std::array<std::string_view, 3> kNames{"InwardNormalList", "PointListDonor", "CellListDonor"};
    return std::any_of(node.children.begin(), node.children.end(), [&](const Node& child) {
      return is_one_of(child.label, kLabels) || is_one_of(child.name, kNames);
    });
  }

  /// Sets `orders_data` of all lists of the zone: a ZoneSubRegion_t may have data for any of them.
  void mark_lists_of_zone() {
    for (PointList& list : metadata_.lists) list.orders_data = list.orders_data || list.zone == zone_;
  }

  void refuse_ghosts(const Node& node, const std::string& path) const {
    const Node* const rind = node.child_of_label("Rind_t");
    if (rind == nullptr) return;
    const std::vector<std::int64_t> planes = whole_numbers(reading_, *rind, path + "/" + rind->name);
    if (std::any_of(planes.begin(), planes.end(), [](std::int64_t n) { return n != 0; })) {
      reading_.fail(path, "has ghost points (Rind_t)", "save the mesh without them");
    }
  }

  void read_container(Node& node, const std::string& path) {
    refuse_ghosts(node, path);
    const Association association = location_of(node, Association::vertices);
    const int list = read_own_list(node, association, path);
    if (node.label == "ZoneSubRegion_t") {
      if (list < 0) {  // a boundary condition or a connectivity has the list
        has_named_part_ = has_named_part_ || has_data_of_list(node);
        return;
      }
      sets_.emplace_back(list, node.name);
    }
    Field rows{.association = association, .list = list};
    std::size_t count = association == Association::cells ? zone().centred_cells.size()
                                                          : static_cast<std::size_t>(zone().vertices);
    if (list >= 0) {
      rows.association = metadata_.lists[list].association;
      count = metadata_.lists[list].members.size();
    }
    for (Node& child : node.children) {
      if (child.label == "DataArray_t" && child.field < 0) {
        read_values(child, node.name, rows, count, path + "/" + child.name);
      }
    }
  }

  /// Reads the values of the `count` vertices or cells that `rows` names by association, section and list.
  void read_values(Node& node, const std::string& solution, const Field& rows, std::size_t count,
                   const std::string& path) {
    Values values = numbers_of(node);
    if (are_texts(values)) {
      if (count > 1 && node.size() == count) {
        reading_.notes.push_back(
            fmt::format("'{}' is kept as it is, though it has as many characters as there are {}", path,
                        to_string(rows.association)));
      }
      return;
    }
    if (node.size() != count) {
      reading_.fail(path,
                    fmt::format("has {} values for {} {}", node.size(), count, to_string(rows.association)));
    }
    Field field = rows;
    field.place = zone_;
    field.type = node.type;
    const auto step = zone().steps.find(solution);
    const std::string name =
        step == zone().steps.end() ? node.name : fmt::format("{} step {}", node.name, step->second);
    reading_.pieces.push_back({solution, name, std::move(values), reading_.bind(node, std::move(field))});
  }

  /// Reads user data of unknown meaning. Only data with a GridLocation_t are reordered.
  void read_user_data(Node& node, const std::string& path) {
    if (node.child_of_label("GridLocation_t") != nullptr) return read_container(node, path);
    const int list = read_own_list(node, Association::vertices, path);
    for (const Node& child : node.children) {
      if (list < 0 && child.label == "DataArray_t" && child.size() > 3 &&
          (child.size() == static_cast<std::uint64_t>(zone().vertices) ||
           child.size() == zone().centred_cells.size())) {
        reading_.notes.push_back(fmt::format(
            "'{}' is kept as it is, though it has as many values as there are vertices or cells", path));
      }
    }
  }

  // ---- boundary conditions

  void read_condition(Node& node, const std::string& path) {
    const Association association = location_of(node, Association::vertices);
    const int list = read_own_list(node, association, path);
    if (list < 0) reading_.fail(path, "does not say where it applies", "PointList or PointRange is expected");
    sets_.emplace_back(list, node.name);
    for (Node& child : node.children) {
      if (child.label == "BCDataSet_t") {
        (void)read_own_list(child, location_of(child, metadata_.lists[list].association),
                            path + "/" + child.name);
      }
    }
  }

  // ---- connectivities of zones

  void read_connection(Node& node, const std::string& path) {
    if (node.label == "GridConnectivity1to1_t") {
      reading_.fail(path, "connects zones by ranges of points, which a new order would break",
                    "save it as GridConnectivity_t with PointList and PointListDonor");
    }
    if (node.label == "OversetHoles_t") read_holes(node, path);
    if (node.label != "GridConnectivity_t") return;
    const Association association = location_of(node, Association::vertices);
    (void)read_own_list(node, association, path);
    for (Node& child : node.children) {
      if (child.name != "PointListDonor" && child.name != "CellListDonor") continue;
      const Association of_donor = child.name == "CellListDonor" ? Association::cells : association;
      (void)read_list(child, donor(node, path), of_donor, path + "/" + child.name);
    }
  }

  /// Reads the holes of a zone. CGNS allows one list or several ranges, and a range may become a list in a
  /// new order. So several ranges are joined to one range, or to a list.
  void read_holes(Node& node, const std::string& path) {
    const Association association = location_of(node, Association::vertices);
    const auto is_list = [](const Node& child) {
      return child.label == "IndexRange_t" || child.label == "IndexArray_t";
    };
    const auto first = std::find_if(node.children.begin(), node.children.end(), is_list);
    if (first == node.children.end()) return;
    PointList holes = list_in(*first, zone_, association, path + "/" + first->name);
    const bool is_only = std::none_of(first + 1, node.children.end(), is_list);
    for (auto child = first + 1; child != node.children.end(); ++child) {
      if (!is_list(*child)) continue;
      const PointList more = list_in(*child, zone_, association, path + "/" + child->name);
      holes.members.insert(holes.members.end(), more.members.begin(), more.members.end());
      holes.is_range = holes.is_range && more.is_range;
    }
    if (!is_only) {
      std::sort(holes.members.begin(), holes.members.end());
      holes.members.erase(std::unique(holes.members.begin(), holes.members.end()), holes.members.end());
      first->name = holes.is_range ? "PointRange" : "PointList";
      first->label = holes.is_range ? "IndexRange_t" : "IndexArray_t";
      node.children.erase(std::remove_if(first + 1, node.children.end(), is_list), node.children.end());
    }
    bind_list(*first, std::move(holes));
  }

  [[nodiscard]] int donor(const Node& node, const std::string& path) const {
    if (const int zone = reading_.zone_named(node.text()); zone >= 0) return zone;
    reading_.fail(path, "names the zone '" + node.text() + "', which does not exist",
                  "the donor is a zone of this file");
  }

  // ---- values, labels and parents of the cells of a section

  void read_section(Node& node, const std::string& path) {
    int s = zone().first_section;
    while (metadata_.sections[s].name != node.name) ++s;
    if (const Node* const label = node.child(kSectionLabel)) read_label(s, *label, path);
    if (Node* const values = node.child(kSectionValues)) read_section_values(s, *values, path);
    for (Node& child : node.children) {
      if (child.name == "ParentElements" || child.name == "ParentElementsPosition" ||
          child.name == "ParentData") {
        read_parents(child, s, path + "/" + child.name);
      }
    }
  }

  /// Reads values of the cells of a section, as `kSectionValues` describes.
  void read_section_values(int s, Node& values, const std::string& path) {
    if (values.label != "UserDefinedData_t") return;
    const Section& section = metadata_.sections[s];
    const auto count = static_cast<std::size_t>(reading_.cells_of_section[s].count);
    for (Node& child : values.children) {
      if (child.label != "DataArray_t") continue;
      if (section.type == kPolygons && child.size() != count) {
        reading_.notes.push_back(
            fmt::format("'{}/{}/{}' is kept as it is: it has {} values for {} polygons of a boundary", path,
                        values.name, child.name, child.size(), count));
        continue;
      }
      read_values(child, section.name, {.association = Association::cells, .section = s}, count,
                  path + "/" + child.name);
    }
  }

  /// Returns what to add to the parents of polygons to get element numbers: 0 if the parents are element
  /// numbers; the number of the first polyhedron − 1 if the parents count the polyhedra from 1.
  [[nodiscard]] std::int64_t shift_of_parents(std::span<const std::int64_t> numbers,
                                              const std::string& path) {
    const auto wrong = std::find_if(numbers.begin(), numbers.end(), [&](std::int64_t number) {
      const Index cell = number == 0 ? -1 : cell_of(zone(), number);
      return number != 0 &&
             (cell < 0 || dimension(reading_.mesh.cells.shapes[cell]) != metadata_.cell_dimension);
    });
    if (wrong == numbers.end()) return 0;
    std::vector<const Section*> polyhedra;
    for (int s = zone().first_section; s < zone().first_section + zone().section_count; ++s) {
      if (metadata_.sections[s].type == kPolyhedra) polyhedra.push_back(&metadata_.sections[s]);
    }
    const bool from_one =
        polyhedra.size() == 1 && std::all_of(numbers.begin(), numbers.end(), [&](std::int64_t number) {
          return number >= 0 && number <= polyhedra.front()->count;
        });
    if (!from_one) {
      reading_.fail(path, fmt::format("element {} is not a cell of the zone", *wrong),
                    "the parents of polygons are polyhedra");
    }
    return polyhedra.front()->first - 1;
  }

  void read_parents(Node& node, int s, const std::string& path) {
    const std::vector<std::int64_t> values = whole_numbers(reading_, node, path);
    const Section& section = metadata_.sections[s];
    const auto count = static_cast<std::size_t>(section.count);
    Parents parents{.section = s, .columns = node.name == "ParentData" ? 4U : 2U};
    if (values.size() != parents.columns * count) {
      reading_.fail(path, fmt::format("has {} values for {} elements", values.size(), count));
    }
    parents.number_type = node.type;
    parents.of_polygons = section.type == kPolygons;
    parents.rows = index_range(parents.of_polygons ? section.first_item : reading_.cells_of_section[s].first,
                               section.count);
    std::size_t column = 0;
    if (node.name != "ParentElementsPosition") {
      constexpr std::size_t kParents = 2;
      column = kParents;
      const std::span<const std::int64_t> numbers = std::span(values).first(kParents * count);
      const std::int64_t shift = parents.of_polygons ? shift_of_parents(numbers, path) : 0;
      parents.from_one = shift != 0;
      for (const std::int64_t number : numbers) {
        parents.cells.push_back(number == 0 ? Index{-1}
                                            : position_of(zone(), Association::cells, number + shift, path));
      }
    }
    parents.rest.assign(values.begin() + static_cast<std::ptrdiff_t>(column * count), values.end());
    const auto place = static_cast<int>(metadata_.parents.size());
    metadata_.parents.push_back(std::move(parents));
    reading_.bind(node, {.role = Field::Role::parents, .place = place});
  }

  void read_label(int s, const Node& label, const std::string& path) {
    const Node* const value = label.child("Value");
    if (label.label != "UserDefinedData_t" || value == nullptr) return;
    const std::vector<std::int64_t> numbers = whole_numbers(reading_, *value, path);
    if (numbers.size() != 1) return;
    labels_.resize(reading_.mesh.cells.shapes.size(), 0);
    const auto [first, count] = reading_.cells_of_section[s];
    std::fill_n(labels_.begin() + first, count, numbers.front());
    const Section& section = metadata_.sections[s];
    const ElementType* const type = element_type(section.type);
    if (type != nullptr && section.name == name_of_label(*type, numbers.front())) label_sections_.insert(s);
  }

  // ---- times

  void read_steps() {
    const Node* const data = zone().node->child_of_label("ZoneIterativeData_t");
    if (data == nullptr) return;
    for (const Node& pointers : data->children) {
      if (!pointers.name.ends_with("Pointers")) continue;
      const std::vector<std::string> names = rows_of_text(pointers);
      if (std::set<std::string>(names.begin(), names.end()).size() < 2) continue;
      for (std::size_t step = 0; step < names.size(); ++step) {
        if (names[step] != "GridCoordinates") zone().steps.emplace(names[step], static_cast<int>(step) + 1);
      }
    }
  }

  // ---- sets

  void name_sets() {
    std::map<std::string, int> uses;
    for (const auto& [list, name] : sets_) ++uses[name];
    for (const auto& [place, name] : sets_) {
      PointList& list = metadata_.lists[place];
      const std::string& zone = metadata_.zones[list.zone].name;
      add_set(list, uses[name] == 1 ? name : fmt::format("{}.{}", zone, name));
    }
  }

  void add_set(PointList& list, const std::string& wanted) {
    const std::string name = numbers_.free_name(
        wanted, [&](int k) { return fmt::format("{} {}", wanted, k); },
        [&](const std::string& free) { return set_names_.insert(free).second; });
    list.set = name;
    reading_.mesh.sets.push_back({name, list.association, unique_members(list.members)});
  }

  /// Makes a set of each boundary section with cells outside all sets (some programs name boundaries by
  /// sections), then the array of labels.
  void add_section_sets() {
    std::vector<bool> is_named(reading_.mesh.cells.shapes.size());
    for (const EntitySet& set : reading_.mesh.sets) {
      if (set.association == Association::vertices) continue;
      for (const Index member : set.members) is_named[member] = true;
    }
    for (int s = 0; s < index_size(metadata_.sections); ++s) {
      const Section& section = metadata_.sections[s];
      const auto [first, count] = reading_.cells_of_section[s];
      // a section with polygons between cells is not a boundary
      if (count < section.count || label_sections_.contains(s) ||
          dimension(reading_.mesh.cells.shapes[first]) == metadata_.cell_dimension) {
        continue;
      }
      const auto begin = is_named.begin() + first;
      if (std::find(begin, begin + count, false) == begin + count) continue;
      PointList list{.zone = section.zone, .association = Association::cells};
      list.members = index_range(first, count);
      add_set(list, section.name);
      metadata_.lists.push_back(std::move(list));
    }
    if (labels_.empty()) return;
    metadata_.has_labels = true;
    reading_.mesh.data.push_back({.name = std::string(kLabel),
                                  .association = Association::cells,
                                  .values = label_values(std::move(labels_))});
  }

  // ---- contents that other formats lose

  void count_lost() {
    std::map<std::string, int> labels;
    const auto count_conditions = [&](const Node& conditions) {
      for (const Node& condition : conditions.children) {
        if (condition.label != "BC_t") continue;
        if (condition.text() != "FamilySpecified" && condition.text() != "UserDefined")
          ++labels["types of boundary conditions"];
        if (condition.child_of_label("BCDataSet_t") != nullptr) ++labels["BCDataSet_t"];
      }
    };
    for (const Node& node : reading_.tree.root.child_of_label("CGNSBase_t")->children) {
      if (node.label != "Zone_t") {
        const bool is_name_only = node.label == "Family_t" && node.children.empty();
        if (!is_name_only) ++labels[node.label];
        continue;
      }
      for (const Node& part : node.children) {
        if (part.label == "ZoneBC_t") count_conditions(part);
        if (!is_one_of(part.label, kHeldByOthers)) ++labels[part.label];
      }
    }
    for (const auto& [label, count] : labels) {
      metadata_.lost.push_back(count == 1 ? label : fmt::format("{} ({})", label, count));
    }
  }

  Reading& reading_;
  CgnsMetadata& metadata_;
  int zone_ = 0;
  bool has_named_part_ = false;  // a ZoneSubRegion_t of the zone has data for a list of another node
  std::vector<std::pair<int, std::string>> sets_;  // lists that become sets, and their names in the file
  std::set<std::string> set_names_;
  NameNumbers numbers_;
  std::vector<std::int64_t> labels_;
  std::set<int> label_sections_;  // sections named by `name_of_label`
};

}  // namespace

Association location_of(const Node& node, Association inherited) {
  const Node* const location = node.child_of_label("GridLocation_t");
  if (location == nullptr) return inherited;
  return is_one_of(location->text(), kVertexLocations) ? Association::vertices : Association::cells;
}

void read_attachments(Reading& reading) { AttachmentReader(reading).read(); }

}  // namespace meshorder::cgns
