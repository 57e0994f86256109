// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/labels.hpp"
#include "io/medit/medit.hpp"
#include "io/names.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_ends.hpp"
#include "mesh/cells.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <span>
#include <unordered_set>
#include <utility>

namespace meshorder::medit {
namespace {

constexpr char kComment = '#';

/// A section that refers to no vertices or cells and is kept verbatim.
struct PlainKind {
  std::string_view keyword;
  enum Form : std::uint8_t { words, rows, line, lines } form;  ///< a count precedes rows and lines
  int words_per_row;
  int words_per_dimension;
};

constexpr std::array kPlainKinds{
    PlainKind{"Normals", PlainKind::rows, 0, 1},
    PlainKind{"Tangents", PlainKind::rows, 0, 1},
    PlainKind{"BoundingBox", PlainKind::words, 0, 2},
    PlainKind{"AngleOfCornerBound", PlainKind::words, 1, 0},
    PlainKind{"MaximalAngleOfCorner", PlainKind::words, 1, 0},
    PlainKind{"Iterations", PlainKind::words, 1, 0},
    PlainKind{"Time", PlainKind::words, 1, 0},
    PlainKind{"BezierBasis", PlainKind::words, 1, 0},
    PlainKind{"FloatingPointPrecision", PlainKind::words, 1, 0},
    PlainKind{"EdgesReferenceElement", PlainKind::words, 2, 0},
    PlainKind{"TriangleReferenceElement", PlainKind::words, 6, 0},
    PlainKind{"QuadrilateralReferenceElement", PlainKind::words, 8, 0},
    PlainKind{"TetrahedronReferenceElement", PlainKind::words, 12, 0},
    PlainKind{"PyramidReferenceElement", PlainKind::words, 15, 0},
    PlainKind{"PrismReferenceElement", PlainKind::words, 18, 0},
    PlainKind{"HexahedronReferenceElement", PlainKind::words, 24, 0},
    PlainKind{"Identifier", PlainKind::line, 0, 0},
    PlainKind{"Geometry", PlainKind::line, 0, 0},
    PlainKind{"IdentityOfGeometry", PlainKind::line, 0, 0},
    PlainKind{"MeshSupportOfVertices", PlainKind::line, 0, 0},
    PlainKind{"IdentityOfMeshSupport", PlainKind::line, 0, 0},
    PlainKind{"Comments", PlainKind::lines, 0, 0},
    PlainKind{"ReferenceStrings", PlainKind::lines, 0, 0},
};

/// Returns the index of the kind with that keyword, or the size of the table.
template <class Kinds>
std::size_t find_kind(const Kinds& kinds, std::string_view keyword) {
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const auto& kind) { return same_but_for_case(kind.keyword, keyword); });
  return static_cast<std::size_t>(found - kinds.begin());
}

/// A section to be read after the sections that it refers to; its keyword ends at `byte`.
template <class Kind>
struct Pending {
  const Kind* kind;
  std::int64_t byte;
};

class Reader {
 public:
  Reader(const FilePath& path, Notes& notes) : in_(path, kComment), notes_(notes) {}

  Mesh read() {
    refuse_other_formats();
    metadata_->comments_before = comments_before(in_.all(), kComment);
    while (!in_.at_end() && read_section()) {
    }
    note_comments_left_out();
    if (!has_end_) note_missing_end();
    read_pending();
    arrange_nodes();
    set_labels();
    mesh_.format_metadata = metadata_;
    return std::move(mesh_);
  }

 private:
  void refuse_other_formats() {
    if (in_.all().substr(0, 16).find('\0') != std::string_view::npos) {
      throw InputError(in_.file(), "is binary, perhaps a .meshb file", "convert it to an ASCII .mesh");
    }
    if (in_.at_end() || !same_but_for_case(in_.peek_word(), "MeshVersionFormatted")) {
      in_.fail(
          "is not a Medit mesh",
          "the first word must be MeshVersionFormatted (MFEM and Netgen use .mesh for formats of their own)");
    }
  }

