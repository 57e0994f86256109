// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/scanner.hpp"
#include "io/surface/obj_parts.hpp"
#include "io/surface/surface_data.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

namespace meshorder::obj {
namespace {

/// Names, and the name of each cell.
struct Named {
  std::vector<std::string> names;  ///< by first appearance; `of_cell` numbers them from 1
  std::unordered_map<std::string, std::int32_t> number_of;
  std::int32_t current = 0;
  std::vector<std::int32_t> of_cell;  ///< empty until the first statement

  void set(const std::string& name, Index cells) {
    if (of_cell.empty()) of_cell.assign(cells, 0);
    is_used = true;
    if (name.empty()) {
      current = 0;
      return;
    }
    const auto [found, is_new] = number_of.try_emplace(name, static_cast<std::int32_t>(names.size()) + 1);
    if (is_new) names.push_back(name);
    current = found->second;
  }

  void add_cell() {
    if (is_used) of_cell.push_back(current);
  }

  bool is_used = false;
};

std::optional<std::int32_t> as_integer(const std::string& text) {
  std::int32_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size() || std::to_string(value) != text) return {};
  return value;
}

/// Returns the names by number: their values if all are integers (but for 0 if it means no name), else their
/// alphabetical ranks, which do not depend on the order of cells.
std::map<std::int32_t, std::string> numbered(const Named& named, bool are_numbers) {
  std::map<std::int32_t, std::string> result;
  const bool some_without = std::count(named.of_cell.begin(), named.of_cell.end(), 0) > 0;
  for (const std::string& name : named.names) {
    const auto number = as_integer(name);
    if (!number || (*number == 0 && some_without && !are_numbers)) break;
    result[*number] = name;
  }
  if (result.size() == named.names.size()) return result;
  result.clear();
  const std::set<std::string> sorted(named.names.begin(), named.names.end());
  std::int32_t number = 0;
  for (const std::string& name : sorted) result[++number] = name;
  return result;
}

/// Indices of the corners of cells, grouped by the number of corners of a cell.
struct CornerIndices {
  struct OfWidth {
    std::vector<Index> cells;
    std::vector<std::int32_t> indices;
  };
  std::map<Index, OfWidth> by_width;

  void add(Index cell, const std::vector<std::int32_t>& indices) {
    if (indices.empty()) return;
    OfWidth& of_width = by_width[index_size(indices)];
    of_width.cells.push_back(cell);
    of_width.indices.insert(of_width.indices.end(), indices.begin(), indices.end());
  }
};

/// A list (v, vt or vn), and the highest position that a cell named while the list was still shorter.
struct List {
  std::string_view name;
  Index count = 0;
  Index highest_ahead = -1;
  std::int64_t line_ahead = 0;
};

/// A line. Vertices, faces of at most four corners, texture coordinates and normals are parsed if they hold
/// plain numbers and nothing else.
struct Line {
  enum class Kind : std::uint8_t { vertex, texture, normal, face, other };
  using Corner = std::array<Index, 3>;  ///< v, vt and vn, counted from 1; 0: none

