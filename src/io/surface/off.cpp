// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Geomview's OFF, http://www.geomview.org/docs/html/OFF.html: [ST][C][N]OFF as text. A vertex may have a
// normal, a colour and texture coordinates. A face may have a colour of 1 (an entry of a colour map), 3 or 4
// numbers: whole numbers from 0 to 255, or real numbers from 0 to 1.
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_rows.hpp"
#include "io/surface/surface_data.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace meshorder {
namespace {

struct OffMetadata : FormatMetadata {
  std::string comments;    ///< whole lines before the counts
  std::int64_t edges = 0;  ///< a count that readers ignore

  [[nodiscard]] std::vector<std::string> contents() const override { return {}; }
};

/// Numbers after the coordinates of a vertex.
struct VertexColumns {
  bool normals = false;
  bool colors = false;
  bool texture = false;
  int color_width = 0;
  bool one_line_each = true;  ///< every vertex has a line of its own
};

// ---- reading

void take_comment_lines(Scanner& scanner, std::string& comments) {
  while (scanner.bytes_left() > 0) {
    const std::string_view line = trimmed(scanner.peek_line());
    if (!line.empty() && line.front() != '#') return;
    if (!line.empty()) comments += std::string(line) + "\n";
    (void)scanner.raw_line();
  }
}

bool is_count(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Reads the optional keyword up to the first count, which may follow without a blank.
VertexColumns read_keyword(Scanner& scanner) {
  VertexColumns layout;
  const std::string_view word = scanner.peek_word();
  if (is_count(word)) return layout;
  std::string_view rest = word;
  const auto take = [&](std::string_view prefix) {
    const bool found = rest.starts_with(prefix);
    if (found) rest.remove_prefix(prefix.size());
    return found;
  };
  layout.texture = take("ST");
  layout.colors = take("C");
  layout.normals = take("N");
  if (take("4") || take("n")) {
    scanner.fail("points have more than three coordinates (4OFF, nOFF)", "only x, y and z are supported");
  }
  if (!take("OFF") || (!rest.empty() && !is_count(rest))) {
    scanner.fail("the file does not begin with OFF", "an OFF file begins with [ST][C][N]OFF");
  }
  scanner.seek(scanner.byte() + static_cast<std::int64_t>(word.size() - rest.size()));
  std::string_view line = scanner.peek_line();
  if (same_but_for_case(next_word(line), "BINARY")) scanner.fail("is a binary OFF file", "save it as text");
  return layout;
}

/// Completes the layout from the first vertex's line: further numbers are a colour of 3 or 4 numbers, even if
/// the keyword has no C.
void measure_vertices(Scanner& scanner, VertexColumns& layout) {
  if (scanner.at_end()) return;
  const int numbers = scanner.words_in_line();
  const int others = 3 + (layout.normals ? 3 : 0) + (layout.texture ? 2 : 0);
  if (numbers == others && !layout.colors) return;
  if (numbers == others + 3 || numbers == others + 4) {
    layout.color_width = numbers - others;
  } else if (numbers < 3 || numbers > others + 4) {
    // the vertices do not have a line each; then a colour has four numbers, as in Geomview
    layout.one_line_each = false;
    layout.color_width = layout.colors ? 4 : 0;
  } else {
    scanner.fail(
        "a vertex has " + std::to_string(numbers) + " numbers",
        std::to_string(others) + (layout.colors ? " and those of a colour are needed" : " are needed"));
  }
}

/// Numbers, and whether all were written as integers.
struct Numbers {
  std::vector<double> values;
  bool integers = true;

  void add(Scanner& scanner, std::string_view what) {
    const std::string_view word = scanner.word(what);
    integers = integers && word.find_first_not_of("+-0123456789") == std::string_view::npos;
    values.push_back(parse_real(scanner, word, what));
  }

  /// Returns whether all values were written as integers and have absolute values below 2·10⁹.
  [[nodiscard]] bool are_integers() const {
    return integers && std::all_of(values.begin(), values.end(), [](double x) { return std::abs(x) < 2e9; });
  }

  /// Returns 32-bit integers if `are_integers`, else real numbers.
  [[nodiscard]] Values typed() && {
    if (are_integers()) return std::vector<std::int32_t>(values.begin(), values.end());
    return std::move(values);
  }
};

void read_vertices(Scanner& scanner, Index count, const VertexColumns& layout, Mesh& mesh) {
  mesh.points.resize(count);
  std::array<Numbers, 3> columns;  // normals, colours, texture coordinates
  const std::array<int, 3> widths{layout.normals ? 3 : 0, layout.color_width, layout.texture ? 2 : 0};
  for (Point& point : mesh.points) {
    const auto expect_more = [&] {
      if (layout.one_line_each && scanner.at_line_end() && scanner.bytes_left() > 0) {
        scanner.fail("a vertex has fewer numbers than the first one", "all need the same number");
      }
    };
    scanner.at_end();  // moves to the next line that holds something
    for (double& x : point) {
      expect_more();
      x = scanner.finite("a coordinate");
    }
    for (std::size_t k = 0; k < columns.size(); ++k) {
      for (int i = 0; i < widths[k]; ++i) {
        expect_more();
        columns[k].add(scanner, "a number of a vertex");
      }
    }
    if (layout.one_line_each && !scanner.at_line_end()) {
      scanner.fail("a vertex has more numbers than the first one", "all need the same number");
    }
  }
  const std::array names{kNormal.name, kColor.name, kTexture.name};
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (widths[k] == 0 || count == 0) continue;
    Values values = k == 1 ? std::move(columns[k]).typed() : Values(std::move(columns[k].values));
    mesh.data.push_back({std::string(names[k]), Association::vertices, widths[k], std::move(values), {}, {}});
  }
}

/// Colours of one width and kind, and the faces that have them.
struct ColorGroup {
  std::vector<Index> rows;
  Numbers numbers;
};

constexpr int kMostColors = 4;
using ColorGroups =
    std::array<ColorGroup, std::size_t{2} * (kMostColors + 1)>;  // index: 2 · width, + 1 for whole numbers

void read_color(Scanner& scanner, Index face, ColorGroups& groups) {
  if (scanner.at_line_end()) return;
  Numbers color;
  while (!scanner.at_line_end()) color.add(scanner, "a colour");
  const std::size_t width = color.values.size();
  if (width == 2 || width > kMostColors) {
    scanner.fail("a face is followed by " + std::to_string(width) + " numbers",
                 "a colour has 1, 3 or 4, and each face a line of its own");
  }
  const bool are_integers = color.are_integers();
  ColorGroup& group = groups[2 * width + (are_integers ? 1 : 0)];
  group.rows.push_back(face);
  group.numbers.integers = are_integers;
  group.numbers.values.insert(group.numbers.values.end(), color.values.begin(), color.values.end());
}

void add_colors(ColorGroups groups, Mesh& mesh) {
  const auto used =
      std::count_if(groups.begin(), groups.end(), [](const auto& g) { return !g.rows.empty(); });
  for (std::size_t i = 0; i < groups.size(); ++i) {
    ColorGroup& group = groups[i];
    if (group.rows.empty()) continue;
    std::string name(kColor.name);
    if (used > 1) name += fmt::format("_{}{}", i % 2 == 1 ? 'i' : 'f', i / 2);
    if (index_size(group.rows) == mesh.cell_count()) group.rows.clear();
    mesh.data.push_back({name,
                         Association::cells,
                         static_cast<Index>(i / 2),
                         std::move(group.numbers).typed(),
                         std::move(group.rows),
                         {}});
  }
}

void read_faces(Scanner& scanner, Index count, Mesh& mesh) {
  mesh.cells.reserve(count, Offset{3} * count);
  ColorGroups colors;
  std::vector<Index> face;
  for (Index f = 0; f < count; ++f) {
    const Index size = scanner.count("the number of a face's vertices", 2);
    if (size == 0) scanner.fail("a face has no vertices", "at least one is needed");
    face.resize(size);
    for (Index& vertex : face) {
      vertex = scanner.integer<Index>("a vertex of a face");
      if (vertex < 0 || vertex >= mesh.vertex_count()) {
        scanner.fail("a face names vertex " + std::to_string(vertex),
                     "there are " + std::to_string(mesh.vertex_count()) + ", counted from 0");
      }
    }
    mesh.cells.push_back(face_shape(size), face);
    read_color(scanner, f, colors);
  }
  add_colors(std::move(colors), mesh);
}

Mesh read_off(const FilePath& path, Notes&) {
  Scanner scanner(path, '#');
  auto metadata = std::make_shared<OffMetadata>();
  take_comment_lines(scanner, metadata->comments);
  VertexColumns layout = read_keyword(scanner);
  if (scanner.at_line_end()) take_comment_lines(scanner, metadata->comments);

  constexpr int kMinVertex = 6;  // "0 0 0" and a line end
  constexpr int kMinFace = 4;    // "1 0" and a line end
  const Index vertices = scanner.count("the number of vertices", kMinVertex);
  const Index faces = scanner.count("the number of faces", kMinFace);
  if (!scanner.at_line_end()) metadata->edges = scanner.integer<std::int64_t>("the number of edges");

  Mesh mesh;
  measure_vertices(scanner, layout);
  read_vertices(scanner, vertices, layout, mesh);
  read_faces(scanner, faces, mesh);
  if (!scanner.at_end()) {
    scanner.fail("unexpected data after " + std::to_string(faces) + " faces", "the counts may be wrong");
  }
  mesh.format_metadata = std::move(metadata);
  return mesh;
}

// ---- writing

/// Returns whether OFF holds a cell. Other readers expect only faces; a mesh from OFF keeps vertices and
/// lines.
bool off_holds(const Mesh& mesh, Shape shape, int vertices) {
  if (shape == Shape::polygon) return vertices >= 3;
  const int least = mesh.format == "off" ? 0 : 2;
  return dimension(shape) >= least && dimension(shape) <= 2 && vertices == corners(shape, 0);
}

/// The arrays of a mesh that the file holds.
struct Content {
  GatheredVector normals;
  GatheredVector colors;
  GatheredVector texture;
  GatheredVector face_colors;
  /// If `face_colors` is empty: for each face, the array and the row of its colour; a null array for a face
  /// without a colour.
  std::vector<std::pair<const DataArray*, Index>> color_rows;
  std::vector<const DataArray*> written;
};

bool is_face_color(const DataArray& array) {
  const bool width_fits = array.components == 1 || array.components == 3 || array.components == 4;
  return array.association == Association::cells && width_fits &&
         (array.name == kColor.name || array.name.starts_with(std::string(kColor.name) + "_")) &&
         !std::holds_alternative<std::vector<std::string>>(array.values);
}

void collect_face_colors(const Mesh& mesh, Content& content) {
  content.face_colors = gather(mesh, kColor, Association::cells);
  if (content.face_colors.width > 0) return;
  content.color_rows.resize(mesh.cells.shapes.size(), {nullptr, 0});
  for (const DataArray& array : mesh.data) {
    if (!is_face_color(array)) continue;
    content.written.push_back(&array);
    for (Index row = 0; row < row_count(array); ++row) {
      content.color_rows[array.is_dense() ? row : array.indices[row]] = {&array, row};
    }
  }
}

Content content_of(const Mesh& mesh) {
  Content content;
  content.normals = gather(mesh, kNormal, Association::vertices);
  content.colors = gather(mesh, kColor, Association::vertices);
  content.texture = gather(mesh, kTexture, Association::vertices);
  collect_face_colors(mesh, content);
  for (const auto* part : {&content.normals, &content.colors, &content.texture, &content.face_colors}) {
    content.written.insert(content.written.end(), part->from.begin(), part->from.end());
  }
  return content;
}

void note_losses(const Mesh& mesh, const Content& content, Notes& notes) {
  for (const DataArray& array : mesh.data) {
    if (std::find(content.written.begin(), content.written.end(), &array) != content.written.end()) continue;
    note_array_unsupported(array, "OFF", notes);
  }
  for (const EntitySet& set : mesh.sets) note_set_unsupported(set, "OFF", notes);
  note_ids_unsupported(mesh, "OFF", notes);
  note_metadata_unsupported(mesh, "OFF", notes);
}

/// Appends a colour; real numbers have a point, as 1 and 1.0 differ in OFF.
void add_color(Text& row, std::span<const double> color, bool integers) {
  for (const double x : color) {
    std::string text = fmt::format("{}", x);
    if (!integers && text.find_first_not_of("+-0123456789") == std::string::npos) text += ".0";
    row.print(" {}", text);
  }
}

void add_face_color(Text& text, const Content& content, Index face) {
  if (content.face_colors.width > 0) {
    return add_color(text, content.face_colors[face], content.face_colors.integers);
  }
  const DataArray* const array = content.color_rows[face].first;
  const Offset row = content.color_rows[face].second;
  if (!array) return;
  with_numbers(array->values, [&](const auto& values) {
    for (Index k = 0; k < array->components; ++k) {
      const auto x = static_cast<double>(values[row * array->components + k]);
      add_color(text, {&x, 1}, are_integers(array->values));
    }
  });
}

void write_off(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const Content content = content_of(mesh);
  const auto* metadata = dynamic_cast<const OffMetadata*>(mesh.format_metadata.get());
  OutputFile out(path);
  out.print("{}{}{}OFF\n", content.texture.width > 0 ? "ST" : "", content.colors.width > 0 ? "C" : "",
            content.normals.width > 0 ? "N" : "");
  if (metadata) out.write(metadata->comments);
  out.print("{} {} {}\n", mesh.vertex_count(), mesh.cell_count(), metadata ? metadata->edges : 0);
  write_rows(out, mesh.vertex_count(), [&](Text& row, Index v) {
    const Point& p = mesh.points[v];
    row.real("", p[0]);
    row.reals(std::span(p).subspan(1));
    if (content.normals.width > 0) row.reals(content.normals[v]);
    if (content.colors.width > 0) add_color(row, content.colors[v], content.colors.integers);
    if (content.texture.width > 0) row.reals(content.texture[v]);
    row.write("\n");
  });
  write_rows(out, mesh.cell_count(), [&](Text& row, Index c) {
    row.integer("", mesh.cells.vertex_count(c));
    for (const Index v : mesh.cells[c]) row.integer(" ", v);
    add_face_color(row, content, c);
    row.write("\n");
  });
  out.commit();
  note_losses(mesh, content, notes);
}

}  // namespace

Format off_format() { return {"OFF", {".off"}, false, read_off, write_off, off_holds}; }

}  // namespace meshorder