  /// Reads or skips one section; returns false at the end of the mesh.
  bool read_section() {
    begin_ = in_.byte();
    const std::string keyword(in_.word("a keyword"));
    if (same_but_for_case(keyword, "End")) {
      read_end();
      return false;
    }
    refuse_numbers(keyword);
    if (!kinds_seen_.insert(lower_case(keyword)).second) {
      in_.fail("a second section " + keyword, "each may appear once");
    }
    last_keyword_ = keyword;

    if (same_but_for_case(keyword, "MeshVersionFormatted")) {
      metadata_->version = in_.integer<std::int64_t>("the version");
      if (metadata_->version < 0 || metadata_->version > 4) {
        in_.fail(fmt::format("the version is {}", metadata_->version), "1 to 4 are supported");
      }
    } else if (same_but_for_case(keyword, "Dimension")) {
      mesh_.dimension = in_.integer<std::int32_t>("the dimension");
      if (mesh_.dimension != 2 && mesh_.dimension != 3) {
        in_.fail(fmt::format("the dimension is {}", mesh_.dimension), "2 or 3 are possible");
      }
      has_dimension_ = true;
    } else if (!has_dimension_ && !comes_before_dimension(keyword)) {
      in_.fail("the section " + keyword + " comes before the Dimension", "Dimension 2 or 3 must come first");
    } else if (same_but_for_case(keyword, "Vertices")) {
      read_vertices();
    } else {
      read_other_section(keyword);
    }
    return true;
  }

  /// Returns whether a section may precede Dimension: whether its length does not depend on the dimension.
  static bool comes_before_dimension(std::string_view keyword) {
    const std::size_t kind = find_kind(kPlainKinds, keyword);
    return kind < kPlainKinds.size() && kPlainKinds[kind].words_per_dimension == 0;
  }

  void refuse_numbers(const std::string& keyword) const {
    if (std::isalpha(static_cast<unsigned char>(keyword.front())) != 0 && keyword.size() < 64) return;
    std::string shown = keyword.substr(0, 20);
    std::replace_if(
        shown.begin(), shown.end(), [](unsigned char c) { return std::isprint(c) == 0; }, '?');
    in_.fail(
        fmt::format("expected a keyword, found '{}'", shown),
        fmt::format("the count of {} may be wrong, or its lines longer (second-order cells under a linear "
                    "keyword; save those as .msh)",
                    last_keyword_));
  }

  void read_other_section(const std::string& keyword) {
    if (const std::size_t kind = find_cell_kind(keyword); kind < kCellKinds.size()) {
      if (has_vertices_) return read_cells(kind);
      pending_cells_.push_back({&kCellKinds[kind], in_.byte()});
      return skip_rows(kCellKinds[kind].nodes + 1);
    }
    if (const std::size_t kind = find_kind(kReferenceKinds, keyword); kind < kReferenceKinds.size()) {
      const auto& [name, form, columns] = kReferenceKinds[kind];
      pending_.push_back({&kReferenceKinds[kind], in_.byte()});
      return skip_rows(form == Form::table ? 0 : static_cast<int>(columns.size()));
    }
    if (const std::size_t kind = find_kind(kSizeKinds, keyword); kind < kSizeKinds.size()) {
      return read_sizes(kSizeKinds[kind]);
    }
    if (const std::size_t kind = kind_of_ordering(keyword); kind < kCellKinds.size()) {
      read_ordering(kind);
      return keep_section(keyword);
    }
    if (const std::size_t kind = find_kind(kPlainKinds, keyword); kind < kPlainKinds.size()) {
      skip_plain(kPlainKinds[kind]);
      return keep_section(keyword);
    }
    in_.fail("the section " + keyword + " is not supported, and its numbers may be wrong after reordering",
             "remove it from the file");
  }

  static std::size_t find_cell_kind(std::string_view keyword) {
    const std::size_t kind = find_kind(kCellKinds, keyword);
    if (kind < kCellKinds.size()) return kind;
    const auto found = std::find_if(kCellKinds.begin(), kCellKinds.end(), [&](const CellKind& candidate) {
      return same_but_for_case(candidate.alias, keyword);
    });
    return static_cast<std::size_t>(found - kCellKinds.begin());
  }

  // ---- sections that are kept

  void keep_section(const std::string& keyword) {
    metadata_->sections.push_back(
        {keyword, std::string(in_.all().substr(begin_, in_.byte() - begin_)), !has_vertices_});
  }

