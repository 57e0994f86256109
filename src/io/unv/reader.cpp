// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/deck/numbers.hpp"
#include "io/labels.hpp"
#include "io/names.hpp"
#include "io/stream/scanner.hpp"
#include "io/unv/unv.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

namespace meshorder::unv {
namespace {

/// Greatest number of nodes of an element that is a cell.
constexpr std::size_t kMostNodes = 20;

/// Returns whether a line begins or ends a dataset: −1 in its first six columns.
bool is_delimiter(std::string_view line) { return trimmed(line) == "-1" && line.find('-') <= 4; }

/// Returns whether a dataset is known to name neither nodes nor elements.
bool is_harmless(int dataset) {
  // coordinate systems, header, units, materials, header of the model, coordinate systems
  constexpr std::array kHarmless{18, kHeader, 164, 1710, 2400, kSystems};
  return std::find(kHarmless.begin(), kHarmless.end(), dataset) != kHarmless.end();
}

/// The members of a group before all nodes and elements are known.
struct Members {
  std::int64_t line = 0;
  std::vector<Index> nodes;  ///< numbers of the nodes
  std::vector<Index> elements;
};

class UnvReader {
 public:
  UnvReader(const FilePath& path, Notes& notes) : in_(path), notes_(notes) {
    const std::size_t end = in_.all().find('\n');
    if (end != std::string_view::npos && end > 0 && in_.all()[end - 1] == '\r') file_->line_end = "\r\n";
  }

  Mesh read() {
    while (begin_dataset()) read_dataset();
    finish();
    return std::move(mesh_);
  }

 private:
  /// Takes the lines before the content of the next dataset; returns false at the end of the file.
  bool begin_dataset() {
    begin_ = in_.byte();
    while (in_.bytes_left() > 0 && trimmed(in_.peek_line()).empty()) (void)in_.raw_line();
    if (in_.byte() > begin_) add_text(0);
    if (in_.bytes_left() == 0) return false;
    begin_ = in_.byte();
    line_ = in_.line();
    if (!is_delimiter(in_.peek_line())) {
      in_.fail(fmt::format("expected a line of -1, which begins a dataset, found '{}'",
                           shown(trimmed(in_.peek_line()))),
               file_->sections.empty() ? "the file may not be a universal file" : "the file may be damaged");
    }
    (void)in_.raw_line();
    if (in_.bytes_left() == 0) in_.fail("the file ends before the number of a dataset", kCutShort);
    std::string_view line = in_.peek_line();
    const std::string_view word = next_word(line);
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), dataset_);
    const std::string_view after = word.substr(static_cast<std::size_t>(end - word.data()));
    is_binary_ = after == "b";
    if (code != std::errc{} || dataset_ < 1 || (!after.empty() && !is_binary_)) {
      in_.fail(fmt::format("the number of a dataset is '{}'", shown(trimmed(in_.peek_line()))),
               "a line of -1 may be missing or superfluous");
    }
    if (is_binary_) binary_fields_ = std::string(line);
    (void)in_.raw_line();
    return true;
  }

  void read_dataset() {
    switch (dataset_) {
      case kNodes:
      case kNodesInDouble:
      case kNodesInSingle:
        return read_nodes();
      case kElements:
      case kElementsOfOld:
        return read_elements();
      case kResults:
      case kResultsAtNodes:
      case kResultsAtElements:
        if (read_results()) return;
        break;
      default:
        if (numbers_of_member(dataset_) > 0 && read_groups()) return;
    }
    keep_dataset();
  }

  Dataset& begin_section(DatasetKind part, Index first) {
    Dataset& section = file_->sections.emplace_back();
    section.part = part;
    section.dataset = dataset_;
    section.first = first;
    return section;
  }

  /// Makes a section of the lines since `begin_`.
  void add_text(int dataset) {
    Dataset& section = file_->sections.emplace_back();
    section.dataset = dataset;
    section.text = since(begin_);
  }

  [[nodiscard]] std::string_view since(std::int64_t begin) const {
    return in_.all().substr(static_cast<std::size_t>(begin), static_cast<std::size_t>(in_.byte() - begin));
  }

  void keep_dataset() {
    in_.seek(begin_);
    (void)in_.raw_line();
    (void)in_.raw_line();
    if (is_binary_) skip_binary();
    for (bool ends = false; !ends;) {
      if (in_.bytes_left() == 0) fail_open();
      ends = is_delimiter(in_.raw_line());
    }
    add_text(dataset_);
    keep(dataset_, line_);
  }

