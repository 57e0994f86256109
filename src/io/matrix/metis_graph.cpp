// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Graphs in the format of METIS and Chaco. Format: G. Karypis, "METIS: a software package for partitioning
// unstructured graphs … Version 5.1.0" (2013), section 4.1.1. Where the two differ, METIS's meaning is taken:
// the hundreds digit of the third number says whether vertices have sizes.
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/matrix/matrix.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <utility>

namespace meshorder {
namespace matrix {
namespace {

/// Data of a file beyond the graph.
struct GraphMetadata final : StoredMatrix {
  std::string comments;

  [[nodiscard]] std::vector<std::string> contents() const override {
    return comments.empty() ? std::vector<std::string>{} : std::vector<std::string>{"the graph's comments"};
  }
};

/// A neighbour of a vertex. `value` is the weight of the edge in the reader, its cell in the writer.
struct Neighbour {
  Index vertex;
  std::int64_t value;
};

bool comes_before(const Neighbour& a, const Neighbour& b) { return a.vertex < b.vertex; }

// ---- reading

class GraphReader {
 public:
  explicit GraphReader(const FilePath& path) : in_(path) {}

  Mesh read() {
    read_header();
    for (Index v = 0; v < mesh_.vertex_count(); ++v) read_vertex(v);
    while (skip_comments()) {
      if (!trimmed(in_.peek_line()).empty()) {
        in_.fail(fmt::format("more than {} lines of vertices", mesh_.vertex_count()), "the count is wrong");
      }
      (void)in_.raw_line();
    }
    if (std::cmp_not_equal(neighbours_.size(), 2 * Offset{edges_})) {
      throw InputError(in_.file(),
                       fmt::format("the first line promises {} edges, but the lists name {} neighbours",
                                   edges_, neighbours_.size()),
                       "each edge must be in the lists of both its vertices");
    }
    make_edges();
    metadata_->is_graph = metadata_->is_half = true;
    mesh_.format_metadata = metadata_;
    return std::move(mesh_);
  }

 private:
  /// Takes the lines that are comments; returns false at the end of the file.
  bool skip_comments() {
    while (in_.bytes_left() > 0 && trimmed(in_.peek_line()).starts_with('%')) {
      metadata_->comments.append(in_.raw_line()) += '\n';
    }
    return in_.bytes_left() > 0;
  }

  void read_header() {
    while (skip_comments() && trimmed(in_.peek_line()).empty()) (void)in_.raw_line();
    line_of_header_ = in_.line();
    const auto vertices = in_.integer<std::int64_t>("the number of vertices");
    const auto edges = in_.integer<std::int64_t>("the number of edges");
    if (!in_.at_line_end()) read_kinds(in_.word("the kinds of weights"));
    if (!in_.at_line_end()) {
      weights_ = in_.count("the number of weights of a vertex", 0);
      if ((weights_ > 0) != has_weights_) {
        in_.fail("the number of weights does not agree with the digits before it", "see METIS's manual");
      }
    }
    if (!in_.at_line_end()) in_.fail("the first line has too many numbers", "two to four are needed");
    edges_ = in_.checked_count(edges, "the number of edges", 4);
    const Index count = in_.checked_count(vertices, "the number of vertices", 1);
    claim_vertices(count);
    mesh_.points.resize(count, {0, 0, 0});
    (void)in_.raw_line();
  }

  void read_kinds(std::string_view digits) {
    const bool known = digits.size() <= 3 && digits.find_first_not_of("01") == std::string_view::npos;
    if (!known) {
      in_.fail(fmt::format("the third number is '{}'", shown(digits)),
               "up to three digits 0 or 1 are possible");
    }
    const auto digit = [&](std::size_t from_end) {
      return digits.size() >= from_end && digits[digits.size() - from_end] == '1';
    };
    has_edge_weights_ = digit(1);
    has_weights_ = digit(2);
    has_sizes_ = digit(3);
    weights_ = has_weights_ ? 1 : 0;
  }

  std::int64_t number(std::string_view what, std::int64_t least) {
    if (in_.at_line_end()) in_.fail("the line ends before " + std::string(what), "it may be cut short");
    const auto value = in_.integer<std::int64_t>(what);
    if (value < least)
      in_.fail(fmt::format("{} is {}", what, value), fmt::format("at least {} is needed", least));
    return value;
  }

