// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/checksum.hpp"
#include "base/index.hpp"
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/deck/numbers.hpp"
#include "io/labels.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/text_rows.hpp"
#include "io/tetgen/tetgen.hpp"
#include "io/unsupported.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace meshorder::tetgen {

namespace {

/// Returns whether a .poly or .smesh file has no points of its own: it then refers to those of .node.
bool refers_to_points(const FilePath& path) {
  const std::string text = path.is_empty() ? std::string() : path.read();
  std::string_view lines = text;
  while (!lines.empty()) {
    std::string_view rest = lines.substr(0, lines.find('\n'));
    lines.remove_prefix(std::min(rest.size() + 1, lines.size()));
    const std::string_view word = next_word(rest, "\r");
    if (!word.empty() && word.front() != '#') return word == "0";
  }
  return false;
}

}  // namespace

void note_other_companions(const FilePath& path, std::string_view what, Notes& notes) {
  for (const std::string_view extension :
       {".neigh", ".t2f", ".t2e", ".f2e", ".f2t", ".p2t", ".mtr", ".vol", ".var", ".area", ".v.node",
        ".v.edge", ".v.face", ".v.cell", ".poly", ".smesh"}) {
    const FilePath other = path.companion(extension);
    if (!other.is_file()) continue;
    const bool surface = extension == ".poly" || extension == ".smesh";
    if (!surface || refers_to_points(other)) notes.push_back(fmt::format("{} {}", other.string(), what));
  }
}

namespace {

// ---- the cells of each file

bool holds(const Mesh& /*mesh*/, Shape shape, int vertices) {
  return (shape == Shape::tetrahedron && (vertices == 4 || vertices == 10)) ||
         (shape == Shape::triangle && (vertices == 3 || vertices == 6)) ||
         (shape == Shape::line && (vertices == 2 || vertices == 3));
}

bool has_shape(const Mesh& mesh, Shape shape) {
  return std::find(mesh.cells.shapes.begin(), mesh.cells.shapes.end(), shape) != mesh.cells.shapes.end();
}

bool is_plane(const Mesh& mesh) {
  return std::all_of(mesh.points.begin(), mesh.points.end(), [](const Point& p) { return p[2] == 0; });
}

/// Returns why the cells cannot be one mesh of TetGen or Triangle; an empty text if they can. Programs read
/// such a mesh by its .ele file, so it needs tetrahedra, or triangles in a plane.
std::string conflict(const Mesh& mesh) {
  const auto* own = dynamic_cast<const TetGenMetadata*>(mesh.format_metadata.get());
  std::array<int, kShapes> nodes{};
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const Shape shape = mesh.cells.shapes[c];
    const int count = mesh.cells.vertex_count(c);
    int& first = nodes[static_cast<std::size_t>(shape)];
    if (first == 0) first = count;
    if (first == count) continue;
    return fmt::format("TetGen cannot hold both {} and {}: a file holds one kind", type_name(shape, first),
                       type_name(shape, count));
  }
  const auto nodes_of = [&](Shape shape) { return nodes[static_cast<std::size_t>(shape)]; };
  const bool second_order = nodes_of(Shape::tetrahedron) == 10 || nodes_of(Shape::triangle) == 6 ||
                            (own && (own->nodes_in_ele == 10 || own->nodes_in_ele == 6));
  if (nodes_of(Shape::line) == 3 && !second_order) {
    return "TetGen holds lines of 3 points only together with cells of second order";
  }
  if (own || nodes_of(Shape::tetrahedron) > 0) return {};
  if (nodes_of(Shape::triangle) == 0) return "TetGen holds lines only together with tetrahedra or triangles";
  return is_plane(mesh) ? "" : "TetGen holds triangles alone only in the plane z = 0";
}

// ---- columns

/// One component of an array as a column of a file; `row_of` gives the row of each vertex or cell.
struct Column {
  const DataArray* array;
  Index component;
  std::vector<Index> row_of;  // empty: row i belongs to vertex or cell i
};

