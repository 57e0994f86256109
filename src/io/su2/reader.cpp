// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/labels.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_ends.hpp"
#include "io/su2/su2.hpp"
#include "io/wedges.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <system_error>
#include <unordered_set>
#include <utility>

namespace meshorder::su2 {
namespace {

using SectionKind = Su2Metadata::SectionKind;

constexpr char kComment = '%';

/// Returns whether the value of a keyword is known to name no point or element.
bool is_plain(std::string_view keyword) {
  constexpr std::array<std::string_view, 6> kPlain{"NZONE", "IZONE", "NPERIODIC", "NCHUNK", "AOA", "AOS"};
  return std::find(kPlain.begin(), kPlain.end(), keyword) != kPlain.end() ||
         keyword.starts_with("PERIODIC_") || keyword.starts_with("FFD_");
}

class Su2Reader {
 public:
  Su2Reader(const FilePath& path, Notes& notes) : in_(path, kComment), notes_(notes) {}

  Mesh read() {
    while (in_.bytes_left() > 0) read_line();
    keep_lines();
    check_complete();
    note_missing_line_end(in_, kComment, notes_);
    note_numbers();
    turn_wedges();
    if (mesh_.cell_blocks.size() < 2) mesh_.cell_blocks.clear();
    if (!labels_.empty()) {
      labels_.resize(mesh_.cells.shapes.size(), 0);
      mesh_.data.push_back(
          {std::string(kLabel), Association::cells, 1, label_values(std::move(labels_)), {}, {}});
    }
    mesh_.format_metadata = metadata_;
    return std::move(mesh_);
  }

 private:
  // ---- lines

  /// Sets `keyword_` and `value_` from the next line without taking it. Returns false for a comment or empty
  /// line.
  bool find_keyword() {
    const std::string_view line = in_.peek_line();
    const std::string_view content = trimmed(line.substr(0, line.find(kComment)));
    if (content.empty()) return false;
    const std::size_t equals = content.find('=');
    if (equals == std::string_view::npos) {
      in_.fail(fmt::format("expected a keyword with '=', found '{}'", shown(content)),
               keyword_.empty()
                   ? "the file may not be a mesh of SU2"
                   : fmt::format("the number after {}= may be too small, or {}= is not supported", keyword_,
                                 keyword_));
    }
    keyword_ = upper_case(trimmed(content.substr(0, equals)));
    value_ = trimmed(content.substr(equals + 1));
    return true;
  }

  void read_line() {
    if (!find_keyword()) {
      keep_line();
    } else if (keyword_ == "NDIME") {
      read_dimension();
    } else if (keyword_ == "NELEM") {
      begin_section(SectionKind::elements);
      const Index count = take_count(4);
      (void)in_.raw_line();
      mesh_.cell_blocks.push_back(0);
      read_elements(count, mesh_.dimension, metadata_->numbers_elements);
      elements_ = mesh_.cell_count();
    } else if (keyword_ == "NPOIN") {
      begin_section(SectionKind::points);
      read_points();
    } else if (keyword_ == "NMARK") {
      begin_section(SectionKind::marker_count);
      markers_said_ = take_count(0);
      (void)in_.raw_line();
    } else if (keyword_ == "MARKER_TAG") {
      read_marker();
    } else if (keyword_ == "FFD_SURFACE_POINTS") {
      read_surface_points();
    } else {
      keep_keyword();
    }
  }

  void keep_line() { lines_.append(in_.raw_line()) += '\n'; }

  /// Makes a section of the lines that were kept since the last section.
  void keep_lines() {
    if (!lines_.empty()) metadata_->sections.push_back({SectionKind::verbatim, std::exchange(lines_, {})});
  }

  void begin_section(SectionKind part) {
    if (!sections_seen_.insert(part).second) in_.fail("a second " + keyword_ + "=", "it may appear once");
    if (part != SectionKind::dimension && !sections_seen_.contains(SectionKind::dimension)) {
      in_.fail(keyword_ + "= comes before NDIME=", "NDIME= 2 or NDIME= 3 must come first");
    }
    keep_lines();
    metadata_->sections.push_back({part});
  }

  /// Takes the number of items from the front of `value_`; fails if the file lacks `min_bytes` for each item.
  Index take_count(std::int64_t min_bytes) {
    std::string_view rest = value_;
    const Index count = in_.checked_count(
        parse_integer<std::int64_t>(in_, next_word(rest), "the number after " + keyword_ + "="),
        keyword_ + "=", min_bytes);
    value_ = trimmed(rest);
    return count;
  }

