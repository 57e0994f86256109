// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/format.hpp"
#include "io/labels.hpp"
#include "io/stream/id_map.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_ends.hpp"
#include "io/tetgen/tetgen.hpp"
#include "mesh/cells.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace meshorder::tetgen {
namespace {

constexpr char kComment = '#';

/// The numbers, markers and attributes of one file's records.
struct Records {
  Index count = 0;
  IdMap numbering;
  std::vector<std::int64_t> markers;  // empty if the records have none
  std::vector<double> attributes;
  Index attributes_of_each = 0;
};

struct ReadContext {
  Notes& notes;
  Mesh mesh = {};
  std::array<Records, 4> parts = {};
  std::string mark = {};  ///< mark of the .node file
  std::shared_ptr<TetGenMetadata> metadata = std::make_shared<TetGenMetadata>();
  bool second_order = false;
};

// ---- lines of numbers

/// Moves to the next record, which begins on a new line; fails at the end of the file.
void begin_record(Scanner& in, std::string_view what) {
  if (in.at_end()) {
    in.fail(fmt::format("unexpected end of file; expected {}", what),
            "it may be cut short, or the count in its header is wrong");
  }
}

/// Fails if the line ends although the record needs another number.
void expect_column(Scanner& in, std::string_view what) {
  if (in.at_line_end()) {
    in.fail(fmt::format("unexpected end of line; expected {}", what),
            "the header gives more columns, or the file is cut short");
  }
}

std::int64_t integer(Scanner& in, std::string_view what) {
  expect_column(in, what);
  return in.integer<std::int64_t>(what);
}

[[noreturn]] void fail_columns(const Scanner& in) {
  in.fail("the line has more columns than the header gives", "correct the header or remove the rest");
}

/// Reads an integer; accepts 2.0 because some writers print markers this way.
std::int64_t whole(Scanner& in, std::string_view what) {
  expect_column(in, what);
  std::int64_t number = 0;
  if (in.take_number(number)) return number;
  const std::string_view text = in.word(what);
  if (text.find_first_of(".eE") == std::string_view::npos) return parse_integer<std::int64_t>(in, text, what);
  const double value = parse_real(in, text, what);
  if (value != std::floor(value) || std::abs(value) > 1e15) {
    in.fail(fmt::format("{} is {}", what, value), "a whole number is needed");
  }
  return static_cast<std::int64_t>(value);
}

/// Reads the numbers of a header line; `standard` has the values of missing numbers.
template <std::size_t N>
std::array<std::int64_t, N> header(Scanner& in, std::array<std::int64_t, N> standard) {
  begin_record(in, "the header");
  for (std::size_t i = 0; i < N && (i == 0 || !in.at_line_end()); ++i) {
    standard[i] = integer(in, "a number of the header");
  }
  if (!in.at_line_end()) fail_columns(in);
  return standard;
}

std::int64_t checked_attributes(Scanner& in, std::int64_t attributes) {
  if (attributes < 0 || attributes > in.bytes_left()) {
    in.fail(fmt::format("the header gives {} attributes", attributes), "give 0, or as many as each line has");
  }
  return attributes;
}

bool checked_markers(Scanner& in, std::int64_t markers) {
  if (markers != 0 && markers != 1) {
    in.fail(fmt::format("the header gives {} boundary markers", markers), "0 or 1 are possible");
  }
  return markers == 1;
}

void add_number(Scanner& in, IdMap& numbering, std::string_view what) {
  const std::int64_t number = integer(in, what);
  if (!numbering.add(number))
    in.fail(fmt::format("{} {} is given twice", what, number), "each must be unique");
}

/// Reads the records of a file: each has its number, what `read_item(in, i)` reads, attributes and, if
/// `marked`, a marker. Leaves out further columns that the header does not give, as TetGen does; fails unless
/// all records have the same number of further columns.
template <class ReadItem>
void read_items(Scanner& in, File file, bool marked, ReadContext& to, const ReadItem& read_item) {
  Records& part = to.parts[file];
  const auto width = static_cast<std::size_t>(part.attributes_of_each);
  part.attributes.resize(static_cast<std::size_t>(part.count) * width);
  part.markers.resize(marked ? part.count : 0);
  const auto read = [&](Scanner& record, Index i) {
    read_item(record, i);
    for (double& value : std::span(part.attributes).subspan(static_cast<std::size_t>(i) * width, width)) {
      expect_column(record, "an attribute");
      value = record.real("an attribute");
    }
    if (marked) part.markers[i] = whole(record, "the boundary marker");
    return true;
  };
  const Index regular = read_numbered_records(in, part.count, part.numbering, read);
  Index further = regular > 0 ? 0 : -1;  // columns that the header does not give; −1 before the first record
  for (Index i = regular; i < part.count; ++i) {
    begin_record(in, file == kNode ? "a point" : "a cell");
    add_number(in, part.numbering, file == kNode ? "the point" : "the cell");
    read(in, i);
    Index own = 0;
    for (; !in.at_line_end(); ++own) (void)in.word("a column");
    if (further < 0) further = own;
    if (own > further) fail_columns(in);
    if (own < further) in.fail("the line has fewer columns than the first one", "add the missing columns");
  }
  if (further <= 0) return;
  to.notes.push_back(
      fmt::format("{}: columns after those that its header gives are left out ({} in each line)",
                  kExtensions[file], further));
}

/// Removes the mark from `comments`, which are those at the end of a file. Returns the mark; an empty text if
/// there is none.
std::string take_mark(std::string& comments) {
  const std::size_t at = comments.rfind(kMarkBefore);
  if (at == std::string::npos || (at > 0 && comments[at - 1] != '\n')) return {};
  const std::size_t end = std::min(comments.find('\n', at), comments.size());
  std::string mark = comments.substr(at, end - at);
  if (mark.ends_with('\r')) mark.pop_back();
  if (mark.size() != kMarkBefore.size() + kMarkDigits) return {};
  comments.erase(at, end + 1 - at);
  return mark;
}

/// Keeps the comments of a file and returns its mark; fails if other text follows the last record.
std::string end_file(Scanner& in, TetGenMetadata::FileComments& part, Notes& notes) {
  if (!in.at_end()) in.fail("unexpected text after the last record", "correct the number in the header");
  part.present = true;
  part.comments_before = comments_before(in.all(), kComment);
  part.comments_after = comments_after(in.all(), kComment);
  note_missing_line_end(in, kComment, notes);
  return take_mark(part.comments_after);
}

// ---- points

void read_points(Scanner& in, ReadContext& to) {
  const auto [records, dimension, given_attributes, has_markers] = header<4>(in, {0, 3, 0, 0});
  if (dimension != 2 && dimension != 3) {
    in.fail(fmt::format("the dimension is {}", dimension), "2 or 3 are possible");
  }
  const std::int64_t attributes = checked_attributes(in, given_attributes);
  const bool marked = checked_markers(in, has_markers);
  if (records == 0) in.fail("the file has no points", "a mesh needs some");
  const Index count =
      in.checked_count(records, "the number of points", 2 * (1 + dimension + attributes + has_markers));

  Mesh& mesh = to.mesh;
  mesh.dimension = static_cast<int>(dimension);
  mesh.points.resize(count, {0, 0, 0});
  Records& part = to.parts[kNode];
  part.count = count;
  part.attributes_of_each = static_cast<Index>(attributes);
  read_items(in, kNode, marked, to, [&](Scanner& record, Index v) {
    for (int k = 0; k < mesh.dimension; ++k) {
      expect_column(record, "a coordinate");
      mesh.points[v][k] = record.finite("a coordinate");
    }
  });

  // As in TetGen, numbers begin at 0 if the first is 0, else at 1. Numbers that are not consecutive begin at
  // 0 if any of them is 0: their base does not depend on the order of the points.
  to.metadata->base = part.numbering.id(0) == 0 ? 0 : 1;
  mesh.vertex_ids = part.numbering.ids_unless_from(to.metadata->base);
  if (std::find(mesh.vertex_ids.begin(), mesh.vertex_ids.end(), 0) != mesh.vertex_ids.end())
    to.metadata->base = 0;
  if (attributes > 0) {
    mesh.data.push_back(
        {"attribute", Association::vertices, part.attributes_of_each, std::move(part.attributes), {}, {}});
  }
  if (marked) {
    mesh.data.push_back(
        {std::string(kLabel), Association::vertices, 1, label_values(std::move(part.markers)), {}, {}});
  }
}

// ---- cells

/// Reads the points of a cell and puts them in VTK's order.
void read_cell_points(Scanner& in, const IdMap& points, std::span<const int> places, std::span<Index> cell) {
  std::array<Index, 10> as_given{};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::int64_t number = integer(in, "a point of the cell");
    as_given[k] = points.find(number);
    if (as_given[k] < 0) {
      in.fail(fmt::format("the cell names point {}, which .node does not have", number),
              fmt::format("it has {} points, the first is {}, the last {}", points.size(), points.id(0),
                          points.id(points.size() - 1)));
    }
  }
  for (std::size_t k = 0; k < places.size(); ++k) cell[k] = as_given[places[k]];
}