std::string text_of(const Column& column, Index item) {
  const Offset row = column.row_of.empty() ? item : column.row_of[item];
  if (row < 0) return "0";  // a cell without a label
  return with_numbers(column.array->values, [&](const auto& values) {
    return fmt::format("{}", values[row * column.array->components + column.component]);
  });
}

void note_missing_labels(std::ptrdiff_t missing, std::string_view file, Notes& notes) {
  notes.push_back(fmt::format("{} in {} have no label and get 0", missing, file));
}

/// Returns the attribute columns of `items` (the points, or the cells of .ele): an array "attribute" first,
/// then the labels of cells, then other arrays with numbers for every item. Notes arrays that do not fit.
std::vector<Column> attribute_columns(const Mesh& mesh, Association association,
                                      const std::vector<Index>& items, Notes& notes) {
  const Index count = association == Association::vertices ? mesh.vertex_count() : mesh.cell_count();
  const DataArray* const labels = label_array(mesh, association);
  std::vector<const DataArray*> arrays;
  for (const DataArray& array : mesh.data) {
    // labels of vertices are boundary markers
    if (array.association == association && (&array != labels || association == Association::cells))
      arrays.push_back(&array);
  }
  std::stable_sort(arrays.begin(), arrays.end(), [&](const DataArray* a, const DataArray* b) {
    const auto rank = [&](const DataArray* x) { return x->name == "attribute" ? 0 : x == labels ? 1 : 2; };
    return rank(a) < rank(b);
  });

  std::vector<Column> columns;
  for (const DataArray* array : arrays) {
    std::vector<Index> row_of = rows_by_item(*array, count);
    const auto has_row = [&](Index item) { return row_of.empty() || row_of[item] >= 0; };
    const auto given = std::count_if(items.begin(), items.end(), has_row);
    if (array == labels && given == 0) continue;  // these labels are markers of faces and edges
    const bool text = std::holds_alternative<std::vector<std::string>>(array->values);
    if (text || items.empty() || (given < index_size(items) && array != labels)) {
      note_array_unsupported(*array, "TetGen", notes);
      continue;
    }
    if (array != labels && row_count(*array) > given) {
      notes.push_back(fmt::format("the array '{}' is not written for cells outside .ele", array->name));
    }
    if (given < index_size(items)) note_missing_labels(index_size(items) - given, ".ele", notes);
    for (Index k = 0; k < array->components; ++k) columns.push_back({array, k, row_of});
  }
  return columns;
}

/// Notes the arrays that become columns of attributes and lose their names.
void note_lost_names(const std::vector<Column>& columns, std::string_view file, Notes& notes) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const DataArray& array = *columns[k].array;
    const bool alone = columns.size() == static_cast<std::size_t>(array.components);
    if (columns[k].component != 0 || array.name == "attribute" || (alone && array.name == kLabel)) continue;
    notes.push_back(
        fmt::format("the array '{}' becomes {} of the attributes in {}, without its name", array.name,
                    array.components == 1 ? fmt::format("column {}", k + 1)
                                          : fmt::format("columns {} to {}", k + 1, k + array.components),
                    file));
  }
}

// ---- files

/// Returns whether any item of a file has a marker; if so, notes how many items have none and get 0.
bool has_markers(const Labels& labels, const std::vector<Index>& items, std::string_view file, Notes& notes) {
  if (!labels.any()) return false;
  const auto given =
      std::count_if(items.begin(), items.end(), [&](Index item) { return labels.given[item]; });
  if (given > 0 && given < index_size(items)) note_missing_labels(index_size(items) - given, file, notes);
  return given > 0;
}

constexpr std::int64_t kLargestNumber = std::numeric_limits<std::int64_t>::max();  // largest vertex number

/// The contents of a file: its points or cells, and the columns that are written for each.
struct FileContent {
  std::vector<Index> items;
  int nodes = 0;  ///< number of nodes of each cell
  std::vector<Column> attributes;
  bool marked = false;
};

