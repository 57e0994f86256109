// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// STL, ASCII and binary, as 3D Systems' "StereoLithography Interface Specification" (1989) gives it and
// https://www.loc.gov/preservation/digital/formats/fdd/fdd000504.shtml describes. Each triangle has its own
// three points; equal points become one vertex here, numbered by first appearance.
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace meshorder {
namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::int64_t kTriangleBytes = 50;
constexpr std::string_view kAttribute = "attribute";
constexpr auto kOrder = std::endian::little;

struct StlMetadata : FormatMetadata {
  bool binary = false;
  std::string header;                ///< the 80 bytes of a binary file
  std::vector<std::string> names;    ///< of the solids of an ASCII file, also of empty ones
  std::vector<std::int64_t> labels;  ///< the label of the cells of each solid

  [[nodiscard]] std::vector<std::string> contents() const override {
    std::vector<std::string> result;
    for (const std::string& name : names) {
      if (!name.empty()) result.push_back("the name of the solid '" + name + "'");
    }
    return result;
  }
};

// ---- reading

/// Gives points numbers by first appearance; equal points get the same number. A hash table with open
/// addressing.
class PointTable {
 public:
  explicit PointTable(std::vector<Point>& points) : points_(points), slots_(1024, -1) {}

  Index number_of(const Point& point) {
    if (points_.size() * 2 > slots_.size()) grow();
    std::size_t slot = hash(point) & (slots_.size() - 1);
    while (slots_[slot] >= 0) {
      if (points_[slots_[slot]] == point) return slots_[slot];  // −0 equals 0
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = index_size(points_);
    points_.push_back(point);
    return slots_[slot];
  }

 private:
  static std::size_t hash(const Point& point) {
    std::uint64_t h = 0;
    for (const double x : point) {
      h ^= std::bit_cast<std::uint64_t>(x + 0.0);  // turns −0 into 0
      h *= 0x9e3779b97f4a7c15U;
      h ^= h >> 32U;
    }
    return h;
  }

  void grow() {
    slots_.assign(4 * slots_.size(), -1);
    for (Index i = 0; i < index_size(points_); ++i) {
      std::size_t slot = hash(points_[i]) & (slots_.size() - 1);
      while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = i;
    }
  }

  std::vector<Point>& points_;
  std::vector<Index> slots_;
};

/// Returns the unit normal of a triangle, zero for a degenerate triangle.
Point normal_of(const Point& a, const Point& b, const Point& c) {
  const Point u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Point v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  Point n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
  for (double& x : n) x = x / length + 0.0;  // no −0
  return n;
}

/// Builds the mesh triangle by triangle, and counts normals that contradict their triangles.
struct Builder {
  Mesh mesh;
  PointTable table{mesh.points};
  Index against = 0;

  void add(const Point& normal, const std::array<Point, 3>& corners) {
    std::array<Index, 3> triangle{};
    for (int k = 0; k < 3; ++k) triangle[k] = table.number_of(corners[k]);
    mesh.cells.push_back(Shape::triangle, triangle);
    const Point n = normal_of(corners[0], corners[1], corners[2]);
    if (n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2] < 0) ++against;
  }

  void note(Notes& notes) const {
    if (against == 0) return;
    notes.push_back(fmt::format(
        "the normals of {} triangles point against the order of their corners; they are not kept", against));
  }
};

/// Returns the size in bytes that a binary file has by its own count; −1 if it is too short for a count.
std::int64_t promised_bytes(const Scanner& scanner) {
  const std::string_view all = scanner.all();
  if (all.size() < kHeaderBytes + 4) return -1;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    count |= std::uint32_t{static_cast<unsigned char>(all[kHeaderBytes + i])} << 8 * i;
  }
  return static_cast<std::int64_t>(kHeaderBytes) + 4 + kTriangleBytes * std::int64_t{count};
}