/// Reads all cells of a file after its header; each has `nodes` points, attributes and a marker if `marked`.
void read_cells(Scanner& in, File file, Shape shape, int nodes, bool marked, ReadContext& to) {
  const std::span<const int> order = places(file, nodes, false);
  const Index first = to.mesh.cells.size();
  append_cells(to.mesh.cells, shape, nodes, to.parts[file].count);
  read_items(in, file, marked, to, [&](Scanner& record, Index c) {
    read_cell_points(record, to.parts[kNode].numbering, order, to.mesh.cells[first + c]);
  });
}

/// Turns attributes into markers if each cell has one and all are 32-bit integers, as TetGen's regions are.
void take_regions_as_markers(Records& part) {
  using Limits = std::numeric_limits<std::int32_t>;
  const bool regions = part.attributes_of_each == 1 &&
                       std::all_of(part.attributes.begin(), part.attributes.end(), [](double x) {
                         return x == std::floor(x) && x >= Limits::min() && x <= Limits::max();
                       });
  if (!regions) return;
  part.markers.assign(part.attributes.begin(), part.attributes.end());
  part.attributes.clear();
  part.attributes_of_each = 0;
}

void read_ele(Scanner& in, ReadContext& to) {
  const bool plane = to.mesh.dimension == 2;
  const auto [records, nodes, attributes] = header<3>(in, {0, plane ? 3 : 4, 0});
  const bool triangles = nodes == 3 || nodes == 6;
  if (!triangles && (plane || (nodes != 4 && nodes != 10))) {
    in.fail(fmt::format("the cells have {} points each", nodes),
            plane ? "3 or 6 are possible in two dimensions"
                  : "4 or 10 (tetrahedra) or 3 or 6 (triangles) are possible");
  }
  Records& part = to.parts[kEle];
  part.attributes_of_each = static_cast<Index>(checked_attributes(in, attributes));
  part.count = in.checked_count(records, "the number of cells", 2 * (1 + nodes + attributes));
  to.metadata->nodes_in_ele = static_cast<int>(nodes);
  to.second_order = nodes == 6 || nodes == 10;
  read_cells(in, kEle, triangles ? Shape::triangle : Shape::tetrahedron, static_cast<int>(nodes), false, to);
  take_regions_as_markers(part);
}

