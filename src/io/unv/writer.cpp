// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/labels.hpp"
#include "io/named_parts.hpp"
#include "io/names.hpp"
#include "io/stream/output_file.hpp"
#include "io/unsupported.hpp"
#include "io/unv/unv.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

namespace meshorder::unv {
namespace {

constexpr std::string_view kName = "I-deas";
constexpr std::size_t kLongestGroup = 40;
constexpr std::size_t kLongestLine = 80;
constexpr std::string_view kDelimiter = "-1";         // the line before and after a dataset
constexpr std::int64_t kLargestNumber = 999'999'999;  // a longer number fills its columns
constexpr int kDigitsOfCoordinates = 16;

class Lines {
 public:
  Lines(OutputFile& out, std::string_view line_end) : out_(out), line_end_(line_end) {}

  /// Writes lines as they are. Only the last line of a file may lack its end.
  void text(std::string_view text) {
    out_.write(text);
    is_open_ = !text.empty() && text.back() != '\n' && text.back() != '\r';
  }

  void integer(std::int64_t value, std::size_t width = kWholeWidth) {
    const fmt::format_int digits(value);
    // a number that fills its field would run into the number before
    line_.append(std::max(width, digits.size() + (line_.empty() ? 0 : 1)) - digits.size(), ' ');
    line_.append(digits.data(), digits.size());
  }

  /// Adds a number with `digits` digits after the point, right-aligned in `digits` + 8 columns (+ 9 for 16
  /// digits), or in more columns if the number is longer. Returns whether `digits` digits read back as the
  /// same number. If not and `exact` is true, adds the number with 16 digits instead, which are always
  /// enough.
  bool real(double value, int digits, char exponent = 'E', bool exact = false) {
    const auto width = static_cast<std::size_t>(digits < kDigitsOfCoordinates ? digits + 8 : digits + 9);
    char* end = rounded(value, digits);
    double read = 0;
    std::from_chars(buffer_.data(), end, read);
    if (exact && digits < kDigitsOfCoordinates && read != value) end = rounded(value, kDigitsOfCoordinates);
    const auto size = static_cast<std::size_t>(end - buffer_.data());
    line_.append(std::max<std::size_t>(width, size + 1) - size, ' ');
    std::replace(buffer_.data(), end, 'e', exponent);
    line_.append(buffer_.data(), size);
    return read == value;
  }

  /// Ends the line after `remark`, the text that follows its fields.
  void end_line(std::string_view remark = {}) {
    if (is_open_) out_.write(line_end_);
    is_open_ = false;
    out_.write(line_.append(remark) += line_end_);
    line_.clear();
  }

  void line(std::string_view text) {
    line_ = text;
    end_line();
  }

  void delimiter(std::string_view remark = {}) {
    line_ = "    -1";
    end_line(remark);
  }

  void begin_dataset(int dataset) {
    delimiter();
    integer(dataset, 6);
    end_line();
  }

 private:
  char* rounded(double value, int digits) {
    return std::to_chars(buffer_.data(), buffer_.data() + buffer_.size(), value,
                         std::chars_format::scientific, digits)
        .ptr;
  }

  OutputFile& out_;
  std::string line_end_;
  std::string line_;      // current line
  bool is_open_ = false;  // whether the line before has no end
  std::array<char, 64> buffer_{};
};

/// Returns the file that a mesh can be written into; null if there is none.
const UnvMetadata* file_of(const Mesh& mesh) {
  return own_deck<Contents>(mesh, [](const Contents& file, Index k, Shape shape, int vertices) {
    return kind_of(file.element_fields[k].type, vertices) == ElementKind{shape, vertices};
  });
}

/// Returns the contents of a file for a mesh that came from elsewhere: nodes, then elements.
std::shared_ptr<Contents> plain_contents(const Mesh& mesh) {
  auto file = std::make_shared<Contents>();
  file->sections.push_back({DatasetKind::nodes, kNodes, {}, 0, mesh.vertex_count()});
  file->sections.push_back({DatasetKind::elements, kElements, {}, 0, mesh.cell_count()});
  return file;
}

/// The texts after the fields of an item's lines.
class RemarksOfItem {
 public:
  RemarksOfItem() = default;
  RemarksOfItem(const Remarks& all, Index item) : all_(&all), item_(item) {}