/// Reads the triangles of a binary file up to its end, as VTK does: some programs write a wrong count.
Mesh read_binary(Scanner& scanner, StlMetadata& metadata, Notes& notes) {
  metadata.binary = true;
  metadata.header = scanner.binary_block(kHeaderBytes, "the header");
  const auto stated = scanner.binary<std::uint32_t>("the number of triangles", kOrder);
  const std::int64_t count = scanner.bytes_left() / kTriangleBytes;
  if (count != stated) {
    notes.push_back(
        fmt::format("the file has {} triangles, though its count says {}; all are read", count, stated));
  }
  if (const std::int64_t rest = scanner.bytes_left() % kTriangleBytes; rest > 0)
    notes.push_back(fmt::format("the {} bytes after the last triangle are left out", rest));
  Builder builder;
  if (count > kMaxIndex / 3) {
    scanner.fail_at_byte("more than 715827882 triangles", "split the file");
  }
  std::vector<std::uint16_t> attributes(static_cast<std::size_t>(count));
  builder.mesh.cells.reserve(count, 3 * count);
  for (std::uint16_t& attribute : attributes) {
    std::array<Point, 4> points{};  // the normal and the corners
    for (std::size_t k = 0; k < points.size(); ++k) {
      for (double& x : points[k]) {
        x = scanner.binary<float>("a triangle", kOrder);
        if (k > 0 && !std::isfinite(x))
          scanner.fail_at_byte("a coordinate is not finite", "a finite number is needed");
      }
    }
    attribute = scanner.binary<std::uint16_t>("a triangle", kOrder);
    builder.add(points[0], {points[1], points[2], points[3]});
  }
  if (std::any_of(attributes.begin(), attributes.end(), [](std::uint16_t a) { return a != 0; })) {
    builder.mesh.data.push_back(
        {std::string(kAttribute), Association::cells, 1, std::move(attributes), {}, {}});
  }
  builder.note(notes);
  return std::move(builder.mesh);
}

void expect_word(Scanner& scanner, std::string_view expected) {
  const std::string_view word = scanner.peek_word();
  if (!same_but_for_case(word, expected)) {
    if (!word.empty()) {
      scanner.fail("'" + std::string(expected) + "' is missing", "facets follow facet … outer loop … vertex");
    }
  }
  (void)scanner.word("'" + std::string(expected) + "'");
}

/// Takes "endloop", or "end loop" as some programs write it.
void expect_end(Scanner& scanner, const std::string& part) {
  const bool are_two_words = same_but_for_case(scanner.peek_word(), "end");
  if (are_two_words) (void)scanner.word("'end'");
  expect_word(scanner, are_two_words ? part : "end" + part);
}

void read_facet(Scanner& scanner, Builder& builder) {
  expect_word(scanner, "facet");
  Point normal{0, 0, 0};
  const bool has_normal = !same_but_for_case(scanner.peek_word(), "outer");  // some programs write no normal
  if (has_normal) expect_word(scanner, "normal");
  for (std::size_t k = 0; has_normal && k < normal.size(); ++k) {
    double& x = normal[k];
    // the normal of a degenerate triangle may be anything; words that are not numbers are ignored
    const std::string_view word = scanner.word("a normal");
    if (std::from_chars(word.data(), word.data() + word.size(), x).ec != std::errc{}) x = 0;
  }
  expect_word(scanner, "outer");
  expect_word(scanner, "loop");
  std::array<Point, 3> corners;
  for (Point& corner : corners) {
    expect_word(scanner, "vertex");
    for (double& x : corner) x = scanner.finite("a coordinate");
  }
  expect_end(scanner, "loop");
  expect_end(scanner, "facet");
  builder.add(normal, corners);
}

/// Parses lines on all threads, ahead of the scanner, and takes the facets that are in plain lines.
class FacetLines {
 public:
  explicit FacetLines(Scanner start) : end_(std::move(start)) {}

  /// Adds the facets from the scanner's place on, up to the first one that is not in the seven lines in which
  /// programs write it.
  void take(Scanner& scanner, Builder& builder) {
    while (!scanner.at_end()) {
      while (first_ < count_ && lines_[first_].byte < scanner.byte()) ++first_;
      if (count_ - first_ < kForm.size() && !parse(scanner)) return;
      if (lines_[first_].byte != scanner.byte()) return;
      const std::size_t before = first_;
      for (; is_facet(); first_ += kForm.size()) {
        const Line* const line = &lines_[first_];
        builder.add(line[0].point, {line[2].point, line[3].point, line[4].point});
      }
      if (first_ == before) return;
      if (first_ < count_) {
        scanner.move_to(scanner.at(lines_[first_].byte, lines_[first_].number));
      } else {
        scanner.move_to(end_);
      }
    }
  }

