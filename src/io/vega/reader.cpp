// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/named_parts.hpp"
#include "io/names.hpp"
#include "io/stream/id_map.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/scanner.hpp"
#include "io/vega/parts.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <utility>

namespace meshorder::vega {
namespace {

constexpr std::string_view kMarks = ",";

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

/// The lines of a Vega file, with those of included files in place, without comments and blank lines.
class Lines {
 public:
  explicit Lines(const FilePath& path) : main_(path) { open(path); }

  /// Sets `line` to the next line, trimmed, without taking it; returns false at the end. The line is valid
  /// until the next peek.
  bool peek(std::string_view& line) {
    while (true) {
      Scanner& file = at();
      if (file.bytes_left() == 0) {
        if (files_.size() == 1) return false;
        files_.pop_back();
        continue;
      }
      line = trimmed(file.peek_line());
      if (line.empty() || line.front() == '#') {
        if (!line.empty()) comments_ += std::string(line) + "\n";
        take();
        continue;
      }
      std::string_view rest = line;
      if (!same_but_for_case(next_word(rest), "*INCLUDE")) return true;
      include(std::string(trimmed(rest)));
    }
  }
  void take() { (void)at().raw_line(); }

  /// Returns the scanner of the current file; errors report its position.
  [[nodiscard]] Scanner& at() { return *files_.back().scanner; }

  /// Returns the comments since the last call, whole lines.
  std::string take_comments() { return std::exchange(comments_, {}); }

  /// Returns the names of the files included so far.
  [[nodiscard]] const std::vector<std::string>& included() const noexcept { return included_; }

 private:
  struct OpenFile {
    FilePath path;
    std::unique_ptr<Scanner> scanner;
  };

  void open(const FilePath& path) { files_.push_back({path, std::make_unique<Scanner>(path)}); }

  void include(const std::string& name) {
    if (name.empty()) at().fail("*INCLUDE names no file", "write *INCLUDE and a file name");
    // beside the including file, or else, as Vega itself does, beside the main file
    FilePath path = files_.back().path.beside(name);
    if (!path.exists()) path = main_.beside(name);
    if (!may_include(main_, path)) {
      at().fail("the included file '" + name + "' is not in the mesh's folder", kIncludeRemedy);
    }
    if (!path.is_file()) {
      at().fail("the included file '" + name + "' does not exist", "put it beside this file");
    }
    for (const OpenFile& file : files_) {
      if (file.path.is_same(path)) {
        at().fail("the included file '" + name + "' includes itself", "remove the circle");
      }
    }
    constexpr std::size_t kMostNested = 16;
    if (files_.size() > kMostNested) at().fail("files are included more than 16 deep", "join some of them");
    constexpr std::size_t kMost = 10000;
    if (included_.size() == kMost) at().fail("more than 10000 files are included", "join them");
    included_.push_back(name);
    take();
    if (!path.is_empty()) open(path);
  }

  FilePath main_;
  std::vector<OpenFile> files_;
  std::string comments_;
  std::vector<std::string> included_;
};

class Reader {
 public:
  Reader(const FilePath& path, Notes& notes) : lines_(path), notes_(notes) {
    if (lines_.at().all().find('\0') != std::string_view::npos) {
      throw InputError(path.string(), "is a binary Vega file", "save it as text (.veg)");
    }
  }

  Mesh read() {
    std::string_view line;
    while (lines_.peek(line)) {
      if (line.front() != '*') {
        lines_.at().fail("a section must begin here", "sections begin with *VERTICES, *ELEMENTS, *SET …");
      }
      read_section(line);
    }
    metadata_->closing_comments = lines_.take_comments();
    if (!has_elements_) {
      lines_.at().fail(std::string("the file has no ") + (has_vertices_ ? "*ELEMENTS" : "*VERTICES"),
                       "it may be cut short");
    }
    if (auto labels = region_numbers(*metadata_, mesh_); !labels.empty())
      mesh_.data.push_back({std::string(kLabel), Association::cells, 1, std::move(labels), {}, {}});
    mesh_.vertex_ids = vertices_.ids_unless_from(metadata_->vertex_base);
    mesh_.cell_ids = elements_.ids_unless_from(metadata_->element_base);
    if (!mesh_.vertex_ids.empty() || !mesh_.cell_ids.empty()) {
      notes_.emplace_back(
          "vertices or elements have their own numbers, by which references name them here; Vega itself "
          "counts lines");
    }
    metadata_->included = lines_.included();
    mesh_.format_metadata = metadata_;
    return std::move(mesh_);
  }

