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

/// Returns whether the first word of a line is a number.
bool begins_with_number(std::string_view line) {
  const std::string_view word = next_word(line);
  return word.find_first_not_of("0123456789+-.DdEe") == std::string_view::npos &&
         word.find_first_of("0123456789") != std::string_view::npos;
}

/// Returns whether a line begins or ends a dataset: −1 in its first six columns, perhaps followed by a text.
bool is_delimiter(std::string_view line) {
  const std::size_t width = std::min<std::size_t>(6, line.size());
  const std::string_view after = line.substr(width);
  return trimmed(line.substr(0, width)) == "-1" && trimmed(after.substr(0, 1)).empty() &&
         !begins_with_number(after);
}

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
    take_lines_between();
    if (in_.bytes_left() == 0) return false;
    begin_ = in_.byte();
    line_ = in_.line();
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
    head_ = since(begin_);
    return true;
  }

  /// Takes the lines up to the next dataset, which may have any text. A number alone may be that of a dataset
  /// whose line of -1 is missing.
  void take_lines_between() {
    begin_ = in_.byte();
    Scanner first = in_;  // at the first line with text
    while (in_.bytes_left() > 0 && !is_delimiter(in_.peek_line())) {
      const std::string_view line = trimmed(in_.peek_line());
      if (!line.empty() && line.find_first_not_of("0123456789") == std::string_view::npos) fail_between(in_);
      if (trimmed(first.peek_line()).empty()) first.move_to(in_);
      (void)in_.raw_line();
    }
    if (in_.bytes_left() == 0 && file_->sections.empty()) fail_between(first);
    if (in_.byte() > begin_) add_text(0);
  }

  [[noreturn]] void fail_between(const Scanner& at) const {
    at.fail(fmt::format("expected a line of -1, which begins a dataset, found '{}'",
                        shown(trimmed(at.peek_line()))),
            file_->sections.empty() ? "the file may not be a universal file" : "the file may be damaged");
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
    section.text = head_;
    section.first = first;
    section.end = end_;
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

  /// Takes the first number of the next item; texts after its fields go to `remarks` as those of `item`. If
  /// the number is the −1 that ends the dataset, takes the line and returns false.
  bool begin_item(std::int64_t& number, std::string_view what, Remarks& remarks, Index item) {
    if (in_.at_end()) fail_open();
    remarks_ = &remarks;
    item_ = item;
    line_of_item_ = 0;
    columns_ = 0;
    number = next_integer(what);
    if (number != -1) return true;
    const bool is_end = in_.at_line_end();
    if (!is_end && !is_delimiter(whole_line())) return true;
    end_ = is_end ? std::string_view() : after_fields();
    (void)in_.raw_line();
    return false;
  }

  /// Takes a whole number. Blanks separate numbers; a number that fills its ten columns needs none.
  std::int64_t next_integer(std::string_view what) {
    constexpr std::int64_t kLargest = 9'999'999'999;  // of ten columns; −999999999 is the smallest
    expect_more(what);
    columns_ += kWholeWidth;
    const std::int64_t begin = in_.byte();
    std::int64_t number = 0;
    if (in_.take_number(number) && number <= kLargest && number >= -kLargest / 10) return number;
    in_.seek(begin);
    const std::string_view field = up_to_field_end();
    const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (code != std::errc{} || end != field.data() + field.size()) return in_.integer<std::int64_t>(what);
    in_.move_on(field.size());
    return number;
  }

  /// Takes a real number of `width` columns, which the next number may follow without a blank.
  double next_real(std::string_view what, std::size_t width) {
    expect_more(what);
    columns_ += width;
    std::string_view word = in_.peek_word();
    const std::string_view field = up_to_field_end();
    if (!field.empty() && field.size() < word.size()) {
      const std::string_view next = word.substr(field.size());
      const bool is_sign = next.front() == '-' || next.front() == '+';
      // the exponent 1.5-103 has no point
      if (is_sign && next.find('.') != std::string_view::npos) word = field;
    }
    in_.move_on(word.size());
    return real_of(in_, word, what);
  }

  /// Returns the position of the first byte of this line.
  [[nodiscard]] std::size_t line_begin() const {
    return in_.all().substr(0, static_cast<std::size_t>(in_.byte())).find_last_of("\r\n") + 1;
  }

  /// Returns this line from a position on.
  [[nodiscard]] std::string_view line_from(std::size_t begin) const {
    const std::size_t end = static_cast<std::size_t>(in_.byte()) + in_.peek_line().size();
    return in_.all().substr(begin, end - begin);
  }

  [[nodiscard]] std::string_view whole_line() const { return line_from(line_begin()); }

  /// Returns this line from here to the column where the present field ends.
  [[nodiscard]] std::string_view up_to_field_end() const {
    const std::size_t here = static_cast<std::size_t>(in_.byte()) - line_begin();
    return in_.peek_line().substr(0, columns_ - std::min(columns_, here));
  }

  /// Returns what follows the last field on this line, with the blanks before it.
  [[nodiscard]] std::string_view after_fields() const {
    const std::string_view before = in_.all().substr(0, static_cast<std::size_t>(in_.byte()));
    return line_from(before.find_last_not_of(" \t\f\v") + 1);
  }

  void expect_more(std::string_view what) {
    if (in_.at_line_end()) in_.fail("the line ends before " + std::string(what), kCutShort);
  }

  /// Returns whether no more numbers follow on this line, whose fields have `width` columns at most. After
  /// these columns any text may follow.
  bool fields_end(std::size_t width) {
    return in_.at_line_end() || !begins_with_number(in_.peek_line()) ||
           whole_line().size() - after_fields().size() == width;
  }

  /// Takes the rest of a line and keeps the text after its fields.
  void end_line(std::string_view what, std::size_t width) {
    if (!fields_end(width)) in_.fail(fmt::format("{} has too many numbers", what), "the file may be damaged");
    if (!in_.at_line_end()) remarks_->emplace(std::pair(item_, line_of_item_), after_fields());
    (void)in_.raw_line();
    ++line_of_item_;
    columns_ = 0;
  }

  /// Takes `count` numbers, each by `take()`. A full line has `on_line` numbers in `width` columns; others
  /// may have fewer, or more if these follow at once.
  template <class Take>
  void take_list(std::string_view what, std::size_t count, std::size_t on_line, std::size_t width,
                 const Take& take) {
    std::size_t taken = 0;  // on this line
    for (std::size_t k = 0; k < count; ++k) {
      if (taken > 0 && (in_.at_line_end() || (taken >= on_line && fields_end(width)))) {
        end_line(what, width);
        taken = 0;
      }
      if (in_.at_end()) fail_open();
      take();
      ++taken;
    }
    if (count > 0) end_line(what, width);
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
    const bool single = dataset_ == kNodesInSingle;
    const std::size_t width = single ? kSingleWidth : kCoordinateWidth;
    while (begin_item(number, "the number of a node", file_->node_remarks, mesh_.vertex_count())) {
      if (!file_->nodes.add(checked_number(number, "the number of a node"))) {
        in_.fail(fmt::format("node {} is given twice", number), "numbers must differ");
      }
      NodeFields fields;
      fields.system = next_integer("a field of the node");
      fields.displacement_system = next_integer("a field of the node");
      fields.colour = next_integer("a field of the node");
      file_->node_fields.add(fields);
      if (!single && (in_.at_line_end() || !begins_with_number(in_.peek_line()))) {
        end_line("the node", 4 * kWholeWidth);
        if (in_.at_end()) fail_open();
      }
      Point point{};
      for (double& value : point) value = coordinate(width);
      end_line("the node", (single ? 4 * kWholeWidth : 0) + 3 * width);
      mesh_.points.push_back(point);
    }
    section.count = mesh_.vertex_count() - section.first;
    section.end = end_;
  }

  double coordinate(std::size_t width) {
    if (mesh_.points.empty()) {
      const std::string_view word = in_.peek_word();
      const std::size_t letter = word.find_first_of("DdEe");
      if (letter != std::string_view::npos) file_->exponent = word[letter];
    }
    const double value = next_real("a coordinate", width);
    if (!std::isfinite(value)) in_.fail("a coordinate is not finite", "a finite number is needed");
    return value;
  }

  void read_elements() {
    Dataset& section = begin_section(DatasetKind::elements, mesh_.cell_count());
    std::int64_t number = 0;
    while (begin_item(number, "the number of an element", file_->element_remarks, mesh_.cell_count())) {
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
      const auto kind = kind_of(fields.type, nodes);
      OtherElement other{number, {}, {}};
      if (!kind) {
        remarks_ = &other.remarks;
        item_ = 0;
      }
      end_line("the element", (of_old ? 8 : 6) * kWholeWidth);
      read_beam(fields, nodes);
      if (kind) {
        read_cell(static_cast<Index>(number), *kind);
        file_->element_fields.add(fields);
      } else {
        other.fields = fields;
        read_other(std::move(other), nodes, section);
      }
    }
    section.count = mesh_.cell_count() - section.first;
    section.end = end_;
  }

  /// Takes the line of three numbers that beams have, and rods in some programs' files.
  void read_beam(ElementFields& fields, std::int64_t nodes) {
    if (nodes == 2) {
      std::string_view line = in_.peek_line();
      std::size_t numbers = 0;
      for (; begins_with_number(line); ++numbers) (void)next_word(line);
      fields.has_beam = numbers == fields.beam.size();
    } else {
      fields.has_beam = is_beam(fields.type);
    }
    if (!fields.has_beam) return;
    for (std::int64_t& number : fields.beam) number = next_integer("the orientation or section of the beam");
    end_line("the beam", 3 * kWholeWidth);
  }

  Index next_node() { return checked_number(next_integer("a node of the element"), "a node of the element"); }

  void read_cell(Index number, ElementKind kind) {
    const auto nodes = static_cast<std::size_t>(kind.nodes);
    const std::span<const int> order = file_order(kind);
    const Offset first = mesh_.cells.offsets.back();
    std::array<Index, kMostNodes> cell{};
    std::size_t k = 0;
    take_list("the element", nodes, kWholesOnLine, kRecordWidth, [&] {
      const Index node = next_node();
      const std::size_t at = order.empty() ? k : static_cast<std::size_t>(order[k]);
      const Index vertex = file_->nodes.find(node);
      cell[at] = std::max(vertex, 0);
      if (vertex < 0) later_nodes_.push_back({first + static_cast<Offset>(at), node, in_.line()});
      ++k;
    });
    (void)file_->elements.add(number);
    mesh_.cells.push_back(kind.shape, {cell.data(), nodes});
  }

  void read_other(OtherElement element, std::int64_t nodes, Dataset& section) {
    const Index count = in_.checked_count(nodes, "the number of its nodes", 2);
    remarks_ = &element.remarks;
    take_list("the element", static_cast<std::size_t>(count), kWholesOnLine, kRecordWidth,
              [&] { element.nodes.push_back(next_node()); });
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
    while (begin_item(number, "the number of a group", file_->group_remarks, index_size(file_->groups))) {
      Group group;
      Members members{in_.line(), {}, {}};
      group.fields.push_back(number);
      while (!in_.at_line_end() && group.fields.size() < kWholesOnLine &&
             begins_with_number(in_.peek_line())) {
        group.fields.push_back(next_integer("a field of the group"));
      }
      if (group.fields.size() < 2) in_.fail("the group has no number of members", kCutShort);
      const Index count = in_.checked_count(group.fields.back(), "the number of members", 4);
      group.fields.pop_back();
      end_line("the group", kRecordWidth);
      group.name = trimmed(in_.raw_line());
      std::array<std::int64_t, 4> member{};
      std::size_t i = 0;
      bool is_of_assembly = false;
      take_list("the group", static_cast<std::size_t>(count) * per_member, kWholesOnLine, kRecordWidth, [&] {
        member[i] = next_integer("a member of the group");
        i = (i + 1) % per_member;
        if (i == 0) is_of_assembly = !add_member(member, group, members) || is_of_assembly;
      });
      if (is_of_assembly) {
        file_->groups.resize(groups_before);
        members_.resize(groups_before);
        file_->group_remarks.erase(file_->group_remarks.lower_bound({index_size(file_->groups), 0}),
                                   file_->group_remarks.end());
        return false;
      }
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
    const bool of_cells = found.results.association == Association::cells;
    const std::size_t width = found.results.on_line() * found.results.width();
    while (begin_item(number, "the number of a node or element", found.results.remarks,
                      index_size(found.numbers))) {
      found.numbers.push_back(number);
      // values of elements may have fewer components than the dataset says
      if (of_cells && next_integer("the number of values") != found.results.components_in_file) {
        return false;
      }
      end_line("the number of a node or element", (of_cells ? 2 : 1) * kWholeWidth);
      take_list("the node or element", components, found.results.on_line(), width,
                [&] { found.values.push_back(next_real("a value", found.results.width())); });
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
      const IdMap& items = of_nodes ? file_->nodes : file_->elements;
      auto array = array_of(found, items);
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
      Results& results = file_->results.emplace_back(found.results);
      results.remarks.clear();
      for (auto& [place, text] : found.results.remarks) {
        const Index item = items.find(found.numbers[static_cast<std::size_t>(place.first)]);
        results.remarks.emplace(std::pair(item, place.second), std::move(text));
      }
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
    if (has_texts_between()) lost.emplace_back("lines between datasets");
    if (has_remarks()) lost.emplace_back("texts after the numbers of a line");
  }

  [[nodiscard]] bool has_texts_between() const {
    return std::any_of(file_->sections.begin(), file_->sections.end(), [](const Dataset& section) {
      return section.dataset == 0 && section.text.find_first_not_of(" \t\r\n") != std::string::npos;
    });
  }

  [[nodiscard]] bool has_remarks() const {
    return !file_->node_remarks.empty() || !file_->element_remarks.empty() || !file_->group_remarks.empty() ||
           std::any_of(file_->results.begin(), file_->results.end(),
                       [](const Results& results) { return !results.remarks.empty(); });
  }

  static constexpr const char* kCutShort = "the file may be cut short";

  Scanner in_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<Contents> file_ = std::make_shared<Contents>();
  int dataset_ = 0;  // number of the dataset that is being read
  bool is_binary_ = false;
  std::string binary_fields_;
  std::int64_t begin_ = 0;      // first byte of the dataset
  std::string_view head_;       // its first two lines
  std::string_view end_;        // text after the -1 that ended a dataset
  Remarks* remarks_ = nullptr;  // receives the texts of the item that is read
  Index item_ = 0;
  Index line_of_item_ = 0;
  std::size_t columns_ = 0;                           // where the present field of the line ends
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