[[noreturn]] void fail_neighbours(const Scanner& in) {
  in.fail(
      "the last columns are the numbers of neighbouring tetrahedra (TetGen's switch -nn), which reordering "
      "would invalidate",
      "remove them, or let TetGen write the file without -nn");
}

/// Reads faces or edges. Their header lacks the number of points per cell; the first record shows it.
void read_boundary(Scanner& in, File file, ReadContext& to) {
  const auto [records, has_markers] = header<2>(in, {0, 0});
  const bool marked = checked_markers(in, has_markers);
  const int least = file == kFace ? 3 : 2;
  Records& part = to.parts[file];
  part.count = in.checked_count(records, "the number of cells", 2 * (1 + least + has_markers));
  if (part.count == 0) return;

  // the first record has its number, its points and its marker
  const int columns = in.at_end() ? 0 : in.words_in_line() - 1 - static_cast<int>(has_markers);
  int nodes = columns;
  if (file == kFace) {
    if (columns == 5 || columns == 8) fail_neighbours(in);
    to.second_order = to.second_order || columns == 6;
  } else if (columns == 4 || (columns == 3 && !to.second_order)) {
    fail_neighbours(in);
  }
  const int most = file == kFace ? 6 : 3;
  if (columns < least) nodes = least;  // reading the first record then fails and names the missing column
  if (columns > least && columns != most) {
    in.fail(fmt::format("a line has {} columns besides its number and marker", columns),
            fmt::format("{} or {} points are possible", least, most));
  }
  read_cells(in, file, file == kFace ? Shape::triangle : Shape::line, nodes, marked, to);
}