struct WriteContext {
  const Mesh& mesh;
  const TetGenMetadata& metadata;
  int dimension;
  bool own_ids;     // the ids came from TetGen's files; other ids are not written
  bool vertex_ids;  // the ids of vertices are written
  Labels vertex_labels;
  Labels cell_labels;
  std::array<FileContent, 4> files = {};

  [[nodiscard]] const Labels& labels(File file) const { return file == kNode ? vertex_labels : cell_labels; }
  [[nodiscard]] std::int64_t vertex_number(Index v) const {
    return vertex_ids ? mesh.vertex_ids[v] : v + std::int64_t{metadata.base};
  }
  /// Returns the number of the cell c, which is at position `place` in its file.
  [[nodiscard]] std::int64_t cell_number(Index c, Index place) const {
    return own_ids && !mesh.cell_ids.empty() ? mesh.cell_ids[c] : place + std::int64_t{metadata.base};
  }
};

/// Distributes the points and cells among the files.
void distribute(WriteContext& from, bool solid) {
  from.files[kNode].items = index_range(0, from.mesh.vertex_count());
  const int in_ele = from.metadata.nodes_in_ele;
  from.files[kEle].nodes = in_ele;
  // triangles are the cells of a plane mesh, or the boundary of a solid mesh
  const bool triangles_in_ele = !solid && (from.dimension == 2 || in_ele == 3 || in_ele == 6);
  for (Index c = 0; c < from.mesh.cell_count(); ++c) {
    const Shape shape = from.mesh.cells.shapes[c];
    const bool is_face = shape == Shape::triangle && !triangles_in_ele;
    FileContent& file = from.files[shape == Shape::line ? kEdge : is_face ? kFace : kEle];
    if (file.items.empty()) file.nodes = from.mesh.cells.vertex_count(c);
    file.items.push_back(c);
  }
}

/// Fails if a file of an earlier mesh would be read as part of this one.
void refuse_leftovers(const WriteContext& from, const FilePath& path) {
  for (const File file : kCellFiles) {
    const FilePath other = path.companion(kExtensions[file]);
    if (!from.files[file].items.empty() || from.metadata.parts[file].present || !other.exists()) continue;
    throw InputError(path.string(),
                     fmt::format("{} is beside it and would be read as part of this mesh",
                                 other.path().filename().string()),
                     "remove that file or choose another name");
  }
}

/// Chooses the attributes and markers of a file.
void choose_columns(WriteContext& from, File file, Notes& notes) {
  FileContent& content = from.files[file];
  if (file == kNode || file == kEle) {
    const Association of = file == kNode ? Association::vertices : Association::cells;
    content.attributes = attribute_columns(from.mesh, of, content.items, notes);
    note_lost_names(content.attributes, kExtensions[file], notes);
  }
  if (file != kEle) content.marked = has_markers(from.labels(file), content.items, kExtensions[file], notes);
}

void write_items(OutputFile& out, File file, const WriteContext& from) {
  const Mesh& mesh = from.mesh;
  const FileContent& content = from.files[file];
  out.print("{}", content.items.size());
  if (file == kNode || file == kEle)
    out.print("  {}  {}", file == kNode ? from.dimension : content.nodes, content.attributes.size());
  if (file != kEle) out.print("  {}", content.marked ? 1 : 0);
  out.write("\n");
  const auto order = places(file, content.nodes, from.metadata.faces_name_opposite_edges);
  write_rows(out, index_size(content.items), [&](Text& row, Index i) {
    const Index item = content.items[i];
    if (file == kNode) {
      row.integer("", from.vertex_number(item));
      for (int k = 0; k < from.dimension; ++k) row.real("  ", mesh.points[item][k]);
    } else {
      const auto cell = mesh.cells[item];
      std::array<Index, 10> as_given{};
      row.integer("", from.cell_number(item, i));
      for (std::size_t k = 0; k < order.size(); ++k) as_given[order[k]] = cell[k];
      for (std::size_t k = 0; k < order.size(); ++k) row.integer(" ", from.vertex_number(as_given[k]));
    }
    for (const Column& column : content.attributes) row.print("  {}", text_of(column, item));
    if (content.marked) row.integer("  ", from.labels(file).values[item]);
    row.write("\n");
  });
}