  /// Returns the text of the next line; empty if there is none.
  std::string_view next() {
    if (all_ == nullptr || all_->empty()) return {};
    const auto found = all_->find({item_, line_++});
    return found == all_->end() ? std::string_view() : found->second;
  }

 private:
  const Remarks* all_ = nullptr;
  Index item_ = 0;
  Index line_ = 0;
};

class UnvWriter {
 public:
  UnvWriter(const Mesh& mesh, const FilePath& path, Notes& notes)
      : mesh_(mesh),
        own_(file_of(mesh)),
        plain_(own_ == nullptr ? plain_contents(mesh) : nullptr),
        file_(own_ == nullptr ? *plain_.deck : *own_->deck),
        notes_(notes),
        numbers_(own_ == nullptr ? plain_.new_numbers(mesh, kLargestNumber) : own_->numbers(mesh)),
        labels_(labels_of(mesh, Association::cells)),
        materials_(materials_of(mesh)),
        parts_(mesh),
        out_(path),
        lines_(out_, file_.line_end) {
    keep_numbers(numbers_, kLargestNumber, file_.unknown, path);
  }

  void write() {
    for (const Dataset& section : file_.sections) write(section);
    write_new_groups();
    write_new_results();
    out_.commit();
    if (own_ != nullptr) return;
    note_unfit_ids(mesh_, kName, kLargestNumber, notes_);
    note_metadata_unsupported(mesh_, kName, notes_);
  }

 private:
  void write(const Dataset& section) {
    switch (section.part) {
      case DatasetKind::text:
        return lines_.text(section.text);
      case DatasetKind::nodes:
        return write_nodes(section);
      case DatasetKind::elements:
        return write_elements(section);
      case DatasetKind::groups:
        return write_groups(section);
      case DatasetKind::results:
        return write_results(section);
    }
  }

  /// Writes the first lines of a dataset as they were; in a new file, its number.
  void begin(const Dataset& section) {
    if (section.text.empty()) return lines_.begin_dataset(section.dataset);
    lines_.text(section.text);
  }

  /// Returns the texts of a vertex or cell. `items`: the file's item at each vertex or cell.
  [[nodiscard]] RemarksOfItem remarks_of(const Remarks& all, const std::vector<Index>& items,
                                         Index at) const {
    return {all, own_ == nullptr ? at : items[at]};
  }

  [[nodiscard]] NodeFields fields_of_node(Index v) const {
    return own_ == nullptr ? NodeFields() : file_.node_fields[file_node_[v]];
  }

  void write_nodes(const Dataset& section) {
    begin(section);
    const bool single = section.dataset == kNodesInSingle;
    for (Index v = section.first; v < section.first + section.count; ++v) {
      const NodeFields fields = fields_of_node(v);
      lines_.integer(numbers_.nodes.at(v));
      lines_.integer(fields.system);
      lines_.integer(fields.displacement_system);
      lines_.integer(fields.colour);
      RemarksOfItem remarks = remarks_of(file_.node_remarks, file_node_, v);
      if (!single) lines_.end_line(remarks.next());
      for (const double value : mesh_.points[v]) {
        (void)lines_.real(value, single ? 5 : kDigitsOfCoordinates, file_.exponent, true);
      }
      lines_.end_line(remarks.next());
    }
    lines_.delimiter(section.end);
  }

  [[nodiscard]] ElementFields fields_of_element(Index c) const {
    ElementFields fields;
    if (own_ != nullptr) {
      fields = file_.element_fields[file_element_[c]];
      if (fields.beam[0] != 0) fields.beam[0] = numbers_.nodes.now(fields.beam[0]);  // 0: no node
    } else {
      fields.type = type_of({mesh_.cells.shapes[c], mesh_.cells.vertex_count(c)});
      fields.has_beam = is_beam(fields.type);
    }
    if (labels_.any()) fields.property = labels_.values[c];
    if (!materials_.empty()) fields.material = materials_[c];
    return fields;
  }