  void skip_plain(const PlainKind& kind) {
    const bool has_count = kind.form == PlainKind::rows || kind.form == PlainKind::lines;
    const Index count = has_count ? in_.count(what_count(), 2) : 1;
    const int words = kind.words_per_row + kind.words_per_dimension * mesh_.dimension;
    const std::string what = what_number();
    for (Index row = 0; row < count; ++row) {
      if (kind.form == PlainKind::line || kind.form == PlainKind::lines) {
        if (in_.at_end()) in_.word("a line of " + last_keyword_);  // throws, as the file ends
        in_.raw_line();
      } else {
        for (int k = 0; k < words; ++k) in_.real(what);
      }
    }
  }

  /// Reads the node order of a kind of cells: a list of the nodes' coordinates in the reference cell.
  void read_ordering(std::size_t kind) {
    const auto nodes = reference_nodes(kCellKinds[kind].shape);
    const Index count = in_.count(what_count(), 2);
    if (count != index_size(nodes)) {
      in_.fail(fmt::format("{} has {} lines", last_keyword_, count),
               fmt::format("{} are needed", nodes.size()));
    }
    std::vector<int> places(nodes.size(), -1);
    for (Index place = 0; place < count; ++place) {
      std::vector<int> node(nodes.front().size());
      for (int& x : node) x = in_.integer<std::int32_t>("a coordinate of " + last_keyword_);
      const auto found = std::find(nodes.begin(), nodes.end(), node);
      if (found != nodes.end()) places[found - nodes.begin()] = place;
    }
    if (std::find(places.begin(), places.end(), -1) != places.end()) {
      notes_.push_back(fmt::format("{} is not supported: the nodes of {} keep the order of the file",
                                   last_keyword_, kCellKinds[kind].keyword));
      return;
    }
    metadata_->places[kind] = std::move(places);
  }

  // ---- vertices and cells

  void read_vertices() {
    const Index count = in_.count("the count of Vertices", 2 * (mesh_.dimension + 1));
    mesh_.points.resize(count, {0, 0, 0});
    std::vector<std::int64_t> references(count);
    read_records(in_, count, [&](Scanner& in, Index v) {
      for (int k = 0; k < mesh_.dimension; ++k) mesh_.points[v][k] = in.finite("a coordinate");
      references[v] = in.integer<std::int64_t>("the reference of a vertex");
    });
    has_vertices_ = true;
    mesh_.data.push_back(
        {std::string(kLabel), Association::vertices, 1, label_values(std::move(references)), {}, {}});
  }

  void read_cells(std::size_t kind) {
    const auto& [keyword, shape, nodes, alias] = kCellKinds[kind];
    const Index count = in_.count(what_count(), 2 * (nodes + 1));
    if (count == 0) {
      metadata_->empty_sections.push_back(kind);
      return;
    }
    mesh_.cell_blocks.push_back(mesh_.cell_count());
    first_[kind] = mesh_.cell_count();
    counts_[kind] = count;
    const Index first = mesh_.cell_count();
    append_cells(mesh_.cells, shape, nodes, count);
    references_.resize(references_.size() + count);
    const std::span references = std::span(references_).last(count);
    read_records(in_, count, [&](Scanner& in, Index c) {
      for (Index& v : mesh_.cells[first + c]) v = in.position("a vertex of the cell", mesh_.vertex_count());
      references[c] = in.integer<std::int64_t>("the reference of a cell");
    });
  }

  // ---- sections that refer to vertices or cells

  /// Skips a section that is read later. Each row has `words` words; if `words` is 0, each row has as many
  /// words as the line of the first row.
  void skip_rows(int words) {
    const Index count = in_.count(what_count(), 2 * std::max(words, 1));
    if (words == 0) words = words_of_line();
    const std::string what = what_number();
    for (Index row = 0; row < count; ++row) {
      for (int k = 0; k < words; ++k) in_.word(what);
    }
  }

  /// Returns the number of words from the next word to the line's end; 1 at the end of the file.
  int words_of_line() { return in_.at_end() ? 1 : in_.words_in_line(); }

  void read_pending() {
    if (!has_vertices_) in_.fail("the file has no Vertices", "a mesh needs some");
    for (const auto& [kind, byte] : pending_cells_) {
      go_to(byte, kind->keyword);
      read_cells(static_cast<std::size_t>(kind - kCellKinds.data()));
    }
    std::ranges::stable_sort(pending_, {}, [](const auto& section) { return section.kind->form; });
    for (const auto& [kind, byte] : pending_) {
      go_to(byte, kind->keyword);
      if (kind->form == Form::list) read_list(*kind);
      if (kind->form == Form::table) read_table(*kind);
      if (kind->form == Form::rows) read_rows(columns_of(*kind));
    }
  }

