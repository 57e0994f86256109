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

/// The content of one file of cells.
struct CellFile {
  Index count = 0;
  IdMap numbering;
  std::vector<std::int64_t> markers;  // one for each cell, or none
  std::vector<double> attributes;
  Index attributes_per_cell = 0;
};

struct ReadContext {
  Notes& notes;
  Mesh mesh = {};
  IdMap points = {};
  std::array<CellFile, 4> parts = {};
  std::string mark = {};  ///< mark of the file of points
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

/// Takes the next number of a record, which must be on the same line.
std::string_view column(Scanner& in, std::string_view what) {
  if (in.at_line_end()) {
    in.fail(fmt::format("unexpected end of line; expected {}", what),
            "the header gives more columns, or the file is cut short");
  }
  return in.word(what);
}

[[noreturn]] void fail_columns(const Scanner& in) {
  in.fail("the line has more columns than the header gives", "correct the header or remove the rest");
}

/// Ends the lines of records. Columns after those that the header gives are left out, as TetGen does, if all
/// records have equally many.
class RecordEnds {
 public:
  /// @param has_records  whether records without such columns were read before
  explicit RecordEnds(bool has_records) : further_(has_records ? 0 : -1) {}

  void end(Scanner& in) {
    Index further = 0;
    for (; !in.at_line_end(); ++further) (void)in.word("a column");
    if (further_ < 0) further_ = further;
    if (further > further_) fail_columns(in);
    if (further < further_) in.fail("the line has fewer columns than the first one", "add those that lack");
  }
  void note_columns_left_out(File file, Notes& notes) const {
    if (further_ <= 0) return;
    notes.push_back(
        fmt::format("{}: columns after those that its header gives are left out ({} in each line)",
                    kExtensions[file], further_));
  }

 private:
  Index further_;  ///< such columns of each record; −1 before the first one
};

/// Reads an integer; accepts 2.0 because some writers print markers this way.
std::int64_t whole(Scanner& in, std::string_view what) {
  const std::string_view text = column(in, what);
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
    standard[i] =
        parse_integer<std::int64_t>(in, column(in, "a number of the header"), "a number of the header");
  }
  if (!in.at_line_end()) fail_columns(in);
  return standard;
}

/// Checks the number of records, which must fit the rest of the file.
Index checked_records(Scanner& in, std::int64_t records, std::string_view what, std::int64_t columns) {
  return in.checked_count(records, what, 2 * columns);
}

std::int64_t checked_attributes(Scanner& in, std::int64_t attributes) {
  if (attributes < 0 || attributes > in.bytes_left()) {
    in.fail(fmt::format("the header gives {} attributes", attributes),
            "0 or as many as each line has are possible");
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
  const auto number = parse_integer<std::int64_t>(in, column(in, what), what);
  if (!numbering.add(number))
    in.fail(fmt::format("{} {} is given twice", what, number), "each must be unique");
}

/// Takes as many numbers as `values` has; returns false if a number is missing or is not regular.
bool take_all(Scanner& in, std::span<double> values) {
  return std::ranges::all_of(values, [&](double& value) { return in.take_number(value); });
}

/// Removes the mark of a mesh's files from `comments`, the comments at the end of a file. Returns the mark;
/// an empty text if there is none.
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
      checked_records(in, records, "the number of points", 1 + dimension + attributes + has_markers);

  Mesh& mesh = to.mesh;
  mesh.dimension = static_cast<int>(dimension);
  mesh.points.resize(count, {0, 0, 0});
  std::vector<double> values(static_cast<std::size_t>(count * attributes));
  std::vector<std::int64_t> markers(marked ? count : 0);
  const auto attributes_of = [&](Index v) {
    return std::span(values).subspan(static_cast<std::size_t>(v * attributes),
                                     static_cast<std::size_t>(attributes));
  };
  const Index regular = read_numbered_records(in, count, to.points, [&](Scanner& part, Index v) {
    for (int k = 0; k < mesh.dimension; ++k) {
      if (!part.take_finite(mesh.points[v][k])) return false;
    }
    return take_all(part, attributes_of(v)) && (!marked || part.take_number(markers[v]));
  });
  RecordEnds ends(regular > 0);
  for (Index v = regular; v < count; ++v) {
    begin_record(in, "a point");
    add_number(in, to.points, "the point");
    for (int k = 0; k < mesh.dimension; ++k) {
      const double x = parse_real(in, column(in, "a coordinate"), "a coordinate");
      if (!std::isfinite(x)) in.fail("a coordinate is not finite", "a finite number is needed");
      mesh.points[v][k] = x;
    }
    for (double& value : attributes_of(v)) value = parse_real(in, column(in, "an attribute"), "an attribute");
    if (marked) markers[v] = whole(in, "the boundary marker");
    ends.end(in);
  }
  ends.note_columns_left_out(kNode, to.notes);

  // As in TetGen, numbers begin at 0 if the first one is 0, else at 1. If they are not consecutive, they
  // begin at 0 if any of them is 0: so another order of the points does not change the points that cells
  // name.
  to.metadata->base = to.points.id(0) == 0 ? 0 : 1;
  mesh.vertex_ids = to.points.ids_unless_from(to.metadata->base);
  if (std::find(mesh.vertex_ids.begin(), mesh.vertex_ids.end(), 0) != mesh.vertex_ids.end())
    to.metadata->base = 0;
  if (attributes > 0) {
    mesh.data.push_back(
        {"attribute", Association::vertices, static_cast<Index>(attributes), std::move(values), {}, {}});
  }
  if (marked) {
    mesh.data.push_back(
        {std::string(kLabel), Association::vertices, 1, label_values(std::move(markers)), {}, {}});
  }
}