  void write_elements(const Dataset& section) {
    begin(section);
    std::vector<std::int64_t> nodes;
    for (Index c = section.first; c < section.first + section.count; ++c) {
      const auto cell = mesh_.cells[c];
      const std::span<const int> order = file_order({mesh_.cells.shapes[c], static_cast<int>(cell.size())});
      nodes.resize(cell.size());
      for (std::size_t k = 0; k < cell.size(); ++k) {
        nodes[k] = numbers_.nodes.at(cell[order.empty() ? k : static_cast<std::size_t>(order[k])]);
      }
      write_element(section, numbers_.elements.at(c), fields_of_element(c), nodes,
                    remarks_of(file_.element_remarks, file_element_, c));
    }
    for (const OtherElement& other : section.others) {
      nodes = other.nodes;
      for (std::int64_t& node : nodes) node = numbers_.nodes.now(node);
      ElementFields fields = other.fields;
      if (fields.beam[0] != 0) fields.beam[0] = numbers_.nodes.now(fields.beam[0]);  // 0: no node
      write_element(section, other.number, fields, nodes, {other.remarks, 0});
    }
    lines_.delimiter(section.end);
  }

  void write_element(const Dataset& section, std::int64_t number, const ElementFields& fields,
                     const std::vector<std::int64_t>& nodes, RemarksOfItem remarks) {
    const Index count = index_size(nodes);
    if (section.dataset == kElementsOfOld) {
      list(std::array<std::int64_t, 8>{number, fields.type, fields.property_table, fields.property,
                                       fields.material_table, fields.material, fields.colour, count},
           &remarks);
    } else {
      list(std::array<std::int64_t, 6>{number, fields.type, fields.property, fields.material, fields.colour,
                                       count},
           &remarks);
    }
    if (fields.has_beam) list(fields.beam, &remarks);
    list(nodes, &remarks);
  }

  /// Writes numbers, 8 on a line, and the next of `remarks` after each line.
  void list(std::span<const std::int64_t> numbers, RemarksOfItem* remarks = nullptr) {
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      lines_.integer(numbers[k]);
      if (k % kWholesOnLine == kWholesOnLine - 1 || k + 1 == numbers.size()) {
        lines_.end_line(remarks == nullptr ? std::string_view() : remarks->next());
      }
    }
  }

  /// Returns the materials of the cells; empty unless the mesh's array of materials has one whole number for
  /// each cell.
  static std::vector<std::int64_t> materials_of(const Mesh& mesh) {
    const DataArray* const array = find_array(mesh, kMaterial, Association::cells);
    if (array == nullptr || array->components != 1 || !array->is_dense()) return {};
    return with_integers(array->values, []<class Value>(const std::vector<Value>& values) {
      std::vector<std::int64_t> result;
      result.reserve(values.size());
      for (const Value value : values) result.push_back(static_cast<std::int64_t>(value));
      return result;
    });
  }

  void add_members(const EntitySet* set, std::vector<std::array<std::int64_t, 4>>& members) {
    if (set == nullptr) return;
    written_.insert(set);
    const std::int64_t code = set->association == Association::vertices ? kNodeCode : kElementCode;
    for (const Index member : set->members) {
      members.push_back({code, numbers_.of(set->association).at(member), 0, 0});
    }
  }

  void write_groups(const Dataset& section) {
    begin(section);
    for (Index g = section.first; g < section.first + section.count; ++g) {
      const Group& group = file_.groups[g];
      std::vector<std::array<std::int64_t, 4>> members;
      const EntitySet* const nodes = parts_.set(group.set, Association::vertices);
      const EntitySet* const elements = parts_.set(group.set, Association::cells);
      // a group is left out if its sets were removed
      const bool is_gone = nodes == nullptr && elements == nullptr && (group.has_nodes || group.has_elements);
      if (is_gone && group.others.empty()) continue;
      add_members(nodes, members);
      add_members(elements, members);
      members.insert(members.end(), group.others.begin(), group.others.end());
      write_group(section.dataset, group.fields, group.name, members, {file_.group_remarks, g});
    }
    lines_.delimiter(section.end);
  }

  void write_group(int dataset, const std::vector<std::int64_t>& fields, std::string_view name,
                   const std::vector<std::array<std::int64_t, 4>>& members, RemarksOfItem remarks) {
    for (const std::int64_t field : fields) lines_.integer(field);
    lines_.integer(index_size(members));
    lines_.end_line(remarks.next());
    lines_.line(name);
    const auto each = static_cast<std::size_t>(numbers_of_member(dataset));
    std::vector<std::int64_t> numbers;
    numbers.reserve(each * members.size());
    for (const auto& member : members) numbers.insert(numbers.end(), member.begin(), member.begin() + each);
    list(numbers, &remarks);
  }