  void go_to(std::int64_t byte, std::string_view keyword) {
    in_.seek(byte);
    last_keyword_ = keyword;
  }

  /// Returns the first vertex or cell of a target, and the number of all of them. Fails if `needed` > 0 and
  /// there are no such cells.
  std::pair<Index, Index> range_of(const Target& target, Index needed) {
    if (!target) return {0, mesh_.vertex_count()};
    const std::size_t kind = counted_kind(*target, counts_);
    if (kind < kCellKinds.size()) return {first_[kind], counts_[kind]};
    if (needed > 0) {
      in_.fail(
          fmt::format("{} counts cells of type {}, and there are none", last_keyword_, to_string(*target)),
          "remove the section");
    }
    return {0, 0};
  }

  void read_list(const ReferenceKind& kind) {
    const Target target = target_of(kind.columns.front());
    EntitySet set{std::string(kind.keyword), target ? Association::cells : Association::vertices, {}};
    const Index members = in_.count(what_count(), 2);
    const auto [first, count] = range_of(target, members);
    const std::string what = what_number();
    for (Index i = 0; i < members; ++i) set.members.push_back(first + in_.position(what, count));
    drop_repeated(set, notes_);
    mesh_.sets.push_back(std::move(set));
  }

  /// Reads a section of lines with positions in some columns.
  void read_rows(std::string_view columns) {
    const Index rows = in_.count(what_count(), 2 * static_cast<std::int64_t>(columns.size()));
    MeditMetadata::Rows section{last_keyword_, std::string(columns), {}, {}};
    const std::string what = what_number();
    for (Index row = 0; row < rows; ++row) {
      const bool of_triangle = columns.starts_with(".t");
      if (columns.starts_with('.') && in_.peek_word() != (of_triangle ? "3" : "2")) {
        in_.fail(fmt::format("a line of {} begins with '{}'", last_keyword_, shown(in_.peek_word())),
                 of_triangle ? "it must begin with 3, for a triangle" : "it must begin with 2, for an edge");
      }
      for (const char column : columns) {
        if (column == '.') {
          section.kept.push_back(in_.real(what));
          continue;
        }
        const auto [first, count] = range_of(target_of(column), rows);
        section.items.push_back(first + in_.position(what, count));
      }
    }
    metadata_->rows.push_back(std::move(section));
  }

  /// Returns the columns of a section of that kind in this file. A file without triangles and quadrilaterals
  /// is a geometry: its domains name edges of the same file. In a mesh, domains of the geometry name edges of
  /// another file; these numbers are kept.
  [[nodiscard]] std::string_view columns_of(const ReferenceKind& kind) const {
    const auto cells = [&](Shape shape) { return counted_kind(shape, counts_) < kCellKinds.size(); };
    const bool is_geometry = !cells(Shape::triangle) && !cells(Shape::quad);
    if (kind.columns == ".t.." && is_geometry) return ".e..";
    if (kind.columns == ".e.." && !is_geometry) return "....";
    return kind.columns;
  }

  /// Reads the mesh sizes at all vertices.
  void read_sizes(const SizeKind& kind) {
    if (!has_vertices_) in_.fail(last_keyword_ + " comes before Vertices", "put it after them");
    const std::string what = what_number();
    std::vector<double> sizes(mesh_.points.size() * static_cast<std::size_t>(kind.components));
    for (double& size : sizes) size = in_.real(what);
    mesh_.data.push_back(
        {std::string(kind.keyword), Association::vertices, kind.components, std::move(sizes), {}, {}});
  }