  /// Records a dataset kept verbatim, as unknown unless `is_harmless`.
  void keep(int dataset, std::int64_t line) {
    const std::string name = fmt::format("dataset {}", dataset);
    if (!is_harmless(dataset)) file_->unknown.push_back(fmt::format("{} (line {})", name, line));
    if (dataset != kHeader) kept_.insert(name);
  }

  /// Skips the binary part of a dataset, whose first line says how many lines and bytes follow.
  void skip_binary() {
    std::array<std::int64_t, 4> fields{};  // byte order, format of numbers, lines, bytes
    std::string_view rest = binary_fields_;
    for (std::int64_t& field : fields) {
      field = parse_integer<std::int64_t>(in_, next_word(rest), "a field of a binary dataset");
    }
    for (std::int64_t k = 0; k < fields[2] && in_.bytes_left() > 0; ++k) (void)in_.raw_line();
    (void)in_.binary_block(fields[3], "a binary dataset");
  }

  [[noreturn]] void fail_open() const {
    in_.fail(fmt::format("the dataset {} of line {} has no line of -1 at its end", dataset_, line_),
             kCutShort);
  }

  /// Takes the first number of a record. If it is the −1 that ends the dataset, takes the line and returns
  /// false.
  bool begin_record(std::int64_t& number, std::string_view what) {
    if (in_.at_end()) fail_open();
    number = in_.integer<std::int64_t>(what);
    if (number != -1 || !in_.at_line_end()) return true;
    (void)in_.raw_line();
    return false;
  }

  std::int64_t next_integer(std::string_view what) {
    expect_more(what);
    return in_.integer<std::int64_t>(what);
  }

  void expect_more(std::string_view what) {
    if (in_.at_line_end()) in_.fail("the line ends before " + std::string(what), kCutShort);
  }

  void end_record(std::string_view what) {
    if (!in_.at_line_end()) in_.fail(fmt::format("{} has too many numbers", what), "the file may be damaged");
  }

  [[nodiscard]] Index checked_number(std::int64_t number, std::string_view what) const {
    if (number < 0 || number > kMaxIndex) {  // libMesh wrote numbers from 0
      in_.fail(fmt::format("{} is {}", what, number), "0 to 2147483647 are possible");
    }
    return static_cast<Index>(number);
  }