 private:
  enum class Kind : std::uint8_t { facet, loop, vertex, end_loop, end_facet, other };
  static constexpr std::array kForm{Kind::facet,  Kind::loop,     Kind::vertex,   Kind::vertex,
                                    Kind::vertex, Kind::end_loop, Kind::end_facet};

  struct Line {
    std::int64_t byte = 0;    // of its first word
    std::int64_t number = 0;  // of the line
    Kind kind = Kind::other;
    Point point{};
  };

  [[nodiscard]] bool is_facet() const {
    return count_ - first_ >= kForm.size() &&
           std::equal(kForm.begin(), kForm.end(), lines_.begin() + static_cast<std::ptrdiff_t>(first_),
                      [](Kind kind, const Line& line) { return kind == line.kind; });
  }

  /// Parses the next lines; returns whether they are enough for a facet. Does not try again after a failure.
  bool parse(const Scanner& scanner) {
    constexpr std::int64_t kMostLines = 1 << 17;
    constexpr std::size_t kPartBytes = std::size_t{1} << 17;
    if (are_over_) return false;
    lines_.resize(static_cast<std::size_t>(std::min(kMostLines, scanner.bytes_left())));
    end_ = scanner;
    const Index count = read_regular_records(
        end_, index_size(lines_),
        [&](Scanner& in, Index k) {
          Line& line = lines_[static_cast<std::size_t>(k)];
          line.byte = in.byte();
          line.number = in.line();
          line.kind = kind_of(in, line.point);
          in.move_on(in.peek_line().size());
          return true;
        },
        kPartBytes);
    first_ = 0;
    count_ = static_cast<std::size_t>(count);
    are_over_ = count_ < kForm.size();
    return !are_over_;
  }

  static Kind kind_of(Scanner& in, Point& point) {
    const auto take_word = [&](std::string_view expected) {
      const bool is_next = in.peek_word() == expected;
      if (is_next) in.move_on(expected.size());
      return is_next;
    };
    const auto take_point = [&] {
      return std::all_of(point.begin(), point.end(),
                         [&](double& x) { return !in.at_line_end() && in.take_number(x); });
    };
    Kind kind = Kind::other;
    if (take_word("vertex")) {
      const bool is_finite =
          take_point() && std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); });
      if (is_finite) kind = Kind::vertex;
    } else if (take_word("facet")) {
      if (!in.at_line_end() && take_word("normal") && take_point()) kind = Kind::facet;
    } else if (take_word("outer")) {
      if (!in.at_line_end() && take_word("loop")) kind = Kind::loop;
    } else if (take_word("endloop")) {
      kind = Kind::end_loop;
    } else if (take_word("endfacet")) {
      kind = Kind::end_facet;
    }
    return in.at_line_end() ? kind : Kind::other;
  }

  std::vector<Line> lines_;
  std::size_t first_ = 0;  // line that is not taken
  std::size_t count_ = 0;
  Scanner end_;  // after all lines
  bool are_over_ = false;
};

/// Returns the labels of solids: their names if all are distinct integers, else 1, 2, …
std::vector<std::int64_t> labels_of(const std::vector<std::string>& names) {
  std::vector<std::int64_t> labels;
  for (const std::string& name : names) {
    std::int32_t label = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), label);
    if (code != std::errc{} || end != name.data() + name.size()) break;
    labels.push_back(label);
  }
  const std::set<std::int64_t> different(labels.begin(), labels.end());
  if (different.size() != names.size()) {
    labels.resize(names.size());
    std::iota(labels.begin(), labels.end(), 1);
  }
  return labels;
}