  std::int64_t byte = 0;    ///< position of the line's first word
  std::int64_t number = 0;  ///< number of the line in the file
  Kind kind = Kind::other;
  std::size_t count = 0;          ///< how many numbers or corners the line has
  std::string_view text;          ///< numbers of a texture coordinate or normal
  std::array<double, 6> reals{};  ///< numbers of a vertex
  std::array<Corner, 4> corners{};
};

/// Parses v, v/vt, v//vn or v/vt/vn; returns false for any other word and for numbers below 1.
bool parse_corner(std::string_view word, Line::Corner& corner) {
  const char* at = word.data();
  const char* const end = at + word.size();
  corner = {0, 0, 0};
  for (std::size_t k = 0; k < corner.size(); ++k) {
    if (k > 0) {
      if (at == end) return true;
      if (*at++ != '/') return false;
      if (k == 1 && at != end && *at == '/') continue;
    }
    const auto [after, code] = std::from_chars(at, end, corner[k]);
    if (code != std::errc{} || corner[k] < 1) return false;
    at = after;
  }
  return at == end;
}

/// Takes the numbers up to the end of the line; returns false for anything else and for too many numbers.
bool take_reals(Scanner& in, std::span<double> reals, std::size_t& count) {
  for (count = 0; !in.at_line_end(); ++count) {
    if (count == reals.size() || !in.take_number(reals[count])) return false;
  }
  return true;
}

bool take_corners(Scanner& in, Line& line) {
  for (line.count = 0; !in.at_line_end(); ++line.count) {
    const std::string_view word = in.peek_word();
    if (line.count == line.corners.size() || !parse_corner(word, line.corners[line.count])) return false;
    in.move_on(word.size());
  }
  const auto has_first = [&](std::size_t k) { return line.corners[0][k] > 0; };
  return line.count >= 3 &&
         std::all_of(line.corners.begin(), line.corners.begin() + static_cast<std::ptrdiff_t>(line.count),
                     [&](const Line::Corner& corner) {
                       return (corner[1] > 0) == has_first(1) && (corner[2] > 0) == has_first(2);
                     });
}

/// Parses a line; returns false if its kind is `other`.
bool parse_plain(Scanner& in, Line& line) {
  const std::string_view keyword = in.peek_word();
  in.move_on(keyword.size());
  if (keyword == "f") {
    line.kind = Line::Kind::face;
    return take_corners(in, line);
  }
  if (keyword == "v") {
    line.kind = Line::Kind::vertex;
    return take_reals(in, line.reals, line.count) &&
           (line.count == 3 || line.count == 4 || line.count == 6) &&
           std::all_of(line.reals.begin(), line.reals.begin() + 3, [](double x) { return std::isfinite(x); });
  }
  if (keyword != "vt" && keyword != "vn") return false;
  line.kind = keyword == "vt" ? Line::Kind::texture : Line::Kind::normal;
  if (!take_reals(in, line.reals, line.count)) return false;
  line.text = trimmed(
      in.all().substr(static_cast<std::size_t>(line.byte), static_cast<std::size_t>(in.byte() - line.byte)));
  return line.count == 3 || (line.kind == Line::Kind::texture && (line.count == 1 || line.count == 2));
}

void parse(Scanner& in, Line& line) {
  line.byte = in.byte();
  line.number = in.line();
  if (parse_plain(in, line)) return;
  line.kind = Line::Kind::other;
  in.move_on(in.peek_line().size());
}

class Reader {
 public:
  explicit Reader(const FilePath& path) : scanner_(path) {}

  Mesh read() {
    while (scanner_.bytes_left() > 0) {
      if (!read_lines()) read_statement();
    }
    for (const List& list : {vertices_, texture_, normals_}) check_ahead(list);
    add_vertex_arrays();
    add_corner_arrays("texture", texture_indices_);
    add_corner_arrays("normal", normal_indices_);
    add_states();
    add_groups();
    mesh_.format_metadata = metadata_;
    return std::move(mesh_);
  }

 private:
  /// Reads many lines: parses them on all threads, then adds those that are parsed, and reads each other
  /// line as a statement. Returns false if it read none.
  bool read_lines() {
    constexpr std::int64_t kMostLines = 1 << 16;
    constexpr std::size_t kPartBytes = std::size_t{1} << 16;
    if (!are_regular_) return false;
    lines_.resize(static_cast<std::size_t>(std::min(kMostLines, scanner_.bytes_left())));
    Scanner end = scanner_;
    const Index count = read_regular_records(
        end, index_size(lines_),
        [&](Scanner& in, Index k) {
          parse(in, lines_[static_cast<std::size_t>(k)]);
          return true;
        },
        kPartBytes);
    are_regular_ = count > 0;
    for (const Line& line : std::span(lines_).first(static_cast<std::size_t>(count))) {
      if (line.byte < scanner_.byte() || add(line)) continue;  // in a joined line, or added
      scanner_.move_to(scanner_.at(line.byte, line.number));
      read_statement();
    }
    if (scanner_.byte() < end.byte()) scanner_.move_to(end);
    return are_regular_;
  }