 private:
  void read_section(std::string_view line) {
    VegaSection section;
    section.comments = lines_.take_comments();
    std::string_view name = line;
    const std::string keyword(next_word(name));
    const std::string title(trimmed(name));
    if (same_but_for_case(keyword, "*VERTICES")) {
      section.kind = Kind::vertices;
      read_vertices();
    } else if (same_but_for_case(keyword, "*ELEMENTS")) {
      section.kind = Kind::elements;
      read_elements();
    } else if (same_but_for_case(keyword, "*MATERIAL")) {
      read_material(section, title);
    } else if (same_but_for_case(keyword, "*SET")) {
      read_set(section, title);
    } else if (same_but_for_case(keyword, "*REGION") || same_but_for_case(keyword, "*REGION,")) {
      read_region(section);
    } else {
      read_other(section, std::string(line));
    }
    metadata_->sections.push_back(std::move(section));
  }

  /// Returns the next line, without its comment and without taking it; fails at a keyword or the end.
  std::string_view data_line(const std::string& what) {
    std::string_view line;
    if (!lines_.peek(line)) {
      lines_.at().fail("unexpected end of file; expected " + what, "it may be cut short");
    }
    if (line.front() == '*') {
      lines_.at().fail("expected " + what + ", found " + std::string(line.substr(0, 40)),
                       "lines are missing");
    }
    lines_.take_comments();
    return without_comment(line);
  }

  std::string_view data_line(const std::string& what, Index place, Index count) {
    std::string_view line;
    const bool is_data = lines_.peek(line) && line.front() != '*';
    return data_line(is_data ? what : fmt::format("{} {} of {}", what, place + 1, count));
  }

  std::int64_t integer(std::string_view& line, std::string_view what) {
    return parse_integer<std::int64_t>(lines_.at(), required_word(line, what), what);
  }

  double real(std::string_view& line, std::string_view what) {
    const double value = parse_real(lines_.at(), required_word(line, what), what);
    if (!std::isfinite(value))
      lines_.at().fail(std::string(what) + " is not finite", "a finite number is needed");
    return value;
  }

  std::string_view required_word(std::string_view& line, std::string_view what) {
    const std::string_view word = next_word(line, kMarks);
    if (word.empty()) lines_.at().fail("unexpected end of line; expected " + std::string(what), "add it");
    return word;
  }

  void expect_line_end(std::string_view line, const std::string& what) {
    const std::string_view word = next_word(line, kMarks);
    if (!word.empty()) {
      lines_.at().fail("'" + std::string(word.substr(0, 40)) + "' follows " + what, "remove it");
    }
  }

  /// "n width a b": the number of lines, the number of values in each line, and up to two more numbers.
  struct Header {
    Index count = 0;
    std::array<std::int64_t, 2> columns{};
  };

  Header read_header(const std::string& what, int width) {
    std::string_view line = data_line("the number of " + what);
    Header header;
    const std::int64_t count = integer(line, "the number of " + what);
    // lines may come from an included file, so the bytes left are not a bound
    if (count < 0 || count > kMaxIndex) {
      lines_.at().fail("the number of " + what + " is " + std::to_string(count),
                       "0 to 2147483647 are possible");
    }
    header.count = static_cast<Index>(count);
    if (!trimmed_all(line).empty() && integer(line, "the width") != width) {
      lines_.at().fail("the width of " + what + " is wrong", std::to_string(width) + " is needed");
    }
    for (std::int64_t& columns : header.columns) {
      if (trimmed_all(line).empty()) break;
      columns = integer(line, "the number of attributes");
      if (columns < 0 || columns > 1000) {
        lines_.at().fail("the number of attributes is " + std::to_string(columns), "it is 0 in Vega's files");
      }
    }
    expect_line_end(line, "the header");
    lines_.take();
    return header;
  }