  void read_vertex(Index v) {
    if (!skip_comments()) {
      throw InputError(Location{in_.file(), lines_.empty() ? line_of_header_ : lines_.back(), -1},
                       fmt::format("only {} of {} lines of vertices", v, mesh_.vertex_count()),
                       "the file is cut short, or the count in its first line is wrong");
    }
    lines_.push_back(in_.line());
    if (has_sizes_) sizes_.push_back(number("the size of a vertex", 0));
    for (Index k = 0; k < weights_; ++k) vertex_weights_.push_back(number("the weight of a vertex", 0));
    const std::size_t first = neighbours_.size();
    while (!in_.at_line_end()) {
      const std::int64_t neighbour = number("a neighbour", 1);
      if (neighbour > mesh_.vertex_count()) {
        in_.fail(fmt::format("a neighbour is {}", neighbour),
                 fmt::format("1 to {} are possible", mesh_.vertex_count()));
      }
      if (neighbour == v + 1) in_.fail("the vertex names itself", "leave that out");
      neighbours_.push_back(
          {static_cast<Index>(neighbour - 1), has_edge_weights_ ? number("the weight of an edge", 1) : 0});
    }
    std::sort(neighbours_.begin() + static_cast<std::ptrdiff_t>(first), neighbours_.end(), comes_before);
    for (std::size_t i = first + 1; i < neighbours_.size(); ++i) {
      if (neighbours_[i].vertex == neighbours_[i - 1].vertex) {
        in_.fail(fmt::format("the vertex names {} twice", neighbours_[i].vertex + 1), "once is right");
      }
    }
    offsets_.push_back(static_cast<Offset>(neighbours_.size()));
    (void)in_.raw_line();
  }

  [[nodiscard]] std::span<const Neighbour> neighbours_of(Index v) const {
    return std::span(neighbours_).subspan(offsets_[v], offsets_[v + 1] - offsets_[v]);
  }

  /// Makes a line of each edge, from the vertex with the smaller number.
  void make_edges() {
    mesh_.cells.reserve(edges_, 2 * Offset{edges_});
    std::vector<std::int64_t> weights;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      for (const Neighbour& edge : neighbours_of(v)) {
        const auto back = neighbours_of(edge.vertex);
        const auto found = std::lower_bound(back.begin(), back.end(), Neighbour{v, 0}, comes_before);
        if (found == back.end() || found->vertex != v || found->value != edge.value) {
          throw InputError(Location{in_.file(), lines_[v], -1},
                           fmt::format("vertex {} names {}, which does not name it with the same weight",
                                       v + 1, edge.vertex + 1),
                           "each edge must be in the lists of both its vertices");
        }
        if (edge.vertex < v) continue;
        mesh_.cells.push_back(Shape::line, std::array{v, edge.vertex});
        if (has_edge_weights_) weights.push_back(edge.value);
      }
    }
    const auto add = [&](std::string_view name, Association association, Index components,
                         std::vector<std::int64_t>& values) {
      if (!values.empty()) {
        mesh_.data.push_back({std::string(name), association, components, std::move(values), {}, {}});
      }
    };
    add(kWeight, Association::cells, 1, weights);
    add(kSize, Association::vertices, 1, sizes_);
    add(kWeight, Association::vertices, weights_, vertex_weights_);
  }

  Scanner in_;
  Mesh mesh_;
  std::shared_ptr<GraphMetadata> metadata_ = std::make_shared<GraphMetadata>();
  Index edges_ = 0;
  Index weights_ = 0;  // number of weights of each vertex
  bool has_edge_weights_ = false;
  bool has_weights_ = false;
  bool has_sizes_ = false;
  std::vector<std::int64_t> lines_;  // number of each vertex's line in the file
  std::int64_t line_of_header_ = 1;
  std::vector<std::int64_t> sizes_;
  std::vector<std::int64_t> vertex_weights_;
  std::vector<Offset> offsets_{0};
  std::vector<Neighbour> neighbours_;  // neighbours of all vertices; those of each vertex ascend
};

Mesh read_graph(const FilePath& path, Notes& /*notes*/) { return GraphReader(path).read(); }

// ---- writing

/// The neighbours of all vertices, ascending, with the cells that join them. Counts loops and repeated edges.
struct Adjacency {
  explicit Adjacency(const Mesh& mesh) {
    offsets.assign(mesh.points.size() + 1, 0);
    for_lines(mesh, [&](Index from, Index to, Index /*cell*/) {
      ++offsets[from + 1];
      ++offsets[to + 1];
    });
    for (std::size_t v = 0; v < mesh.points.size(); ++v) offsets[v + 1] += offsets[v];
    neighbours.resize(offsets.back());
    std::vector<Offset> next(offsets.begin(), offsets.end() - 1);
    for_lines(mesh, [&](Index from, Index to, Index cell) {
      neighbours[next[from]++] = {to, cell};
      neighbours[next[to]++] = {from, cell};
    });
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      const auto begin = neighbours.begin() + offsets[v];
      const auto end = neighbours.begin() + offsets[v + 1];
      std::stable_sort(begin, end, comes_before);
      for (auto edge = begin; edge != end; ++edge) {
        if (edge != begin && (edge - 1)->vertex == edge->vertex) ++repeated;
      }
    }
    edges = (offsets.back() - repeated) / 2;
    repeated /= 2;
  }

  std::vector<Offset> offsets;
  std::vector<Neighbour> neighbours;
  Offset edges = 0;
  Offset loops = 0;
  Offset repeated = 0;