  /// Adds a line; returns false if it must be read as a statement.
  bool add(const Line& line) {
    switch (line.kind) {
      case Line::Kind::vertex:
        add_vertex(line.reals, line.count);
        return true;
      case Line::Kind::texture:
        add_listed(line.text, texture_, metadata_->texture);
        return true;
      case Line::Kind::normal:
        add_listed(line.text, normals_, metadata_->normals);
        return true;
      case Line::Kind::face:
        return add_face(std::span(line.corners).first(line.count));
      case Line::Kind::other:
        break;
    }
    return false;
  }

  /// Adds a face. Returns false if a corner names a list entry that comes later in the file.
  bool add_face(std::span<const Line::Corner> corners) {
    const std::array lists{vertices_.count, texture_.count, normals_.count};
    const std::array indices{&corners_, &corner_texture_, &corner_normals_};
    for (std::size_t k = 0; k < lists.size(); ++k) {
      indices[k]->clear();
      if (corners[0][k] == 0) continue;
      for (const Line::Corner& corner : corners) {
        if (corner[k] > lists[k]) return false;
        indices[k]->push_back(corner[k] - 1);
      }
    }
    add_cell(2);
    return true;
  }

  /// Reads one line, or several joined by backslashes. Takes the line last: errors then name its number.
  void read_statement() {
    std::string_view line = trimmed(scanner_.peek_line());
    if (!line.empty() && line.back() == '\\') return read_long_statement();
    read_line(line);
    (void)scanner_.raw_line();
  }

  void read_long_statement() {
    // the lines are collected ahead of the scanner, which stays at the first line until all is read
    std::string joined;
    int lines = 0;
    for (std::string_view left = scanner_.all().substr(scanner_.byte()); !left.empty(); ++lines) {
      const std::size_t length = std::min(left.find_first_of("\r\n"), left.size());
      std::string_view line = trimmed(left.substr(0, length));
      const bool goes_on = !line.empty() && line.back() == '\\';
      if (goes_on) line.remove_suffix(1);
      joined.append(line).append(" ");
      left.remove_prefix(std::min(length + (left.substr(length).starts_with("\r\n") ? 2 : 1), left.size()));
      if (!goes_on) {
        ++lines;
        break;
      }
    }
    // a backslash that joins nothing has no meaning, and must not end the line when it is written
    std::string_view line = trimmed(joined);
    while (line.ends_with('\\')) line = trimmed(line.substr(0, line.size() - 1));
    read_line(line);
    for (; lines > 0; --lines) (void)scanner_.raw_line();
  }

  void read_line(std::string_view line) {
    if (line.empty()) return;
    if (line.front() == '#') {
      metadata_->comments.append(line).append("\n");
      return;
    }
    std::string_view rest = line;
    const std::string_view keyword = next_word(rest);
    const std::string_view numbers = rest.substr(0, rest.find('#'));
    if (keyword == "v") return read_vertex(numbers);
    if (keyword == "vt") return read_listed(line, numbers, 1, 3, texture_, metadata_->texture);
    if (keyword == "vn") return read_listed(line, numbers, 3, 3, normals_, metadata_->normals);
    if (keyword == "f") return read_cell(numbers, 2);
    if (keyword == "l") return read_cell(numbers, 1);
    if (keyword == "p") return read_cell(numbers, 0);
    if (keyword == "g") return read_group(rest);
    for (std::size_t i = 0; i < kStates.size(); ++i) {
      if (keyword == kStates[i].keyword) return read_state(i, trimmed(rest));
    }
    for (const std::string_view library : {"mtllib", "maplib", "shadow_obj", "trace_obj"}) {
      if (keyword != library) continue;
      metadata_->libraries.append(line).append("\n");
      return;
    }
    refuse(keyword);
  }

