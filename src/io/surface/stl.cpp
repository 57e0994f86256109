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
  std::vector<std::string> names;    ///< names of the solids of an ASCII file, also of empty ones
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

/// A hash table, with open addressing, that numbers points by first appearance; equal points share a number.
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

struct Facet {
  Point normal;
  std::array<Point, 3> corners;
};

/// Builds the mesh triangle by triangle, and counts normals that contradict their triangles.
struct Builder {
  Mesh mesh;
  PointTable table{mesh.points};
  Index against = 0;

  void add(const Facet& facet) {
    const auto& [normal, corners] = facet;
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

/// Returns the bytes that a binary file should have by its own count; −1 if it is too short for a count.
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
    builder.add({points[0], {points[1], points[2], points[3]}});
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
  if (word == expected) return scanner.move_on(word.size());
  if (!word.empty() && !same_but_for_case(word, expected))
    scanner.fail("'" + std::string(expected) + "' is missing", "facets follow facet … outer loop … vertex");
  (void)scanner.word("'" + std::string(expected) + "'");
}

/// Takes "endloop", or "end loop" as some programs write it.
void expect_end(Scanner& scanner, const std::string& part) {
  const bool are_two_words = same_but_for_case(scanner.peek_word(), "end");
  if (are_two_words) (void)scanner.word("'end'");
  expect_word(scanner, are_two_words ? part : "end" + part);
}

Facet read_facet(Scanner& scanner) {
  expect_word(scanner, "facet");
  Facet facet{};
  if (!same_but_for_case(scanner.peek_word(), "outer")) {  // some programs write no normal
    expect_word(scanner, "normal");
    for (double& x : facet.normal) {
      if (scanner.take_number(x)) continue;
      // the normal of a degenerate triangle may be anything; words that are not numbers are ignored
      const std::string_view word = scanner.word("a normal");
      if (std::from_chars(word.data(), word.data() + word.size(), x).ec != std::errc{}) x = 0;
    }
  }
  expect_word(scanner, "outer");
  expect_word(scanner, "loop");
  for (Point& corner : facet.corners) {
    expect_word(scanner, "vertex");
    for (double& x : corner) x = scanner.finite("a coordinate");
  }
  expect_end(scanner, "loop");
  expect_end(scanner, "facet");
  return facet;
}

/// Reads the facets of a solid: on all threads while facets have the usual seven lines. A facet of another
/// form sets `are_regular` to false; this facet and all after it are then read one by one.
void read_facets(Scanner& scanner, Builder& builder, bool& are_regular) {
  constexpr Index kLines = 7;  // lines of a facet
  constexpr std::size_t kMostAtOnce = std::size_t{1} << 15;
  constexpr std::size_t kPartBytes = std::size_t{1} << 17;
  const auto is_at_end = [&] {
    const std::string_view word = scanner.peek_word();
    return same_but_for_case(word, "endsolid") || same_but_for_case(word, "end");
  };
  std::vector<Facet> facets(64);  // more if there are many
  while (!is_at_end()) {
    if (!are_regular) {
      builder.add(read_facet(scanner));
      continue;
    }
    const auto read = [&](Scanner& in, Index k) {
      facets[static_cast<std::size_t>(k)] = read_facet(in);
      return true;
    };
    const Index count = read_regular_records(scanner, index_size(facets), read, kPartBytes, kLines);
    for (Index k = 0; k < count; ++k) builder.add(facets[static_cast<std::size_t>(k)]);
    are_regular = count > 0;
    if (count == index_size(facets)) facets.resize(std::min(4 * facets.size(), kMostAtOnce));
  }
}

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
  bool are_regular = true;
  std::vector<Index> first_cells;
  while (!scanner.at_end()) {
    expect_word(scanner, "solid");
    metadata.names.emplace_back(scanner.rest_of_line());
    first_cells.push_back(builder.mesh.cells.size());
    read_facets(scanner, builder, are_regular);
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
                     fmt::format("a binary STL file of {} triangles has {} bytes, this one has {}",
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
      "STL has no vertex order: readers number vertices by first appearance and merge equal points");
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
  text.write("facet normal");
  text.reals(n);
  text.write("\n  outer loop\n");
  for (const Index v : t) {
    text.write("    vertex");
    text.reals(mesh.points[v]);
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