 private:
  template <class Work>
  void for_lines(const Mesh& mesh, Work work) {
    loops = 0;
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      const Index from = mesh.cells[c].front();
      const Index to = mesh.cells[c].back();
      if (from == to) {
        ++loops;
      } else {
        work(from, to, c);
      }
    }
  }
};

/// Returns the array if METIS takes its values: whole numbers of at least `least`; null otherwise.
const DataArray* weights(const Mesh& mesh, std::string_view name, Association association,
                         std::int64_t least) {
  const DataArray* const array = dense_array(mesh, name, association);
  if (array == nullptr || !is_whole(*array) || row_count(*array) == 0) return nullptr;
  for (Offset i = 0; i < Offset{row_count(*array)} * array->components; ++i) {
    if (whole_value(*array, i) < least) return nullptr;
  }
  return array;
}

bool is_edge(const Mesh& /*mesh*/, Shape shape, int vertices) {
  return shape == Shape::line && vertices == 2;
}

/// Puts the edges in the order of a file: by their smaller vertex, then by the other.
Permutation settle_edges(Mesh& mesh) {
  const bool are_lines =
      std::ranges::all_of(mesh.cells.shapes, [](Shape shape) { return shape == Shape::line; });
  if (!are_lines) return Permutation::identity(mesh.cell_count());  // no graph; the writer refuses it
  for (Index c = 0; c < mesh.cell_count(); ++c) std::ranges::sort(mesh.cells[c]);
  std::vector<Index> edges(mesh.cells.shapes.size());
  std::iota(edges.begin(), edges.end(), 0);
  std::stable_sort(edges.begin(), edges.end(), [&](Index a, Index b) {
    return std::ranges::lexicographical_compare(std::as_const(mesh.cells)[a], std::as_const(mesh.cells)[b]);
  });
  Permutation order = Permutation::from_new_to_old(std::move(edges));
  move_mesh(mesh, Permutation::identity(mesh.vertex_count()), order, Ids::keep);
  return order;
}

void write_graph(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const DataArray* edge_weights = weights(mesh, kWeight, Association::cells, 1);
  const DataArray* sizes = weights(mesh, kSize, Association::vertices, 0);
  if (edge_weights != nullptr && edge_weights->components > 1) edge_weights = nullptr;
  if (sizes != nullptr && sizes->components > 1) sizes = nullptr;
  const DataArray* const vertex_weights = weights(mesh, kWeight, Association::vertices, 0);
  const Adjacency graph(mesh);
  if (graph.edges == 0) {
    throw InputError(path.string(), "the mesh has no line between two vertices", "a graph needs an edge");
  }
  const auto* const own = dynamic_cast<const GraphMetadata*>(mesh.format_metadata.get());

  OutputFile out(path);
  if (own != nullptr) out.write(own->comments);
  out.print("{} {}", mesh.vertex_count(), graph.edges);
  if (sizes != nullptr || vertex_weights != nullptr || edge_weights != nullptr) {
    out.print(" {}{}{}", sizes != nullptr ? 1 : 0, vertex_weights != nullptr ? 1 : 0,
              edge_weights != nullptr ? 1 : 0);
  }
  if (vertex_weights != nullptr && vertex_weights->components > 1) {
    out.integer(" ", vertex_weights->components);
  }
  out.write("\n");
  write_rows(out, mesh.vertex_count(), [&](Text& row, Index v) {
    std::string_view blank;
    const auto put = [&](std::int64_t number) { row.integer(std::exchange(blank, " "), number); };
    if (sizes != nullptr) put(whole_value(*sizes, v));
    const Index components = vertex_weights != nullptr ? vertex_weights->components : 0;
    for (Index k = 0; k < components; ++k) put(whole_value(*vertex_weights, Offset{v} * components + k));
    Index last = -1;
    for (Offset i = graph.offsets[v]; i < graph.offsets[v + 1]; ++i) {
      const Neighbour& edge = graph.neighbours[i];
      if (std::exchange(last, edge.vertex) == edge.vertex) continue;
      put(std::int64_t{edge.vertex} + 1);
      if (edge_weights != nullptr) put(whole_value(*edge_weights, edge.value));
    }
    row.write("\n");
  });
  out.commit();

  if (graph.loops > 0) {
    notes.push_back(
        fmt::format("{} lines from a vertex to itself are not written: a graph has no loops", graph.loops));
  }
  if (graph.repeated > 0) {
    notes.push_back(fmt::format(
        "{} lines that join vertices once more are not written: a graph has an edge once", graph.repeated));
  }
  note_all_unsupported(mesh, "METIS's graph", std::array{edge_weights, sizes, vertex_weights}, notes);
  if (own == nullptr) note_metadata_unsupported(mesh, "METIS's graph", notes);
}

}  // namespace
}  // namespace matrix

Format metis_graph_format() {
  Format format{"METIS", {".graph"}, false, matrix::read_graph, matrix::write_graph, matrix::is_edge};
  format.settle_cells = matrix::settle_edges;
  return format;
}

}  // namespace meshorder