  void read_nodes() {
    Dataset& section = begin_section(DatasetKind::nodes, mesh_.vertex_count());
    std::int64_t number = 0;
    while (begin_record(number, "the number of a node")) {
      if (!file_->nodes.add(checked_number(number, "the number of a node"))) {
        in_.fail(fmt::format("node {} is given twice", number), "numbers must differ");
      }
      NodeFields fields;
      fields.system = next_integer("a field of the node");
      fields.displacement_system = next_integer("a field of the node");
      fields.colour = next_integer("a field of the node");
      file_->node_fields.add(fields);
      Point point{};
      for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0) expect_more("a coordinate");
        point[k] = coordinate();
      }
      end_record("the node");
      mesh_.points.push_back(point);
    }
    section.count = mesh_.vertex_count() - section.first;
  }

  double coordinate() {
    const std::string_view word = in_.word("a coordinate");
    if (mesh_.points.empty()) {
      const std::size_t letter = word.find_first_of("DdEe");
      if (letter != std::string_view::npos) file_->exponent = word[letter];
    }
    const double value = real_of(in_, word, "a coordinate");
    if (!std::isfinite(value)) in_.fail("a coordinate is not finite", "a finite number is needed");
    return value;
  }

  void read_elements() {
    Dataset& section = begin_section(DatasetKind::elements, mesh_.cell_count());
    std::int64_t number = 0;
    while (begin_record(number, "the number of an element")) {
      (void)checked_number(number, "the number of an element");
      if (file_->elements.find(number) >= 0 || other_elements_.contains(number)) {
        in_.fail(fmt::format("element {} is given twice", number), "numbers must differ");
      }
      constexpr std::string_view kField = "a field of the element";
      const bool of_old = dataset_ == kElementsOfOld;
      ElementFields fields;
      fields.type = next_integer("the type of the element");
      if (of_old) fields.property_table = next_integer(kField);
      fields.property = next_integer(kField);
      if (of_old) fields.material_table = next_integer(kField);
      fields.material = next_integer(kField);
      fields.colour = next_integer(kField);
      const std::int64_t nodes = next_integer("the number of its nodes");
      end_record("the element");
      (void)in_.raw_line();
      const auto kind = kind_of(fields.type, nodes);
      read_beam(fields, nodes);
      if (kind) {
        read_cell(static_cast<Index>(number), *kind);
        file_->element_fields.add(fields);
      } else {
        read_other({number, fields, {}}, nodes, section);
      }
      end_record("the element");
    }
    section.count = mesh_.cell_count() - section.first;
  }

  /// Takes the line of three numbers that beams have, and rods in some programs' files.
  void read_beam(ElementFields& fields, std::int64_t nodes) {
    if (nodes == 2) {
      std::string_view line = in_.peek_line();
      std::size_t words = 0;
      while (!next_word(line).empty()) ++words;
      fields.has_beam = words == fields.beam.size();
    } else {
      fields.has_beam = is_beam(fields.type);
    }
    if (!fields.has_beam) return;
    for (std::int64_t& number : fields.beam) number = next_integer("the orientation or section of the beam");
    end_record("the beam");
    (void)in_.raw_line();
  }

  Index next_node() {
    return checked_number(in_.integer<std::int64_t>("a node of the element"), "a node of the element");
  }

  void read_cell(Index number, ElementKind kind) {
    const auto nodes = static_cast<std::size_t>(kind.nodes);
    const std::span<const int> order = file_order(kind);
    const Offset first = mesh_.cells.offsets.back();
    std::array<Index, kMostNodes> cell{};
    for (std::size_t k = 0; k < nodes; ++k) {
      const Index node = next_node();
      const std::size_t at = order.empty() ? k : static_cast<std::size_t>(order[k]);
      const Index vertex = file_->nodes.find(node);
      cell[at] = std::max(vertex, 0);
      if (vertex < 0) later_nodes_.push_back({first + static_cast<Offset>(at), node, in_.line()});
    }
    (void)file_->elements.add(number);
    mesh_.cells.push_back(kind.shape, {cell.data(), nodes});
  }

  void read_other(OtherElement element, std::int64_t nodes, Dataset& section) {
    const Index count = in_.checked_count(nodes, "the number of its nodes", 2);
    for (Index k = 0; k < count; ++k) element.nodes.push_back(next_node());
    other_elements_.insert(element.number);
    other_types_.insert(fmt::format("{}", element.fields.type));
    section.others.push_back(std::move(element));
  }

  /// Reads groups. Returns false if a member belongs to a part of an assembly, that is, if its last two
  /// numbers are not both 0.
  bool read_groups() {
    const auto per_member = static_cast<std::size_t>(numbers_of_member(dataset_));
    const std::size_t groups_before = file_->groups.size();
    std::int64_t number = 0;
    while (begin_record(number, "the number of a group")) {
      Group group;
      Members members{in_.line(), {}, {}};
      group.fields.push_back(number);
      while (!in_.at_line_end()) {
        group.fields.push_back(next_integer("a field of the group"));
        if (group.fields.size() > 8) in_.fail("the group has too many fields", "at most 8 are possible");
      }
      if (group.fields.size() < 2) in_.fail("the group has no number of members", kCutShort);
      const Index count = in_.checked_count(group.fields.back(), "the number of members", 4);
      group.fields.pop_back();
      (void)in_.raw_line();
      group.name = trimmed(in_.raw_line());
      for (Index k = 0; k < count; ++k) {
        std::array<std::int64_t, 4> member{};
        for (std::size_t i = 0; i < per_member; ++i) {
          member[i] = in_.integer<std::int64_t>("a member of the group");
        }
        if (!add_member(member, group, members)) {
          file_->groups.resize(groups_before);
          members_.resize(groups_before);
          return false;
        }
      }
      if (count > 0) end_record("the group");
      file_->groups.push_back(std::move(group));
      members_.push_back(std::move(members));
    }
    Dataset& section = begin_section(DatasetKind::groups, static_cast<Index>(groups_before));
    section.count = index_size(file_->groups) - section.first;
    return true;
  }

  static bool add_member(const std::array<std::int64_t, 4>& member, Group& group, Members& members) {
    const auto [code, number, leaf, component] = member;
    const bool is_item = code == kNodeCode || code == kElementCode;
    if (is_item && (leaf != 0 || component != 0)) return false;
    if (!is_item || number < 0 || number > kMaxIndex) {
      group.others.push_back(member);
    } else {
      (code == kNodeCode ? members.nodes : members.elements).push_back(static_cast<Index>(number));
    }
    return true;
  }

  /// Returns the positions of members. Adds elements that are not cells to `group`; counts unknown numbers.
  std::vector<Index> positions(const std::vector<Index>& numbers, Association association, Group& group,
                               std::int64_t& missing) const {
    const bool of_nodes = association == Association::vertices;
    const IdMap& items = of_nodes ? file_->nodes : file_->elements;
    std::vector<Index> result;
    std::vector<bool> seen(static_cast<std::size_t>(items.size()), false);
    result.reserve(numbers.size());
    for (const Index number : numbers) {
      const Index item = items.find(number);
      if (item < 0 && !of_nodes && other_elements_.contains(number)) {
        group.others.push_back({kElementCode, number, 0, 0});
      } else if (item < 0) {
        ++missing;
      } else if (!seen[item]) {
        seen[item] = true;
        result.push_back(item);
      }
    }
    return result;
  }

  void make_sets() {
    UniqueNames names;
    for (std::size_t g = 0; g < file_->groups.size(); ++g) {
      Group& group = file_->groups[g];
      // the group's sets of nodes and of elements get the same name
      group.set = names.take(Association::cells,
                             group.name.empty() ? fmt::format("group {}", group.fields[0]) : group.name);
      std::int64_t missing = 0;
      auto vertices = positions(members_[g].nodes, Association::vertices, group, missing);
      auto cells = positions(members_[g].elements, Association::cells, group, missing);
      group.has_elements = !cells.empty();
      group.has_nodes = !vertices.empty() || (!group.has_elements && group.others.empty());
      if (group.has_nodes) mesh_.sets.push_back({group.set, Association::vertices, std::move(vertices)});
      if (group.has_elements) mesh_.sets.push_back({group.set, Association::cells, std::move(cells)});
      if (missing > 0) {
        notes_.push_back(
            fmt::format("{}:{}: the group '{}' is read without {} that the file does not have", in_.file(),
                        members_[g].line, shown(group.name),
                        missing == 1 ? "a node or element" : fmt::format("{} nodes or elements", missing)));
      }
      if (!group.others.empty()) {
        file_->contents.push_back(
            fmt::format("members of the group '{}' that are neither nodes nor cells", shown(group.name)));
      }
    }
  }

  bool read_results() {
    auto header = read_results_header(in_, dataset_);
    if (!header) return false;
    FoundResults found{std::move(*header), line_, {}, {}, {}, {}};
    found.text = since(begin_);
    const auto components = static_cast<std::size_t>(found.results.components);
    std::int64_t number = 0;
    while (begin_record(number, "the number of a node or element")) {
      found.numbers.push_back(number);
      // values of elements may have fewer components than the dataset says
      if (found.results.association == Association::cells &&
          next_integer("the number of values") != found.results.components_in_file) {
        return false;
      }
      end_record("the number of a node or element");
      for (std::size_t k = 0; k < components; ++k) {
        found.values.push_back(real_of(in_, in_.word("a value"), "a value"));
      }
      end_record("the node or element");
    }
    found.all = since(begin_);
    begin_section(DatasetKind::results, index_size(results_));
    section_of_results_.push_back(file_->sections.size() - 1);
    results_.push_back(std::move(found));
    return true;
  }

  void make_arrays() {
    std::map<std::pair<Association, std::string>, int> steps;
    for (const FoundResults& found : results_) ++steps[{found.results.association, found.results.name}];
    std::map<std::pair<Association, std::string>, int> step;
    for (std::size_t r = 0; r < results_.size(); ++r) {
      FoundResults& found = results_[r];
      const std::pair key{found.results.association, found.results.name};
      Dataset& section = file_->sections[section_of_results_[r]];
      const bool of_nodes = found.results.association == Association::vertices;
      const std::string& name = found.results.name;
      found.results.array = steps[key] > 1 ? fmt::format("{} step {}", name, ++step[key]) : name;
      auto array = array_of(found, of_nodes ? file_->nodes : file_->elements);
      const bool is_taken = find_array(mesh_, found.results.array, found.results.association) != nullptr;
      if (!array || is_taken) {
        section.part = DatasetKind::text;
        section.text = found.all;
        keep(section.dataset, found.line);
        continue;
      }
      mesh_.data.push_back(std::move(*array));
      section.text = found.text;
      section.first = static_cast<Index>(file_->results.size());
      section.count = 1;
      file_->results.push_back(found.results);
    }
  }

  void finish() {
    require_mesh(*file_, in_.file(), "has no nodes (dataset 2411, 781 or 15)",
                 "has no elements that are cells (dataset 2412 or 780)", join(other_types_));
    resolve(later_nodes_, file_->nodes, mesh_.cells, [&](const LaterNode<std::int64_t>& later) {
      throw InputError(
          Location{in_.file(), later.place, -1},
          fmt::format("a node of the element is {}, which no dataset of nodes has", later.number),
          "add it, or correct the element");
    });
    check_systems();
    make_arrays_of_fields();
    make_sets();
    make_arrays();
    list_losses();
    note_kept_numbers(file_->unknown, notes_);
    keep_deck(mesh_, file_);
  }

  /// Refuses nodes whose coordinates are in a system of the file other than the global system.
  void check_systems() {
    for (const Dataset& section : file_->sections) {
      if (section.part != DatasetKind::text || section.dataset != kSystems) continue;
      for (const std::int64_t system : local_systems(section.text)) {
        const auto& used = file_->node_fields.different();
        if (std::none_of(used.begin(), used.end(),
                         [&](const NodeFields& fields) { return fields.system == system; })) {
          continue;
        }
        throw InputError(
            in_.file(),
            fmt::format("nodes have coordinates in the coordinate system {}, not in the global one", system),
            "export the mesh in global coordinates");
      }
    }
  }

  /// Makes arrays of properties and of materials, each if its values differ; the array of properties also if
  /// all properties are the same number other than 0 and 1.
  void make_arrays_of_fields() {
    const auto make = [&](std::string_view name, std::int64_t ElementFields::*field) {
      const auto& all = file_->element_fields.different();
      const std::int64_t first = all.front().*field;
      const bool differ = std::any_of(all.begin(), all.end(),
                                      [&](const ElementFields& fields) { return fields.*field != first; });
      const bool tells = differ || (name == kLabel && first != 0 && first != 1);
      if (!tells) return;
      std::vector<std::int64_t> values;
      values.reserve(mesh_.cells.shapes.size());
      for (Index c = 0; c < mesh_.cell_count(); ++c) values.push_back(file_->element_fields[c].*field);
      mesh_.data.push_back(
          {std::string(name), Association::cells, 1, label_values(std::move(values)), {}, {}});
    };
    make(kLabel, &ElementFields::property);
    make(kMaterial, &ElementFields::material);
  }

  void list_losses() {
    std::set<std::string> types;
    for (const ElementFields& fields : file_->element_fields.different()) {
      constexpr std::array kUsual{21, 24, 91, 92, 94, 95, 111, 112, 113, 115, 116, 118};
      if (std::find(kUsual.begin(), kUsual.end(), fields.type) == kUsual.end()) {
        types.insert(fmt::format("{}", fields.type));
      }
    }
    std::vector<std::string>& lost = file_->contents;
    if (!types.empty()) lost.push_back("the types of elements " + join(types));
    if (!other_types_.empty()) lost.push_back("elements of the types " + join(other_types_));
    lost.insert(lost.end(), kept_.begin(), kept_.end());
  }

  static constexpr const char* kCutShort = "the file may be cut short";

  Scanner in_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<Contents> file_ = std::make_shared<Contents>();
  int dataset_ = 0;  // number of the dataset that is being read
  bool is_binary_ = false;
  std::string binary_fields_;
  std::int64_t begin_ = 0;                            // first byte of the dataset
  std::int64_t line_ = 0;                             // first line of the dataset
  std::vector<LaterNode<std::int64_t>> later_nodes_;  // place: the line of the node
  std::set<std::int64_t> other_elements_;             // elements that are not cells
  std::set<std::string> other_types_;
  std::vector<Members> members_;  // members of the groups
  std::vector<FoundResults> results_;
  std::vector<std::size_t> section_of_results_;
  std::set<std::string> kept_;  // names of datasets
};

}  // namespace

int numbers_of_member(int dataset) {
  constexpr std::array kPairs{752, 2417, 2429, 2430, 2432};
  constexpr std::array kFours{2435, 2452, 2467, kGroups};
  if (std::find(kFours.begin(), kFours.end(), dataset) != kFours.end()) return 4;
  return std::find(kPairs.begin(), kPairs.end(), dataset) != kPairs.end() ? 2 : 0;
}

Mesh read(const FilePath& path, Notes& notes) { return UnvReader(path, notes).read(); }

}  // namespace meshorder::unv