  [[noreturn]] void refuse(std::string_view keyword) const {
    for (const std::string_view word :
         {"vp",   "cstype", "deg", "bmat", "step",  "curv",  "curv2", "surf", "parm", "trim", "hole",
          "scrv", "sp",     "end", "con",  "ctech", "stech", "bsp",   "bzp",  "cdc",  "cdp",  "res"}) {
      if (keyword == word) {
        scanner_.fail("free-form geometry ('" + std::string(keyword) + "') is not read",
                      "convert it to faces");
      }
    }
    std::string shown;
    for (const char c : keyword.substr(0, 40)) shown += c >= ' ' && c < 127 ? c : '?';
    scanner_.fail("the statement '" + shown + "' is unknown",
                  "v, vt, vn, f, l, p, g, o, s, usemtl … are supported");
  }

  void read_vertex(std::string_view line) {
    std::array<double, 6> numbers{};
    std::size_t count = 0;
    for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
      if (count == numbers.size())
        scanner_.fail("a vertex has more than 6 numbers", "give x y z, x y z w or x y z r g b");
      numbers[count] = parse_real(scanner_, word, count < 3 ? "a coordinate" : "a weight or colour");
      if (count < 3 && !std::isfinite(numbers[count]))
        scanner_.fail("a coordinate is not finite", "a finite number is needed");
      ++count;
    }
    if (count < 3 || count == 5) {
      scanner_.fail("a vertex has " + std::to_string(count) + " numbers",
                    "give x y z, x y z w or x y z r g b");
    }
    add_vertex(numbers, count);
  }

  /// Adds a vertex of 3, 4 or 6 numbers.
  void add_vertex(const std::array<double, 6>& numbers, std::size_t count) {
    const Index v = vertices_.count++;
    mesh_.points.push_back({numbers[0], numbers[1], numbers[2]});
    if (count == 4) {
      weighted_.push_back(v);
      weights_.push_back(numbers[3]);
    } else if (count == 6) {
      colored_.push_back(v);
      colors_.insert(colors_.end(), numbers.begin() + 3, numbers.end());
    }
  }

  /// Reads a line of vt or vn, kept verbatim.
  void read_listed(std::string_view line, std::string_view numbers, int least, int most, List& list,
                   std::string& text) {
    int count = 0;
    for (auto word = next_word(numbers); !word.empty(); word = next_word(numbers)) {
      (void)parse_real(scanner_, word, "a number of " + std::string(list.name));
      ++count;
    }
    if (count < least || count > most) {
      scanner_.fail(fmt::format("a line {} has {} numbers", list.name, count),
                    least == most ? fmt::format("{} are needed", least)
                                  : fmt::format("{} to {} are needed", least, most));
    }
    add_listed(line, list, text);
  }

  static void add_listed(std::string_view line, List& list, std::string& text) {
    text.append(line).append("\n");
    ++list.count;
  }

  /// Returns the position, from 0, for a number that counts entries from 1 or, if negative, back from the
  /// last.
  Index place(std::string_view text, List& list) {
    const auto number = parse_integer<Index>(scanner_, text, "a number of " + std::string(list.name));
    if (number < 0 && -static_cast<std::int64_t>(number) <= list.count) return list.count + number;
    if (number <= 0) fail_missing(list, number);
    if (number > list.count && number - 1 > list.highest_ahead) {
      list.highest_ahead = number - 1;
      list.line_ahead = scanner_.line();
    }
    return number - 1;
  }

  [[noreturn]] void fail_missing(const List& list, Index number) const {
    scanner_.fail(fmt::format("{} {} does not exist", list.name, number),
                  fmt::format("there are {} so far, counted from 1 or back from -1", list.count));
  }