  /// Takes and returns a free name that groups can have. A name equal to the delimiter would end the dataset.
  static std::string name_for(const std::string& given, DistinctNames& taken) {
    const std::string name = plain_name(trimmed(given), " ");  // Gmsh reads only the first word of a name
    if (name.empty()) return taken.take("group");
    return taken.take(name == kDelimiter ? "_" + name : name);
  }

  /// Writes the sets that belong to no group of the file; sets of one name become one group.
  void write_new_groups() {
    DistinctNames taken(kLongestGroup);
    std::int64_t last = 0;
    for (const Group& group : file_.groups) {
      (void)taken.take(group.name);
      last = std::max(last, group.fields[0]);
    }
    bool begun = false;
    for (const EntitySet& set : mesh_.sets) {
      if (written_.contains(&set)) continue;
      std::vector<std::array<std::int64_t, 4>> members;
      const EntitySet* const nodes = parts_.set(set.name, Association::vertices);
      const EntitySet* const elements = parts_.set(set.name, Association::cells);
      if (nodes != nullptr && !written_.contains(nodes)) add_members(nodes, members);
      if (elements != nullptr && !written_.contains(elements)) add_members(elements, members);
      if (!written_.contains(&set)) add_members(&set, members);  // another set of that name
      if (members.empty()) {
        note_set_empty(set, notes_);
        continue;
      }
      const std::string name = name_for(set.name, taken);
      note_renamed_set(set, name, notes_);
      if (!begun) lines_.begin_dataset(dataset_of_groups());
      begun = true;
      write_group(dataset_of_groups(), {++last, 0, 0, 0, 0, 0, 0}, name, members, {});
    }
    if (begun) lines_.delimiter();
  }

  /// Returns the number of the dataset with the groups of the file; without groups, the one that Gmsh writes.
  [[nodiscard]] int dataset_of_groups() const {
    const auto own = std::find_if(file_.sections.begin(), file_.sections.end(),
                                  [](const Dataset& section) { return section.part == DatasetKind::groups; });
    return own == file_.sections.end() ? kGroups : own->dataset;
  }

  static bool holds_integers(const DataArray& array) {
    return with_integers(array.values, []<class Value>(const std::vector<Value>& values) {
      return std::all_of(values.begin(), values.end(), [](Value value) {
        return std::in_range<std::int64_t>(value) && fits_columns(static_cast<std::int64_t>(value));
      });
    });
  }

  void write_results(const Dataset& section) {
    const Results& results = file_.results[section.first];
    const DataArray* const array = parts_.array(results.array, results.association);
    if (array == nullptr || array->components != results.components || are_texts(array->values)) {
      return;
    }
    written_arrays_.insert(array);
    // if values are no longer whole, the dataset gets a new header. The dataset stays in place: the order of
    // datasets decides which step an array belongs to
    if (results.integers && !holds_integers(*array)) return write_result(*array, results.name, 1);
    lines_.text(section.text);
    const bool counts = results.association == Association::cells;
    write_rows(*array, results, counts ? results.components_in_file : 0);
    lines_.delimiter(section.end);
  }

  /// Writes rows: a line with the number of the node or element and, if not 0, `components`; then the values.
  void write_rows(const DataArray& array, const Results& results, std::int64_t components) {
    const FileNumbers& numbers = numbers_.of(array.association);
    const auto width = static_cast<std::size_t>(array.components);
    const std::size_t on_line = results.on_line();
    const std::vector<Index>& items = array.association == Association::vertices ? file_node_ : file_element_;
    bool is_rounded = false;
    with_numbers(array.values, [&]<class Value>(const std::vector<Value>& values) {
      for (Index row = 0; row < row_count(array); ++row) {
        const Index at = array.is_dense() ? row : array.indices[row];
        RemarksOfItem remarks = remarks_of(results.remarks, items, at);
        lines_.integer(numbers.at(at));
        if (components > 0) lines_.integer(components);
        lines_.end_line(remarks.next());
        for (std::size_t k = 0; k < width; ++k) {
          const Value value = values[static_cast<std::size_t>(row) * width + k];
          if (results.integers) {
            lines_.integer(static_cast<std::int64_t>(value));
          } else if (!lines_.real(static_cast<double>(value), results.digits, 'E', own_ != nullptr)) {
            is_rounded = own_ == nullptr;
          }
          if (k % on_line == on_line - 1 || k + 1 == width) lines_.end_line(remarks.next());
        }
      }
    });
    if (is_rounded) {
      notes_.push_back(fmt::format("the values of the array '{}' are rounded to the {} digits that {} keeps",
                                   array.name, results.digits + 1, kName));
    }
  }