  static std::string_view trimmed_all(std::string_view line) { return next_word(line, kMarks); }

  /// Returns how many items of `width` numbers to reserve: no more than the rest of this file can hold.
  std::size_t reservable(Index count, int width) {
    return static_cast<std::size_t>(
        std::min<std::int64_t>(count, lines_.at().bytes_left() / (2 * width + 2)));
  }

  void add_id(IdMap& numbering, std::int64_t id, const std::string& what) {
    if (id < 0)
      lines_.at().fail(what + " has the number " + std::to_string(id), "numbers must not be negative");
    if (!numbering.add(id)) {
      lines_.at().fail(what + " " + std::to_string(id) + " is given twice", "numbers must differ");
    }
  }

  void read_vertices() {
    if (has_vertices_) lines_.at().fail("a second *VERTICES", "a file has one");
    has_vertices_ = true;
    lines_.take();
    const Header header = read_header("vertices", 3);
    if (header.columns[1] > 1) lines_.at().fail("more than one column of markers", "0 or 1 is possible");
    metadata_->vertex_attributes = static_cast<int>(header.columns[0]);
    metadata_->vertex_markers = header.columns[1] == 1;
    std::vector<double> attributes;
    std::vector<std::int32_t> markers;
    mesh_.points.reserve(reservable(header.count, 3));
    for (Index v = read_plain_vertices(header); v < header.count; ++v) {
      std::string_view line = data_line("vertex", v, header.count);
      add_id(vertices_, integer(line, "the number of a vertex"), "vertex");
      Point point;
      for (double& x : point) x = real(line, "a coordinate");
      mesh_.points.push_back(point);
      for (int a = 0; a < metadata_->vertex_attributes; ++a) attributes.push_back(real(line, "an attribute"));
      if (metadata_->vertex_markers) {
        markers.push_back(
            parse_integer<std::int32_t>(lines_.at(), required_word(line, "a marker"), "a marker"));
      }
      expect_line_end(line, "the vertex");
      lines_.take();
    }
    metadata_->vertex_base = vertices_.find(0) >= 0 ? 0 : 1;
    if (!attributes.empty()) add_attributes(Association::vertices, std::move(attributes));
    if (!markers.empty()) {
      mesh_.data.push_back({std::string(kLabel), Association::vertices, 1, std::move(markers), {}, {}});
    }
  }

  /// Returns whether there are no attributes and markers.
  static bool is_plain(const Header& header) { return header.columns == decltype(header.columns){}; }

  /// Reads vertices on all threads, up to the first line that does not have the next number or holds anything
  /// but numbers. Returns how many it read.
  Index read_plain_vertices(const Header& header) {
    if (!is_plain(header)) return 0;
    mesh_.points.resize(reservable(header.count, 3));
    const auto read = [&](Scanner& in, Index v) {
      return std::ranges::all_of(mesh_.points[v], [&](double& x) { return in.take_finite(x); });
    };
    const Index count = read_numbered_records(lines_.at(), index_size(mesh_.points), vertices_, read, 0);
    mesh_.points.resize(static_cast<std::size_t>(count));
    return count;
  }