  void read_table(const ReferenceKind& kind) {
    const Target target = target_of(kind.columns.front());
    const std::int64_t begin = in_.byte();
    DataArray array{
        std::string(kind.keyword), target ? Association::cells : Association::vertices, 1, {}, {}, {}};
    const Index rows = in_.count(what_count(), 2);
    if (rows == 0) {
      metadata_->sections.push_back({array.name, array.name + "\n0", false});
      return;
    }
    array.components = words_of_line() - 1;
    if (array.components < 1)
      in_.fail("a line of " + array.name + " has one number", "two or more are needed");

    const auto [first, count] = range_of(target, rows);
    const std::string what = what_number();
    std::vector<double> values;
    std::vector<bool> seen(count, false);
    for (Index row = 0; row < rows; ++row) {
      const Index item = in_.position(what, count);
      if (seen[item]) {  // an array has only one row for each item
        in_.seek(begin);
        return read_rows(std::string(kind.columns) +
                         std::string(static_cast<std::size_t>(array.components), '.'));
      }
      seen[item] = true;
      array.indices.push_back(first + item);
      for (Index k = 0; k < array.components; ++k) values.push_back(in_.real(what));
    }
    array.values = std::move(values);
    mesh_.data.push_back(std::move(array));
  }

  // ---- the end

  void read_end() {
    has_end_ = true;
    const std::string_view rest = in_.all().substr(in_.byte());
    // npos + 1 is 0: nothing but blanks
    metadata_->after_end = rest.substr(0, rest.find_last_not_of(" \t\r\n") + 1);
  }

  /// Notes comments that are neither at the beginning nor in a section that is kept as it is.
  void note_comments_left_out() {
    if (in_.last_comment() <= metadata_->comments_before.size()) return;
    const auto marks_in = [](std::string_view text) { return std::ranges::count(text, kComment); };
    const std::string_view until_here = in_.all().substr(0, static_cast<std::size_t>(in_.byte()));
    auto left_out = marks_in(until_here) - marks_in(metadata_->comments_before);
    for (const auto& section : metadata_->sections) left_out -= marks_in(section.text);
    if (left_out > 0) notes_.push_back(in_.file() + ": comments between the data are left out");
  }

  void note_missing_end() {
    notes_.push_back(in_.file() + " has no End: if it was cut short, sections may be missing");
    note_missing_line_end(in_, kComment, notes_);
  }

  /// Puts the nodes of second-order cells into VTK's order if the file gives their order.
  void arrange_nodes() {
    for (std::size_t kind = kLinearKinds; kind < kCellKinds.size(); ++kind) {
      if (counts_[kind] == 0) continue;
      const auto order = metadata_->places.find(kind);
      // libMeshb leaves the order of nodes to the file; for simplices all writers agree
      const Shape shape = kCellKinds[kind].shape;
      const bool simplex = shape == Shape::line || shape == Shape::triangle || shape == Shape::tetrahedron;
      if (order == metadata_->places.end()) {
        if (!simplex) {
          notes_.push_back(
              fmt::format("the nodes of {} are taken to be in VTK's order, as the file does not state it",
                          kCellKinds[kind].keyword));
        }
        continue;
      }
      std::vector<Index> as_given;
      for (Index c = first_[kind]; c < first_[kind] + counts_[kind]; ++c) {
        const auto cell = mesh_.cells[c];
        as_given.assign(cell.begin(), cell.end());
        for (std::size_t k = 0; k < as_given.size(); ++k) cell[k] = as_given[order->second[k]];
      }
    }
  }

  void set_labels() {
    if (references_.empty()) return;
    mesh_.data.insert(
        mesh_.data.begin() + 1,
        {std::string(kLabel), Association::cells, 1, label_values(std::move(references_)), {}, {}});
  }

  [[nodiscard]] std::string what_count() const { return "the count of " + last_keyword_; }
  [[nodiscard]] std::string what_number() const { return "a number of " + last_keyword_; }

  Scanner in_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<MeditMetadata> metadata_ = std::make_shared<MeditMetadata>();
  std::int64_t begin_ = 0;  // first byte of the section
  std::string last_keyword_;
  std::unordered_set<std::string> kinds_seen_;
  bool has_dimension_ = false;
  bool has_vertices_ = false;
  bool has_end_ = false;
  std::vector<Pending<CellKind>> pending_cells_;
  std::vector<Pending<ReferenceKind>> pending_;
  std::array<Index, kCellKinds.size()> first_{};
  std::array<Index, kCellKinds.size()> counts_{};
  std::vector<std::int64_t> references_;
};

}  // namespace

Mesh read(const FilePath& path, Notes& notes) {
  note_solutions(path, "is not reordered: its values are in the original order", notes);
  return Reader(path, notes).read();
}

}  // namespace meshorder::medit