Mesh read_ascii(Scanner& scanner, StlMetadata& metadata, Notes& notes) {
  Builder builder;
  FacetLines lines(scanner);
  std::vector<Index> first_cells;
  while (!scanner.at_end()) {
    expect_word(scanner, "solid");
    metadata.names.emplace_back(scanner.rest_of_line());
    first_cells.push_back(builder.mesh.cells.size());
    const auto is_at_end = [&] {
      const std::string_view word = scanner.peek_word();
      return same_but_for_case(word, "endsolid") || same_but_for_case(word, "end");
    };
    for (lines.take(scanner, builder); !is_at_end(); lines.take(scanner, builder))
      read_facet(scanner, builder);
    expect_end(scanner, "solid");
    (void)scanner.rest_of_line();
  }
  Mesh& mesh = builder.mesh;
  metadata.labels = labels_of(metadata.names);
  if (metadata.names.size() > 1 || std::to_string(metadata.labels[0]) == metadata.names[0]) {
    std::vector<std::int32_t> labels(mesh.cells.shapes.size());
    for (std::size_t s = 0; s < first_cells.size(); ++s) {
      std::fill(labels.begin() + first_cells[s], labels.end(), static_cast<std::int32_t>(metadata.labels[s]));
      const Index end = s + 1 < first_cells.size() ? first_cells[s + 1] : mesh.cell_count();
      if (end > first_cells[s]) mesh.cell_blocks.push_back(first_cells[s]);
    }
    if (mesh.cell_blocks.size() == 1) mesh.cell_blocks.clear();
    mesh.data.push_back({std::string(kLabel), Association::cells, 1, std::move(labels), {}, {}});
  }
  builder.note(notes);
  return std::move(mesh);
}

Mesh read_stl(const FilePath& path, Notes& notes) {
  Scanner scanner(path);
  if (const Scanner bytes = scanner.of_all_bytes(); promised_bytes(bytes) == std::ssize(bytes.all()))
    scanner = bytes;
  auto metadata = std::make_shared<StlMetadata>();
  const auto size = static_cast<std::int64_t>(scanner.all().size());
  const std::int64_t promised = promised_bytes(scanner);
  Mesh mesh;
  // a binary header may begin with "solid" as well, so the size decides
  const bool is_text = promised != size && scanner.all().find('\0') == std::string_view::npos;
  if (is_text && same_but_for_case(scanner.peek_word(), "solid")) {
    mesh = read_ascii(scanner, *metadata, notes);
  } else if (!is_text && promised >= 0 && promised <= size) {
    mesh = read_binary(scanner, *metadata, notes);
  } else if (promised < 0 || is_text) {
    throw InputError(scanner.file(), "is not an STL file: it does not begin with 'solid' and is not binary",
                     "give an ASCII or binary STL file");
  } else {
    throw InputError(Location{scanner.file(), 0, static_cast<std::int64_t>(kHeaderBytes)},
                     fmt::format("a binary STL file of {} triangles has {} bytes, this has {}",
                                 (promised - 84) / kTriangleBytes, promised, size),
                     "the file is cut short, or its count is wrong");
  }
  mesh.format_metadata = std::move(metadata);
  return mesh;
}

// ---- writing

bool stl_holds(const Mesh& /*mesh*/, Shape shape, int vertices) {
  return shape == Shape::triangle && vertices == 3;
}

const DataArray* binary_attribute(const Mesh& mesh, const StlMetadata* metadata) {
  if (!metadata || !metadata->binary) return nullptr;
  const DataArray* array = find_array(mesh, kAttribute, Association::cells);
  const bool fits = array && array->is_dense() && array->components == 1 &&
                    std::holds_alternative<std::vector<std::uint16_t>>(array->values);
  return fits ? array : nullptr;
}

/// Returns the labels of all cells, which become the solids of an ASCII file; empty if the mesh has none.
std::vector<std::int64_t> solid_labels(const Mesh& mesh) {
  const DataArray* array = find_array(mesh, kLabel, Association::cells);
  if (!array || !array->is_dense() || array->components != 1) return {};
  if (const auto* small = std::get_if<std::vector<std::int32_t>>(&array->values))
    return {small->begin(), small->end()};
  if (const auto* large = std::get_if<std::vector<std::int64_t>>(&array->values)) return *large;
  return {};
}