  void keep_keyword() {
    if (keyword_ == "NZONE" && parse_integer<std::int64_t>(in_, value_, "NZONE=") != 1) {
      in_.fail(fmt::format("the file has {} zones", shown(value_)), "give one file for each zone");
    }
    if (keyword_ == "MARKER_ELEMS" || keyword_ == "SEND_RECV") {
      in_.fail(keyword_ + "= has no MARKER_TAG= before it", "the file may be damaged");
    }
    if (!is_plain(keyword_)) notes_.push_back(keyword_ + "= is not known, and its line is kept as it is");
    metadata_->keywords.push_back("SU2's " + keyword_ + "=");
    keep_line();
    // keywords with lines after them: a box's corners or control points, or a periodic marker's centre,
    // angles and translation
    const bool has_lines = keyword_.starts_with("FFD_") || keyword_.starts_with("PERIODIC_");
    while (has_lines && in_.bytes_left() > 0 && in_.peek_line().find('=') == std::string_view::npos) {
      keep_line();
    }
  }

  /// Reads lines that each have a marker's name, a point and its place in the box.
  void read_surface_points() {
    if (!has_points_) in_.fail(keyword_ + "= comes before NPOIN=", "the points must come first");
    keep_lines();
    metadata_->keywords.push_back("SU2's " + keyword_ + "=");
    Su2Metadata::FileSection& section =
        metadata_->sections.emplace_back(Su2Metadata::FileSection{SectionKind::surface_points});
    const Index count = take_count(4);
    (void)in_.raw_line();
    for (Index k = 0; k < count; ++k) {
      if (in_.at_end()) fail_count();
      const std::string_view line = in_.peek_line();
      if (line.find('=') != std::string_view::npos) fail_count();
      std::string_view rest = line;
      (void)next_word(rest);
      const std::string_view number = next_word(rest);
      const auto vertex = parse_integer<std::int64_t>(in_, number, "a point of " + keyword_ + "=");
      if (vertex < 0 || vertex >= mesh_.vertex_count()) {
        in_.fail(fmt::format("a point of {}= is {}", keyword_, vertex),
                 fmt::format("0 to {} are possible", mesh_.vertex_count() - 1));
      }
      const auto begin = static_cast<std::size_t>(number.data() - line.data());
      section.surface_points.push_back({std::string(line.substr(0, begin)), static_cast<Index>(vertex),
                                        std::string(line.substr(begin + number.size()))});
      (void)in_.raw_line();
    }
  }

  void read_dimension() {
    begin_section(SectionKind::dimension);
    mesh_.dimension = parse_integer<std::int32_t>(in_, value_, "NDIME=");
    if (mesh_.dimension != 2 && mesh_.dimension != 3) {
      in_.fail(fmt::format("NDIME= {}", mesh_.dimension), "2 or 3 are possible");
    }
    (void)in_.raw_line();
  }

  // ---- elements and points

  /// Takes the first word of an item's line; fails if a keyword comes instead.
  std::string_view first_word() {
    const std::string_view word = in_.word("a line of " + keyword_ + "=");
    const bool letter = std::isalpha(static_cast<unsigned char>(word.front())) != 0;
    if (letter && in_.peek_line().find('=') != std::string_view::npos) fail_count();
    if (letter && word.find('=') != std::string_view::npos) fail_count();
    return word;
  }

  [[noreturn]] void fail_count() const {
    in_.fail(keyword_ + "= promises more lines than there are", "the count is wrong or lines are missing");
  }

  void expect_more(std::string_view what) {
    if (in_.at_line_end()) in_.fail("the line ends before " + std::string(what), "it may be cut short");
  }

  /// Takes the number at the end of an element's line, if there is one.
  void take_number(const ElementKind& kind, std::int64_t place, bool& numbered) {
    if (in_.at_line_end()) return;
    if (in_.integer<std::int64_t>("the number at the end of the line") != place) has_other_numbers_ = true;
    numbered = true;
    if (!in_.at_line_end()) refuse_nodes(kind);
  }

  /// Fails on a line with more than one number after its nodes; the first of these has been taken.
  [[noreturn]] void refuse_nodes(const ElementKind& kind) const {
    const int numbers = kind.nodes + 1 + in_.words_in_line();
    const auto likely =
        std::find_if(kElementKinds.begin(), kElementKinds.end(), [&](const ElementKind& other) {
          return dimension(other.shape) == dimension(kind.shape) &&
                 (other.nodes == numbers || other.nodes == numbers - 1);
        });
    in_.fail(fmt::format("an element of type {} ({}) has {} nodes, but {} numbers follow the type", kind.type,
                         to_string(kind.shape), kind.nodes, numbers),
             likely == kElementKinds.end()
                 ? "after the nodes one number may follow"
                 : fmt::format("the type may be wrong: {} is a {} of {} nodes", likely->type,
                               to_string(likely->shape), likely->nodes));
  }