  /// Throws if a cell named a position that the whole list does not have.
  void check_ahead(const List& list) const {
    if (list.highest_ahead < list.count) return;
    throw InputError(Location{scanner_.file(), list.line_ahead, -1},
                     fmt::format("{} {} does not exist", list.name, list.highest_ahead + 1),
                     fmt::format("there are {}, counted from 1", list.count));
  }

  /// Reads a corner: v, v/vt, v//vn or v/vt/vn. Some programs end v and v/vt in slashes.
  void read_corner(std::string_view corner) {
    const auto until_slash = [&] {
      const std::string_view part = corner.substr(0, corner.find('/'));
      corner.remove_prefix(std::min(corner.size(), part.size() + 1));
      return part;
    };
    corners_.push_back(place(until_slash(), vertices_));
    const std::string_view texture = until_slash();
    if (!texture.empty()) corner_texture_.push_back(place(texture, texture_));
    if (!corner.empty()) corner_normals_.push_back(place(corner, normals_));
  }

  void read_cell(std::string_view line, int dimension) {
    const std::string_view corners = trimmed(line);
    corners_.clear();
    corner_texture_.clear();
    corner_normals_.clear();
    for (auto word = next_word(line); !word.empty(); word = next_word(line)) read_corner(word);
    const std::size_t least = static_cast<std::size_t>(dimension) + 1;
    if (corners_.size() < least) {
      constexpr std::array<std::string_view, 3> kKinds{"point", "line", "face"};
      const std::size_t count = corners_.size();
      std::string remedy = fmt::format("it needs {} or more", least);
      if (count > 0) {
        remedy += fmt::format(", and a {} is written as '{} {}'", kKinds[count - 1], count == 1 ? 'p' : 'l',
                              shown(corners));
      }
      scanner_.fail(fmt::format("a {} has {} corner{}", kKinds[least - 1], count, count == 1 ? "" : "s"),
                    remedy);
    }
    for (const auto* indices : {&corner_texture_, &corner_normals_}) {
      if (!indices->empty() && indices->size() != corners_.size()) {
        scanner_.fail("corners of one cell have different numbers of indices", "write all corners alike");
      }
    }
    add_cell(dimension);
  }

  /// Adds a cell with the corners in `corners_`.
  void add_cell(int dimension) {
    const Index cell = mesh_.cell_count();
    mesh_.cells.push_back(shape(dimension, corners_.size()), corners_);
    texture_indices_.add(cell, corner_texture_);
    normal_indices_.add(cell, corner_normals_);
    groups_.add_cell();
    for (Named& state : states_) state.add_cell();
  }

  static Shape shape(int dimension, std::size_t vertices) {
    if (dimension == 0) return vertices == 1 ? Shape::vertex : Shape::poly_vertex;
    if (dimension == 1) return vertices == 2 ? Shape::line : Shape::polyline;
    return vertices == 3 ? Shape::triangle : vertices == 4 ? Shape::quad : Shape::polygon;
  }

  void read_group(std::string_view names) {
    std::string joined;
    for (auto name = next_word(names); !name.empty(); name = next_word(names)) {
      joined.append(joined.empty() ? "" : " ").append(name);
    }
    groups_.set(joined, mesh_.cell_count());
  }

  void read_state(std::size_t i, std::string_view name) {
    std::string text(name);
    if (i == kSmoothing) {
      if (text == "off" || text.empty()) text = "0";
      if (text == "on") text = "1";
      text.erase(0, std::min(text.find_first_not_of('0'), text.size() - 1));
      if (!as_integer(text))
        scanner_.fail("the smoothing group is '" + text.substr(0, 40) + "'", "give a number or off");
    }
    states_[i].set(text, mesh_.cell_count());
  }