/// Returns, for each vertex, the ends of the tetrahedra's edge whose middle node it is (lower end first), or
/// −1.
std::vector<std::array<Index, 2>> edges_of_nodes(const Mesh& mesh, Index tetrahedra) {
  constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  std::vector<std::array<Index, 2>> result(mesh.points.size(), {-1, -1});
  for (Index c = 0; c < tetrahedra; ++c) {
    const auto cell = mesh.cells[c];
    for (std::size_t e = 0; e < kEdges.size(); ++e) {
      const Index a = cell[kEdges[e][0]];
      const Index b = cell[kEdges[e][1]];
      result[cell[4 + e]] = {std::min(a, b), std::max(a, b)};
    }
  }
  return result;
}

/// Puts the second-order nodes of faces in VTK's order: the tetrahedra's edges show which order the file has.
/// TetGen 1.5 with -f lists the nodes by opposite edges, otherwise in VTK's order.
void settle_face_order(ReadContext& to) {
  const Index tetrahedra = to.parts[kEle].count;
  const Index end = tetrahedra + to.parts[kFace].count;
  Cells& cells = to.mesh.cells;
  if (tetrahedra == 0 || tetrahedra == end) return;
  if (cells.vertex_count(0) != 10 || cells.vertex_count(tetrahedra) != 6) return;

  const auto edge_of = edges_of_nodes(to.mesh, tetrahedra);
  Index vtk = 0;
  Index opposite = 0;
  for (Index c = tetrahedra; c < end; ++c) {
    const auto face = cells[c];
    const auto on_edge = [&](Index a, Index b) {
      return edge_of[face[3]] == std::array{std::min(a, b), std::max(a, b)};
    };
    vtk += on_edge(face[0], face[1]) ? 1 : 0;
    opposite += on_edge(face[1], face[2]) ? 1 : 0;
  }
  if (opposite <= vtk) return;

  to.metadata->faces_name_opposite_edges = true;
  for (Index c = tetrahedra; c < end; ++c) {
    const auto face = cells[c];
    std::rotate(face.begin() + 3, face.begin() + 5, face.end());
  }
}

// ---- all files of cells together