void note_losses(const Mesh& mesh, const DataArray* attribute, bool has_solids, Notes& notes) {
  notes.emplace_back(
      "STL has no vertex order: readers number vertices by first appearance and take equal points as one");
  std::vector<bool> used(mesh.points.size(), false);
  for (const Index v : mesh.cells.vertices) used[v] = true;
  const auto unused = std::count(used.begin(), used.end(), false);
  if (unused > 0) notes.push_back(fmt::format("vertices without cells are not written: {}", unused));
  for (const DataArray& array : mesh.data) {
    const bool is_label = has_solids && array.association == Association::cells && array.name == kLabel;
    if (&array != attribute && !is_label) note_array_unsupported(array, "STL", notes);
  }
  for (const EntitySet& set : mesh.sets) note_set_unsupported(set, "STL", notes);
  note_ids_unsupported(mesh, "STL", notes);
  if (!dynamic_cast<const StlMetadata*>(mesh.format_metadata.get()))
    note_metadata_unsupported(mesh, "STL", notes);
}

void write_binary(const Mesh& mesh, const StlMetadata& metadata, const DataArray* attribute, OutputFile& out,
                  Notes& notes) {
  out.write(metadata.header);
  out.binary(static_cast<std::uint32_t>(mesh.cell_count()), kOrder);
  bool rounded = false;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto t = mesh.cells[c];
    const std::array<Point, 4> points{normal_of(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]),
                                      mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
    for (std::size_t k = 0; k < points.size(); ++k) {
      for (const double x : points[k]) {
        const auto single = static_cast<float>(x);
        rounded = rounded || (k > 0 && static_cast<double>(single) != x);
        out.binary(single, kOrder);
      }
    }
    out.binary(attribute ? std::get<std::vector<std::uint16_t>>(attribute->values)[c] : std::uint16_t{0},
               kOrder);
  }
  if (rounded) notes.emplace_back("coordinates are rounded to 32 bits, as binary STL has them");
}

void add_facet(Text& text, const Mesh& mesh, Index cell) {
  const auto t = mesh.cells[cell];
  const Point n = normal_of(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
  const auto add_point = [&](std::string_view before, const Point& point) {
    text.real(before, point[0]);
    text.real(" ", point[1]);
    text.real(" ", point[2]);
  };
  add_point("facet normal ", n);
  text.write("\n  outer loop\n");
  for (const Index v : t) {
    add_point("    vertex ", mesh.points[v]);
    text.write("\n");
  }
  text.write("  endloop\nendfacet\n");
}

void write_solid(const Mesh& mesh, const std::string& name, const std::vector<Index>& cells,
                 OutputFile& out) {
  const std::string title = name.empty() ? "" : " " + name;
  out.print("solid{}\n", title);
  write_rows(out, index_size(cells), [&](Text& text, Index i) { add_facet(text, mesh, cells[i]); });
  out.print("endsolid{}\n", title);
}

void write_ascii(const Mesh& mesh, const StlMetadata* metadata, const std::vector<std::int64_t>& labels,
                 OutputFile& out) {
  std::map<std::int64_t, std::vector<Index>> by_label;
  for (Index c = 0; c < mesh.cell_count(); ++c) by_label[labels.empty() ? 0 : labels[c]].push_back(c);
  // the solids of the file in their order, then solids of other labels
  if (metadata && metadata->names.size() == 1 && labels.empty()) {
    return write_solid(mesh, metadata->names[0], by_label[0], out);
  }
  for (std::size_t s = 0; metadata && s < metadata->names.size(); ++s) {
    write_solid(mesh, metadata->names[s], by_label[metadata->labels[s]], out);
    by_label.erase(metadata->labels[s]);
  }
  for (const auto& [label, cells] : by_label) {
    write_solid(mesh, labels.empty() ? "" : std::to_string(label), cells, out);
  }
}

void write_stl(const Mesh& mesh, const FilePath& path, Notes& notes) {
  // meshes of other formats are written as text, which keeps every bit
  const auto* metadata = dynamic_cast<const StlMetadata*>(mesh.format_metadata.get());
  const DataArray* attribute = binary_attribute(mesh, metadata);
  const bool binary = metadata && metadata->binary;
  const std::vector<std::int64_t> labels = binary ? std::vector<std::int64_t>{} : solid_labels(mesh);
  OutputFile out(path);
  if (binary) {
    write_binary(mesh, *metadata, attribute, out, notes);
  } else {
    write_ascii(mesh, metadata, labels, out);
  }
  out.commit();
  note_losses(mesh, attribute, !labels.empty(), notes);
}

}  // namespace

Format stl_format() { return {"STL", {".stl"}, false, read_stl, write_stl, stl_holds}; }

}  // namespace meshorder