  /// Writes the arrays that belong to no dataset of the file.
  void write_new_results() {
    std::int64_t label = 0;
    for (const DataArray& array : mesh_.data) {
      const bool is_field =
          &array == label_array(mesh_, Association::cells) ||
          (array.association == Association::cells && array.name == kMaterial && !materials_.empty());
      if (is_field || written_arrays_.contains(&array)) continue;
      if (are_texts(array.values) || row_count(array) == 0) {
        note_array_unsupported(array, kName, notes_);
        continue;
      }
      const std::string name = name_in_file(array.name);
      note_renamed_array(array, name, notes_);
      write_result(array, name, ++label);
    }
  }

  static std::string name_in_file(const std::string& wanted) {
    std::string name = plain_name(wanted);
    if (trimmed(name).empty()) name = "results";
    if (trimmed(name) == kDelimiter) name = "_" + name;
    return std::string(utf8_prefix(name, kLongestLine));
  }

  /// Writes a dataset with a header of its own.
  void write_result(const DataArray& array, const std::string& name, std::int64_t label) {
    Results results;
    results.integers = holds_integers(array);
    results.digits = 12;
    write_header(array, name, results, label);
    write_rows(array, results, array.association == Association::cells ? array.components : 0);
    lines_.delimiter();
  }

  void write_header(const DataArray& array, const std::string& name, const Results& results,
                    std::int64_t label) {
    /// The codes for values with this number of components.
    struct Meaning {
      Index components;
      int characteristic;
      int type;  ///< code for an unknown result
    };
    constexpr std::array kMeanings{Meaning{1, 1, 94}, Meaning{3, 2, 95}, Meaning{6, 4, 97},
                                   Meaning{9, 5, 98}};
    const auto* const meaning = std::find_if(kMeanings.begin(), kMeanings.end(), [&](const Meaning& known) {
      return known.components == array.components;
    });
    const bool is_known = meaning != kMeanings.end();
    lines_.begin_dataset(kResults);
    list(std::array{label});
    lines_.line(name);
    list(std::array<std::int64_t, 1>{array.association == Association::vertices ? 1 : 2});
    for (int k = 0; k < 5; ++k) lines_.line("NONE");
    // unknown model, static analysis
    list(std::array<std::int64_t, 6>{0, 1, is_known ? meaning->characteristic : 0,
                                     is_known ? meaning->type : 93, results.integers ? 1 : 4,
                                     array.components});
    list(std::array<std::int64_t, 8>{});
    list(std::array<std::int64_t, 2>{});
    for (int record = 0; record < 2; ++record) {
      for (int k = 0; k < 6; ++k) (void)lines_.real(0, 5);
      lines_.end_line();
    }
  }

  const Mesh& mesh_;
  const UnvMetadata* own_;  // null if the mesh comes from elsewhere
  UnvMetadata plain_;       // contents for such a mesh
  const Contents& file_;
  Notes& notes_;
  DeckNumbers numbers_;
  Labels labels_;
  std::vector<std::int64_t> materials_;
  NamedParts parts_;
  OutputFile out_;
  Lines lines_;
  std::vector<Index> file_node_ = numbers_.nodes.items();        // node of the file at each vertex
  std::vector<Index> file_element_ = numbers_.elements.items();  // element of the file at each cell
  std::set<const EntitySet*> written_;
  std::set<const DataArray*> written_arrays_;
};

bool holds(const Mesh& mesh, Shape shape, int vertices) {
  return type_of({shape, vertices}) != 0 || file_of(mesh) != nullptr;
}

void write(const Mesh& mesh, const FilePath& path, Notes& notes) { UnvWriter(mesh, path, notes).write(); }

}  // namespace
}  // namespace meshorder::unv

namespace meshorder {

Format unv_format() {
  return {.name = "UNV",
          .extensions = {".unv", ".uff"},
          .groups_cells_by_type = false,
          .read = unv::read,
          .write = unv::write,
          .holds = unv::holds,
          .first_number = 1,
          .has_numbers = true};
}

}  // namespace meshorder