/// Sets the ids of cells unless each file numbers its cells consecutively from `base`.
void set_cell_ids(ReadContext& to) {
  const int base = to.metadata->base;
  if (std::ranges::all_of(kCellFiles, [&](File file) { return to.parts[file].numbering.runs_from(base); }))
    return;
  for (const File file : kCellFiles) {
    const Records& part = to.parts[file];
    for (Index c = 0; c < part.count; ++c) to.mesh.cell_ids.push_back(part.numbering.id(c));
  }
}

void set_cell_data(ReadContext& to) {
  Mesh& mesh = to.mesh;

  // only cells of .ele have attributes
  Records& ele = to.parts[kEle];
  if (ele.attributes_of_each > 0 && ele.count > 0) {
    DataArray array{"attribute", Association::cells, ele.attributes_of_each, std::move(ele.attributes), {},
                    {}};
    for (Index c = 0; ele.count < mesh.cell_count() && c < ele.count; ++c) array.indices.push_back(c);
    mesh.data.push_back(std::move(array));
  }

  // markers and regions of all files are one array of labels
  std::vector<std::int64_t> labels;
  std::vector<Index> rows;
  Index first = 0;
  for (const File file : kCellFiles) {
    const Records& part = to.parts[file];
    labels.insert(labels.end(), part.markers.begin(), part.markers.end());
    for (Index c = 0; c < index_size(part.markers); ++c) rows.push_back(first + c);
    first += part.count;
  }
  if (labels.empty()) return;
  if (index_size(rows) == mesh.cell_count()) rows.clear();
  mesh.data.push_back(
      {std::string(kLabel), Association::cells, 1, label_values(std::move(labels)), std::move(rows), {}});
}

void set_blocks(ReadContext& to) {
  Index first = 0;
  for (const File file : kCellFiles) {
    if (to.parts[file].count > 0) to.mesh.cell_blocks.push_back(first);
    first += to.parts[file].count;
  }
}

void read_cell_file(const FilePath& path, File file, ReadContext& to) {
  Scanner in(path, kComment);
  const int nodes_in_ele = to.metadata->nodes_in_ele;
  if (file == kFace && (to.mesh.dimension == 2 || nodes_in_ele == 3 || nodes_in_ele == 6)) {
    throw InputError(path.string(), "holds faces, but the cells of the mesh are triangles themselves",
                     "remove it, if it belongs to another mesh");
  }
  if (file == kEle) {
    read_ele(in, to);
  } else {
    read_boundary(in, file, to);
  }
  if (end_file(in, to.metadata->parts[file], to.notes) != to.mark) {
    throw NotTogether(
        path.string(),
        fmt::format("was not written together with its .node file: the last lines, which begin with "
                    "'{}', differ",
                    trimmed(kMarkBefore)),
        "give the files of one mesh, or remove these lines if they belong together");
  }
}

}  // namespace

Mesh read(const FilePath& path, Notes& notes) {
  if (!path.exists()) throw InputError(path.string(), "no such file", "check the path");
  const FilePath node_path = path.companion(".node");
  if (!node_path.exists()) {
    throw InputError(path.string(), "has no .node file beside it",
                     node_path.path().filename().string() + " is needed");
  }

  ReadContext reading{notes};
  {
    Scanner in(node_path, kComment);
    read_points(in, reading);
    reading.mark = end_file(in, reading.metadata->parts[kNode], notes);
  }
  for (const File file : kCellFiles) {
    const FilePath cell_path = path.companion(kExtensions[file]);
    if (cell_path.exists()) read_cell_file(cell_path, file, reading);
  }
  if (reading.mesh.cell_count() == 0) {
    throw InputError(path.string(), "has no cells",
                     "an .ele, .face or .edge file with cells must be beside it");
  }

  settle_face_order(reading);
  set_cell_ids(reading);
  set_cell_data(reading);
  set_blocks(reading);
  note_other_companions(path, "is not reordered: its numbers refer to the original order", notes);
  reading.mesh.format_metadata = reading.metadata;
  return std::move(reading.mesh);
}

}  // namespace meshorder::tetgen