  /// As `read_plain_vertices`, for elements; also stops at an element with an unknown vertex.
  Index read_plain_elements(const Header& header, bool tets) {
    const auto width = static_cast<std::size_t>(tets ? 4 : 8);
    if (!is_plain(header)) return 0;
    std::vector<Index>& corners = mesh_.cells.vertices;
    const auto most = static_cast<Index>(reservable(header.count, tets ? 4 : 8));
    corners.resize(width * static_cast<std::size_t>(most));
    const auto read = [&](Scanner& in, Index e) {
      return std::ranges::all_of(std::span(corners).subspan(width * e, width), [&](Index& corner) {
        std::int64_t number = 0;
        if (!in.take_number(number)) return false;
        corner = vertices_.find(number);
        return corner >= 0;
      });
    };
    const Index count = read_numbered_records(lines_.at(), most, elements_, read, 0);
    corners.resize(width * static_cast<std::size_t>(count));
    mesh_.cells.shapes.assign(static_cast<std::size_t>(count), tets ? Shape::tetrahedron : Shape::hexahedron);
    for (Index e = 0; e < count; ++e) {
      mesh_.cells.offsets.push_back(mesh_.cells.offsets.back() + static_cast<Offset>(width));
    }
    return count;
  }

  void add_attributes(Association association, std::vector<double> values) {
    const int width =
        association == Association::vertices ? metadata_->vertex_attributes : metadata_->element_attributes;
    mesh_.data.push_back({std::string(kAttributes), association, width, std::move(values), {}, {}});
  }

  void read_elements() {
    if (has_elements_) lines_.at().fail("a second *ELEMENTS", "a file has one");
    if (!has_vertices_) lines_.at().fail("*ELEMENTS before *VERTICES", "vertices come first");
    has_elements_ = true;
    lines_.take();
    std::string_view word = data_line("the type of the elements");
    const std::string type(next_word(word, kMarks));
    const bool tets = same_but_for_case(std::string_view(type).substr(0, 3), "TET");
    if (!tets && !same_but_for_case(std::string_view(type).substr(0, 5), "CUBIC")) {
      lines_.at().fail("elements of type '" + type.substr(0, 40) + "'", "TET and CUBIC are possible");
    }
    lines_.take();
    metadata_->element_word = type;

    const int width = tets ? 4 : 8;
    const Header header = read_header("elements", width);
    metadata_->element_attributes = static_cast<int>(header.columns[0]);
    std::vector<double> attributes;
    const auto cells = static_cast<Offset>(reservable(header.count, width));
    mesh_.cells.reserve(cells, cells * width);
    std::vector<Index> corners(width);
    for (Index e = read_plain_elements(header, tets); e < header.count; ++e) {
      std::string_view line = data_line("element", e, header.count);
      add_id(elements_, integer(line, "the number of an element"), "element");
      for (Index& corner : corners)
        corner = find(vertices_, integer(line, "a vertex of the element"), "vertex");
      mesh_.cells.push_back(tets ? Shape::tetrahedron : Shape::hexahedron, corners);
      for (int a = 0; a < metadata_->element_attributes; ++a)
        attributes.push_back(real(line, "an attribute"));
      expect_line_end(line, "the element");
      lines_.take();
    }
    metadata_->element_base = elements_.find(0) >= 0 ? 0 : 1;
    if (!attributes.empty()) add_attributes(Association::cells, std::move(attributes));
  }

  Index find(const IdMap& numbering, std::int64_t id, const std::string& what) {
    const Index place = numbering.find(id);
    if (place < 0) {
      lines_.at().fail(what + " " + std::to_string(id) + " does not exist",
                       "there are " + std::to_string(numbering.size()) + " of them");
    }
    return place;
  }

  /// Keeps the lines up to the next keyword.
  void read_lines(VegaSection& section) {
    std::string_view line;
    while (lines_.peek(line) && line.front() != '*') {
      section.lines.emplace_back(line);
      lines_.take();
    }
  }

  void read_material(VegaSection& section, const std::string& name) {
    if (name.empty()) lines_.at().fail("a material has no name", "write *MATERIAL and a name");
    section.kind = Kind::material;
    section.title = name;
    lines_.take();
    (void)data_line("the properties of material '" + name + "'");
    read_lines(section);
    materials_.insert(name);
  }