// ---- cells

/// Reads the points of a cell, from the file's order into VTK's.
void read_cell_points(Scanner& in, const IdMap& points, std::span<const int> places, std::span<Index> cell) {
  std::array<Index, 10> as_given{};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto number =
        parse_integer<std::int64_t>(in, column(in, "a point of the cell"), "a point of the cell");
    as_given[k] = points.find(number);
    if (as_given[k] < 0) {
      in.fail(fmt::format("the cell names point {}, which .node does not have", number),
              fmt::format("it has {} points, the first is {}, the last {}", points.size(), points.id(0),
                          points.id(points.size() - 1)));
    }
  }
  for (std::size_t k = 0; k < places.size(); ++k) cell[k] = as_given[places[k]];
}

/// Reads all cells of a file after its header; every line has `nodes` points, attributes and a marker.
void read_cells(Scanner& in, File file, Shape shape, int nodes, bool marked, ReadContext& to) {
  CellFile& part = to.parts[file];
  const std::span<const int> order = places(file, nodes, false);
  Cells& cells = to.mesh.cells;
  const Index first = cells.size();
  append_cells(cells, shape, nodes, part.count);
  part.attributes.resize(Offset{part.count} * part.attributes_per_cell);
  part.markers.resize(marked ? part.count : 0);
  const auto attributes_of = [&](Index c) {
    return std::span(part.attributes)
        .subspan(Offset{c} * part.attributes_per_cell, static_cast<std::size_t>(part.attributes_per_cell));
  };
  const Index regular = read_numbered_records(in, part.count, part.numbering, [&](Scanner& records, Index c) {
    std::int64_t number = 0;
    const std::span<Index> cell = cells[first + c];
    std::array<Index, 10> as_given{};
    for (int k = 0; k < nodes; ++k) {
      if (!records.take_number(number)) return false;
      as_given[k] = to.points.find(number);
      if (as_given[k] < 0) return false;
    }
    for (int k = 0; k < nodes; ++k) cell[k] = as_given[order[k]];
    return take_all(records, attributes_of(c)) && (!marked || records.take_number(part.markers[c]));
  });
  RecordEnds ends(regular > 0);
  for (Index c = regular; c < part.count; ++c) {
    begin_record(in, "a cell");
    add_number(in, part.numbering, "the cell");
    read_cell_points(in, to.points, order, cells[first + c]);
    for (double& value : attributes_of(c)) value = parse_real(in, column(in, "an attribute"), "an attribute");
    if (marked) part.markers[c] = whole(in, "the boundary marker");
    ends.end(in);
  }
  ends.note_columns_left_out(file, to.notes);
}