/// Returns a line with a checksum of the mesh, its order and its data; different meshes hardly ever have the
/// same line.
std::string mark_of(const WriteContext& from) {
  Checksum sum;
  for (const File file : kFiles) {
    const auto& [items, nodes, attributes, marked] = from.files[file];
    for (const Column& column : attributes) {
      for (const Index item : items) sum.add_all(text_of(column, item));
    }
    for (const Index item : items) {
      if (marked) sum.add(from.labels(file).values[item]);
    }
  }
  sum.add_all(from.mesh.points);
  for (Index v = 0; v < from.mesh.vertex_count(); ++v) sum.add(from.vertex_number(v));
  for (const File file : kCellFiles) {
    const std::vector<Index>& cells = from.files[file].items;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      sum.add(from.cell_number(cells[k], static_cast<Index>(k)));
      for (const Index v : from.mesh.cells[cells[k]]) sum.add(v);
    }
  }
  return fmt::format("{}{:0{}x}\n", kMarkBefore, sum.value(), kMarkDigits);
}

}  // namespace

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const TetGenMetadata standard;
  const auto* own = dynamic_cast<const TetGenMetadata*>(mesh.format_metadata.get());
  const bool solid = has_shape(mesh, Shape::tetrahedron);
  WriteContext from{mesh,
                    own ? *own : standard,
                    solid ? 3
                    : own ? mesh.dimension
                          : 2,
                    own != nullptr,
                    own != nullptr && can_be_numbers(mesh.vertex_ids, kLargestNumber, 0),
                    labels_of(mesh, Association::vertices),
                    labels_of(mesh, Association::cells)};
  distribute(from, solid);
  refuse_leftovers(from, path);
  std::vector<File> written;
  for (const File file : kFiles) {
    if (file != kNode && !from.metadata.parts[file].present && from.files[file].items.empty()) continue;
    choose_columns(from, file, notes);
    written.push_back(file);
  }

  const std::string mark = mark_of(from);
  std::vector<OutputFile> files;
  files.reserve(written.size());
  for (const File file : written) {
    const TetGenMetadata::FileComments& part = from.metadata.parts[file];
    OutputFile& out = files.emplace_back(path.companion(kExtensions[file]));
    out.write(part.comments_before);
    write_items(out, file, from);
    out.write(part.comments_after);
    if (!part.comments_after.empty() && !part.comments_after.ends_with('\n')) out.write("\n");
    out.write(mark);
  }
  OutputFile::commit_all(files);

  if (own && !mesh.vertex_ids.empty() && !from.vertex_ids) {
    notes.emplace_back(
        "the ids of vertices are not written: TetGen's are at least 0 and differ from each other");
  }
  if (!own) {
    note_ids_unsupported(mesh, "TetGen", notes);
    note_metadata_unsupported(mesh, "TetGen", notes);
  }
  for (const EntitySet& set : mesh.sets) note_set_unsupported(set, "TetGen", notes);
  note_other_companions(path, "does not fit the new mesh", notes);
}

std::int64_t first_number_of(const Mesh& mesh, Association /*of*/) {
  const auto* const own = dynamic_cast<const TetGenMetadata*>(mesh.format_metadata.get());
  return own == nullptr ? 0 : own->base;
}

}  // namespace meshorder::tetgen

namespace meshorder {

Format tetgen_format() {
  return {.name = "TetGen",
          .extensions = {".node", ".ele", ".face", ".edge"},
          .groups_cells_by_type = true,
          .read = tetgen::read,
          .write = tetgen::write,
          .holds = tetgen::holds,
          .conflict = tetgen::conflict,
          .single_file = false,
          .first_number_of = tetgen::first_number_of,
          .holds_ids = false};
}

}  // namespace meshorder