  void read_set(VegaSection& section, const std::string& name) {
    if (name.empty()) lines_.at().fail("a set has no name", "write *SET and a name");
    if (!has_elements_) lines_.at().fail("*SET before *ELEMENTS", "elements come first");
    section.kind = Kind::set;
    section.set = mesh_.sets.size();
    lines_.take();
    EntitySet set{name, Association::cells, {}};
    std::string_view line;
    while (lines_.peek(line) && line.front() != '*') {
      lines_.take_comments();
      line = without_comment(line);
      for (std::string_view word = next_word(line, kMarks); !word.empty(); word = next_word(line, kMarks)) {
        const auto id = parse_integer<std::int64_t>(lines_.at(), word, "an element of set '" + name + "'");
        set.members.push_back(find(elements_, id, "element"));
      }
      lines_.take();
    }
    drop_repeated(set, notes_);
    sets_.insert(set.name);
    mesh_.sets.push_back(std::move(set));
  }

  void read_region(VegaSection& section) {
    if (!has_elements_) lines_.at().fail("*REGION before *ELEMENTS", "elements come first");
    section.kind = Kind::region;
    lines_.take();
    (void)data_line("the set and material of a region");
    std::string_view line;
    lines_.peek(line);  // the whole line, as names may have a #
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) lines_.at().fail("a region has no comma", "write SET, MATERIAL");
    section.region_set = trimmed(line.substr(0, comma));
    section.region_material = trimmed(line.substr(comma + 1));
    if (!materials_.contains(section.region_material)) {
      lines_.at().fail("material '" + section.region_material + "' does not exist", "define it before");
    }
    if (!sets_.contains(section.region_set) && section.region_set != kAllElements) {
      lines_.at().fail("set '" + section.region_set + "' does not exist", "define it before");
    }
    lines_.take();
  }

  /// Keeps the lines of an unknown section; fails if they have integers, which could name elements or
  /// vertices.
  void read_other(VegaSection& section, const std::string& title) {
    section.title = title;
    const std::int64_t where = lines_.at().line();
    const std::string file = lines_.at().file();
    lines_.take();
    read_lines(section);
    for (const std::string& text : section.lines) {
      std::string_view line = text;
      for (std::string_view word = next_word(line, kMarks); !word.empty(); word = next_word(line, kMarks)) {
        if (word.find_first_not_of("+-0123456789") != std::string_view::npos) continue;
        throw InputError(Location{file, where, -1},
                         "the section " + title.substr(0, 60) +
                             " is unknown and holds whole numbers, which "
                             "could be those of elements",
                         "remove the section");
      }
    }
  }

  Lines lines_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<VegaMetadata> metadata_ = std::make_shared<VegaMetadata>();
  IdMap vertices_;
  IdMap elements_;
  std::set<std::string> materials_;
  std::set<std::string> sets_;
  bool has_vertices_ = false;
  bool has_elements_ = false;
};

}  // namespace

std::vector<std::int32_t> region_numbers(const VegaMetadata& metadata, const Mesh& mesh) {
  // if several regions have the same set, the last one counts
  std::map<std::string_view, std::int32_t> region_of_set;
  std::int32_t number = 0;
  for (const VegaSection& section : metadata.sections) {
    if (section.kind == Kind::region) region_of_set[section.region_set] = ++number;
  }
  if (number == 0) return {};
  std::map<std::int32_t, std::string_view> regions;
  for (const auto& [set, region] : region_of_set) regions.emplace(region, set);
  const NamedParts parts(mesh);
  std::vector<std::int32_t> numbers(mesh.cells.shapes.size(), 0);
  for (const auto& [region, name] : regions) {
    const EntitySet* const set = parts.set(name, Association::cells);
    if (name == kAllElements) {
      std::fill(numbers.begin(), numbers.end(), region);
    } else if (set != nullptr) {
      for (const Index member : set->members) numbers[member] = region;
    }
  }
  return numbers;
}

Mesh read(const FilePath& path, Notes& notes) { return Reader(path, notes).read(); }

}  // namespace meshorder::vega