/// Makes a label of TetGen's region attribute, one whole number for each cell. Other attributes stay.
void take_regions_as_markers(CellFile& part) {
  using Limits = std::numeric_limits<std::int32_t>;
  const bool regions = part.attributes_per_cell == 1 &&
                       std::all_of(part.attributes.begin(), part.attributes.end(), [](double x) {
                         return x == std::floor(x) && x >= Limits::min() && x <= Limits::max();
                       });
  if (!regions) return;
  part.markers.assign(part.attributes.begin(), part.attributes.end());
  part.attributes.clear();
  part.attributes_per_cell = 0;
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
  CellFile& part = to.parts[kEle];
  part.attributes_per_cell = static_cast<Index>(checked_attributes(in, attributes));
  part.count = checked_records(in, records, "the number of cells", 1 + nodes + attributes);
  to.metadata->nodes_in_ele = static_cast<int>(nodes);
  to.second_order = nodes == 6 || nodes == 10;
  read_cells(in, kEle, triangles ? Shape::triangle : Shape::tetrahedron, static_cast<int>(nodes), false, to);
  take_regions_as_markers(part);
}

/// Counts the words of the first record's line after its number, without taking them.
int columns_of_first_record(Scanner& in) {
  if (in.at_end()) return 0;
  std::string_view line = in.peek_line();
  line = line.substr(0, line.find(kComment));
  int words = -1;
  for (; !next_word(line, " \t\f\v").empty(); ++words) {
  }
  return words;
}

[[noreturn]] void fail_neighbours(const Scanner& in) {
  in.fail(
      "the last columns are the numbers of neighbouring tetrahedra (TetGen's switch -nn), which reordering "
      "would invalidate",
      "remove them, or let TetGen write the file without -nn");
}

/// Reads faces or edges. Their header lacks the number of points of a cell; the first record shows it.
void read_boundary(Scanner& in, File file, ReadContext& to) {
  const auto [records, has_markers] = header<2>(in, {0, 0});
  const bool marked = checked_markers(in, has_markers);
  const int least = file == kFace ? 3 : 2;
  CellFile& part = to.parts[file];
  part.count = checked_records(in, records, "the number of cells", 1 + least + has_markers);
  if (part.count == 0) return;

  const int columns = columns_of_first_record(in) - static_cast<int>(has_markers);
  int nodes = columns;
  if (file == kFace) {
    if (columns == 5 || columns == 8) fail_neighbours(in);
    to.second_order = to.second_order || columns == 6;
  } else if (columns == 4 || (columns == 3 && !to.second_order)) {
    fail_neighbours(in);
  }
  const int most = file == kFace ? 6 : 3;
  if (columns < least) nodes = least;  // the first record's own error says which column is missing
  if (columns > least && columns != most) {
    in.fail(fmt::format("a line has {} columns beside its number and marker", columns),
            fmt::format("{} or {} points are possible", least, most));
  }
  read_cells(in, file, file == kFace ? Shape::triangle : Shape::line, nodes, marked, to);
}

/// Returns, for each second-order node of the tetrahedra, the ends of its edge, the lower vertex first.
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

/// TetGen 1.5 with -f writes the second-order nodes of faces by opposite edges, otherwise in VTK's order. The
/// faces were read as if in VTK's order. Finds the order by the edges of the tetrahedra, and corrects it.
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

/// Sets the ids of cells if the ids in a file are not consecutive. Each file numbers its cells separately.
void set_cell_ids(ReadContext& to) {
  const int base = to.metadata->base;
  if (std::all_of(to.parts.begin(), to.parts.end(),
                  [&](const CellFile& part) { return part.numbering.runs_from(base); })) {
    return;
  }
  for (const File file : kCellFiles) {
    const CellFile& part = to.parts[file];
    for (Index c = 0; c < part.count; ++c) to.mesh.cell_ids.push_back(part.numbering.id(c));
  }
}

void set_cell_data(ReadContext& to) {
  Mesh& mesh = to.mesh;

  // only cells of .ele have attributes
  CellFile& ele = to.parts[kEle];
  if (ele.attributes_per_cell > 0 && ele.count > 0) {
    DataArray array{"attribute", Association::cells, ele.attributes_per_cell, std::move(ele.attributes), {},
                    {}};
    for (Index c = 0; ele.count < mesh.cell_count() && c < ele.count; ++c) array.indices.push_back(c);
    mesh.data.push_back(std::move(array));
  }

  // markers and regions of all files are one array of labels
  std::vector<std::int64_t> labels;
  std::vector<Index> rows;
  Index first = 0;
  for (const File file : kCellFiles) {
    const CellFile& part = to.parts[file];
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