  void add_partial(std::string name, Association association, Index components, Values values,
                   std::vector<Index> rows) {
    if (rows.empty()) return;
    const Index all = association == Association::vertices ? mesh_.vertex_count() : mesh_.cell_count();
    if (index_size(rows) == all) rows.clear();
    mesh_.data.push_back({std::move(name), association, components, std::move(values), std::move(rows), {}});
  }

  void add_vertex_arrays() {
    add_partial(std::string(kWeight), Association::vertices, 1, std::move(weights_), std::move(weighted_));
    add_partial(std::string(kColor.name), Association::vertices, 3, std::move(colors_), std::move(colored_));
  }

  void add_corner_arrays(std::string_view what, CornerIndices& indices) {
    for (auto& [width, part] : indices.by_width) {
      add_partial(corner_array(what, width), Association::cells, width, std::move(part.indices),
                  std::move(part.cells));
    }
  }

  void add_states() {
    for (std::size_t i = 0; i < kStates.size(); ++i) {
      Named& state = states_[i];
      if (!state.is_used || (state.names.empty() && i != kSmoothing)) continue;
      metadata_->names[i] = numbered(state, i == kSmoothing);
      std::unordered_map<std::string, std::int32_t> number_of;
      for (const auto& [number, name] : metadata_->names[i]) number_of[name] = number;
      std::vector<std::int32_t> numbers(state.names.size() + 1, 0);
      for (std::size_t k = 0; k < state.names.size(); ++k) numbers[k + 1] = number_of[state.names[k]];
      for (std::int32_t& value : state.of_cell) value = numbers[value];
      if (i == kSmoothing) metadata_->names[i].clear();  // numbers are their own names
      mesh_.data.push_back(
          {std::string(kStates[i].array), Association::cells, 1, std::move(state.of_cell), {}, {}});
    }
  }

  /// Makes a set for each name in g statements, in alphabetical order.
  void add_groups() {
    std::map<std::string, std::vector<Index>> members;
    std::vector<std::vector<std::vector<Index>*>> of_statement(groups_.names.size() + 1);
    for (std::size_t k = 0; k < groups_.names.size(); ++k) {
      std::string_view names = groups_.names[k];
      std::set<std::string> different;
      for (auto name = next_word(names); !name.empty(); name = next_word(names)) different.emplace(name);
      const std::string sorted = fmt::to_string(fmt::join(different, " "));
      if (sorted != groups_.names[k]) metadata_->group_statements.try_emplace(sorted, groups_.names[k]);
      for (const std::string& name : different) of_statement[k + 1].push_back(&members[name]);
    }
    for (Index c = 0; c < index_size(groups_.of_cell); ++c) {
      const auto& sets = of_statement[groups_.of_cell[c]];
      if (sets.size() > 1) claim_memory(sets.size() * sizeof(Index), "items in several groups");
      for (std::vector<Index>* set : sets) set->push_back(c);
    }
    for (auto& [name, cells] : members) mesh_.sets.push_back({name, Association::cells, std::move(cells)});
  }

  Scanner scanner_;
  bool are_regular_ = true;  // the next lines may be parsed on all threads
  std::vector<Line> lines_;  // lines that were parsed ahead
  Mesh mesh_;
  std::shared_ptr<ObjMetadata> metadata_ = std::make_shared<ObjMetadata>();
  List vertices_{"v"};
  List texture_{"vt"};
  List normals_{"vn"};
  std::vector<Index> weighted_;
  std::vector<double> weights_;
  std::vector<Index> colored_;
  std::vector<double> colors_;
  CornerIndices texture_indices_;
  CornerIndices normal_indices_;
  Named groups_;
  std::array<Named, kStates.size()> states_;
  std::vector<Index> corners_;  // corners of the cell that is being read
  std::vector<std::int32_t> corner_texture_;
  std::vector<std::int32_t> corner_normals_;
};

}  // namespace

Mesh read(const FilePath& path, Notes&) { return Reader(path).read(); }

}  // namespace meshorder::obj