  /// Takes the numbers after the coordinates of a point; SU2 does not read them.
  void take_numbers_after_point(Index v) {
    if (in_.at_line_end()) return;
    std::int64_t number = -1;
    if (in_.take_number(number) && in_.at_line_end()) {
      if (number != v) has_other_numbers_ = true;
      metadata_->numbers_points = true;
      return;
    }
    has_more_after_points_ = true;
    while (!in_.at_line_end()) (void)parse_real(in_, in_.word("a number"), "a number after the coordinates");
  }

  /// Takes the line end after the last of `count` items.
  void end_items(Index count) {
    if (count > 0) (void)in_.raw_line();
  }

  static const ElementKind* kind_of_type(std::int32_t type) {
    const auto found = std::ranges::find(kElementKinds, type, &ElementKind::type);
    return found == kElementKinds.end() ? nullptr : &*found;
  }

  void read_elements(Index count, int wanted_dimension, bool& numbered) {
    Cells& cells = mesh_.cells;
    // only the first time: reserving for each of many markers would copy all cells each time
    if (cells.size() == 0) cells.reserve(count, Offset{count} * (wanted_dimension + 1));
    std::array<Index, 8> cell{};
    for (Index c = 0; c < count; ++c) {
      std::int32_t type = 0;
      if (!in_.take_number(type))
        type = parse_integer<std::int32_t>(in_, first_word(), "the type of an element");
      const ElementKind* const kind = kind_of_type(type);
      if (kind == nullptr || dimension(kind->shape) != wanted_dimension) {
        in_.fail(fmt::format("an element of type {} in {}= of a mesh with NDIME= {}", type, keyword_,
                             mesh_.dimension),
                 wanted_dimension == 3   ? "10, 12, 13 and 14 are possible"
                 : wanted_dimension == 2 ? "5 and 9 are possible"
                                         : "3 is possible");
      }
      const auto nodes = static_cast<std::size_t>(kind->nodes);
      for (std::size_t k = 0; k < nodes; ++k) cell[k] = node();
      cells.push_back(kind->shape, {cell.data(), nodes});
      take_number(*kind, c, numbered);
    }
    end_items(count);
  }

  Index node() {
    expect_more("a node of the element");
    const auto number = in_.integer<std::int64_t>("a node of the element");
    const Index last = has_points_ ? mesh_.vertex_count() - 1 : kMaxIndex;
    if (number < 0 || number > last) {
      in_.fail(fmt::format("a node of the element is {}", number),
               has_points_ ? fmt::format("0 to {} are possible", last) : "points are counted from 0");
    }
    if (number > largest_node_) {
      largest_node_ = number;
      line_of_largest_ = in_.line();
    }
    return static_cast<Index>(number);
  }

  void read_points() {
    const Index count = take_count(2 * mesh_.dimension);
    if (!value_.empty()) {
      metadata_->counts_physical_points = true;
      if (parse_integer<std::int64_t>(in_, value_, "the second number after NPOIN=") != count) {
        in_.fail(fmt::format("only {} of the {} points are the file's own", shown(value_), count),
                 "this is one part of a mesh, or has halo points: give the whole mesh");
      }
    }
    (void)in_.raw_line();
    has_points_ = true;
    mesh_.points.resize(count, {0, 0, 0});
    for (Index v = 0; v < count; ++v) {
      Point& point = mesh_.points[v];
      for (std::size_t k = 0; k < static_cast<std::size_t>(mesh_.dimension); ++k) {
        if (k > 0) expect_more("a coordinate");
        if (!in_.take_number(point[k])) {
          point[k] = parse_real(in_, k == 0 ? first_word() : in_.word("a coordinate"), "a coordinate");
        }
        if (!std::isfinite(point[k])) in_.fail("a coordinate is not finite", "a finite number is needed");
      }
      take_numbers_after_point(v);
    }
    end_items(count);
    if (largest_node_ >= count) {
      throw InputError(Location{in_.file(), line_of_largest_, -1},
                       fmt::format("a node of the element is {}", largest_node_),
                       fmt::format("0 to {} are possible", count - 1));
    }
  }

  // ---- markers

  void read_marker() {
    const std::string name = value_;
    if (name.empty()) in_.fail("MARKER_TAG= has no name", "give it one");
    if (name == "SEND_RECEIVE") {
      in_.fail("the marker SEND_RECEIVE belongs to one part of a mesh", "give the whole mesh");
    }
    if (!names_seen_.insert(name).second) in_.fail("a second marker " + shown(name), "names must differ");
    if (!sections_seen_.contains(SectionKind::elements))
      in_.fail("MARKER_TAG= comes before NELEM=", "the elements must come first");
    if (!sections_seen_.contains(SectionKind::marker_count)) begin_section(SectionKind::marker_count);
    keep_lines();
    metadata_->sections.push_back({SectionKind::marker, name});
    (void)in_.raw_line();
    while (in_.bytes_left() > 0 && !find_keyword()) keep_line();
    metadata_->sections.back().comments = std::exchange(lines_, {});
    if (in_.bytes_left() == 0 || keyword_ != "MARKER_ELEMS") {
      in_.fail("the marker " + shown(name) + " has no MARKER_ELEMS=", "it must follow MARKER_TAG=");
    }
    const Index count = take_count(4);
    (void)in_.raw_line();
    const Index first = mesh_.cell_count();
    read_elements(count, mesh_.dimension - 1, metadata_->numbers_marker_elements);
    if (count > 0) mesh_.cell_blocks.push_back(first);
    if (const std::int64_t label = label_of_name(name); label != 0) {
      labels_.resize(first, 0);
      labels_.resize(mesh_.cell_count(), label);
      return;
    }
    EntitySet set{name, Association::cells, {}};
    set.members.reserve(count);
    for (Index c = first; c < mesh_.cell_count(); ++c) set.members.push_back(c);
    mesh_.sets.push_back(std::move(set));
  }

  // ---- the end

  void check_complete() {
    constexpr std::array kNeeded{std::pair{SectionKind::dimension, "NDIME="},
                                 std::pair{SectionKind::elements, "NELEM="},
                                 std::pair{SectionKind::points, "NPOIN="}};
    for (const auto& [part, keyword] : kNeeded) {
      if (sections_seen_.contains(part)) continue;
      throw InputError(in_.file(), "has no " + std::string(keyword),
                       "it may be cut short, or may not be a mesh of SU2");
    }
    if (markers_said_ >= 0 && markers_said_ != index_size(names_seen_)) {
      throw InputError(in_.file(),
                       fmt::format("NMARK= {}, but {} markers follow", markers_said_, names_seen_.size()),
                       "the number is wrong or the file is cut short");
    }
    if (sections_seen_.contains(SectionKind::marker_count)) return;
    metadata_->sections.push_back({SectionKind::marker_count});
    notes_.push_back(in_.file() + " has no NMARK=: if it was cut short, its markers are missing");
  }

  void note_numbers() {
    if (has_more_after_points_) {
      notes_.push_back(in_.file() +
                       ": points have more numbers than coordinates; they are left out, as SU2 "
                       "does not read them");
    }
    if (!has_other_numbers_) return;
    notes_.push_back(in_.file() +
                     ": numbers at the ends of lines are not 0, 1, 2 …; they are ignored, as in SU2");
  }

  /// Puts the nodes of wedges in the mesh's order, unless the file has them in that order.
  void turn_wedges() {
    Cells& cells = mesh_.cells;
    if (std::find(cells.shapes.begin(), cells.shapes.end(), Shape::wedge) == cells.shapes.end()) return;
    WedgeVote vote(mesh_.points);
    for (Index c = 0; c < elements_; ++c) vote.add(cells.shapes[c], cells[c]);
    metadata_->wedges_face_inward = vote.wedges_face_inward();
    if (metadata_->wedges_face_inward) return;
    for (Index c = 0; c < elements_; ++c) {
      if (cells.shapes[c] != Shape::wedge) continue;
      const auto cell = cells[c];
      std::swap(cell[1], cell[2]);
      std::swap(cell[4], cell[5]);
    }
  }

  Scanner in_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<Su2Metadata> metadata_ = std::make_shared<Su2Metadata>();
  std::string keyword_;  // keyword of the last line with a keyword, in capitals
  std::string value_;
  std::string lines_;  // lines to be kept
  std::unordered_set<SectionKind> sections_seen_;
  std::unordered_set<std::string> names_seen_;
  std::vector<std::int64_t> labels_;  // labels of the cells so far; empty if no cell has a label
  Index elements_ = 0;                // number of elements of the highest dimension
  Index markers_said_ = -1;
  std::int64_t largest_node_ = -1;
  std::int64_t line_of_largest_ = 0;
  bool has_points_ = false;
  bool has_other_numbers_ = false;
  bool has_more_after_points_ = false;
};

}  // namespace

std::int64_t label_of_name(std::string_view name) {
  std::int64_t label = 0;
  const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), label);
  return code == std::errc{} && end == name.data() + name.size() && std::to_string(label) == name ? label : 0;
}

Mesh read(const FilePath& path, Notes& notes) { return Su2Reader(path, notes).read(); }

}  // namespace meshorder::su2
