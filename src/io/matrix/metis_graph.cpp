// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Graphs in the format of METIS and Chaco. Format: G. Karypis, "METIS: a software package for partitioning
// unstructured graphs … Version 5.1.0" (2013), section 4.1.1. Where the two differ, METIS's meaning is taken:
// the hundreds digit of the third number says whether vertices have sizes.
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/matrix/matrix.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"
#include "mesh/cells.hpp"
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

/// A neighbour of a vertex. `value`: in the reader, the edge's weight; in the writer, the edge's cell.
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
    read_vertices();
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
  /// Stores the next lines that are comments; returns false at the end of the file.
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

  static std::int64_t number(Scanner& in, std::string_view what, std::int64_t least) {
    if (in.at_line_end()) in.fail("the line ends before " + std::string(what), "it may be cut short");
    const auto value = in.integer<std::int64_t>(what);
    if (value < least) fail_small(in, what, value, least);
    return value;
  }

  [[noreturn]] static void fail_small(const Scanner& in, std::string_view what, std::int64_t value,
                                      std::int64_t least) {
    in.fail(fmt::format("{} is {}", what, value), fmt::format("at least {} is needed", least));
  }

  [[noreturn]] void fail_neighbour(const Scanner& in, std::int64_t number) const {
    if (number < 1) fail_small(in, "a neighbour", number, 1);
    if (number <= mesh_.vertex_count()) in.fail("the vertex names itself", "remove its number");
    in.fail(fmt::format("a neighbour is {}", number),
            fmt::format("1 to {} are possible", mesh_.vertex_count()));
  }

  /// Returns the number of neighbours of a vertex whose line has `words` words.
  [[nodiscard]] Offset neighbours_in(int words) const {
    const int after_weights = std::max(0, words - weights_ - (has_sizes_ ? 1 : 0));
    return has_edge_weights_ ? (after_weights + 1) / 2 : after_weights;
  }

  /// Reads vertices: on all threads up to the first irregular line, for example a comment; then one by one.
  void read_vertices() {
    const Index count = mesh_.vertex_count();
    offsets_.resize(static_cast<std::size_t>(count) + 1);
    lines_.resize(static_cast<std::size_t>(count));
    sizes_.resize(has_sizes_ ? static_cast<std::size_t>(count) : 0);
    Scanner ahead = in_;
    const Index counted = read_regular_lines(ahead, count, [&](Scanner& in, Index v) {
      const int words = in.words_in_line();
      offsets_[v + 1] = neighbours_in(words);
      lines_[v] = in.line();
      in.move_on(in.peek_line().size());
      return words >= weights_;
    });
    std::partial_sum(offsets_.begin(), offsets_.begin() + counted + 1, offsets_.begin());
    resize_large(neighbours_, static_cast<std::size_t>(offsets_[counted]));
    resize_large(vertex_weights_, static_cast<std::size_t>(Offset{counted} * weights_));
    const Index regular = read_regular_lines(in_, counted, [&](Scanner& in, Index v) {
      read_vertex(in, v);
      return true;
    });
    for (Index v = regular; v < count; ++v) {
      if (!skip_comments()) {
        throw InputError(Location{in_.file(), v == 0 ? line_of_header_ : lines_[v - 1], -1},
                         fmt::format("only {} of {} lines of vertices", v, count),
                         "the file is cut short, or the count in its first line is wrong");
      }
      const int words = in_.words_in_line();
      offsets_[v + 1] = offsets_[v] + neighbours_in(words);
      lines_[v] = in_.line();
      neighbours_.resize(static_cast<std::size_t>(offsets_[v + 1]));
      vertex_weights_.resize(static_cast<std::size_t>(Offset{v} * weights_ + std::min(words, weights_)));
      read_vertex(in_, v);
      (void)in_.raw_line();
    }
  }

  void read_vertex(Scanner& in, Index v) {
    if (has_sizes_) sizes_[v] = number(in, "the size of a vertex", 0);
    for (Index k = 0; k < weights_; ++k)
      vertex_weights_[Offset{v} * weights_ + k] = number(in, "the weight of a vertex", 0);
    const std::span<Neighbour> neighbours = neighbours_of(v);
    for (auto& [vertex, weight] : neighbours) {
      const auto number_of_vertex = in.integer<std::int64_t>("a neighbour");
      if (number_of_vertex < 1 || number_of_vertex > mesh_.vertex_count() || number_of_vertex == v + 1)
        fail_neighbour(in, number_of_vertex);
      vertex = static_cast<Index>(number_of_vertex - 1);
      if (has_edge_weights_) weight = number(in, "the weight of an edge", 1);
    }
    std::ranges::sort(neighbours, comes_before);
    const auto twice = std::ranges::adjacent_find(neighbours, {}, &Neighbour::vertex);
    if (twice != neighbours.end())
      in.fail(fmt::format("the vertex names {} twice", twice->vertex + 1), "name it once");
  }

  [[nodiscard]] std::span<Neighbour> neighbours_of(Index v) {
    return std::span(neighbours_).subspan(offsets_[v], offsets_[v + 1] - offsets_[v]);
  }

  /// Returns whether the other vertex of an edge names v with the same weight.
  [[nodiscard]] bool is_named_back(Index v, const Neighbour& edge) {
    const std::span<const Neighbour> back = neighbours_of(edge.vertex);
    const auto found = std::lower_bound(back.begin(), back.end(), Neighbour{v, 0}, comes_before);
    return found != back.end() && found->vertex == v && found->value == edge.value;
  }

  /// Returns the neighbours of v whose numbers are greater than v.
  [[nodiscard]] std::span<Neighbour> greater_neighbours(Index v) {
    const std::span<Neighbour> all = neighbours_of(v);
    return {std::upper_bound(all.begin(), all.end(), Neighbour{v, 0}, comes_before), all.end()};
  }

  /// Fails at the first edge that its other vertex does not list with the same weight.
  [[noreturn]] void fail_one_sided() {
    Index v = 0;
    const auto is_one_sided = [&](const Neighbour& edge) { return !is_named_back(v, edge); };
    while (std::ranges::none_of(neighbours_of(v), is_one_sided)) ++v;
    throw InputError(Location{in_.file(), lines_[v], -1},
                     fmt::format("vertex {} names {}, which does not name it with the same weight", v + 1,
                                 std::ranges::find_if(neighbours_of(v), is_one_sided)->vertex + 1),
                     "each edge must be in the lists of both its vertices");
  }

  /// Makes a line of each edge, from the vertex with the smaller number.
  void make_edges() {
    constexpr Index kAtOnce = 16384;  // vertices
    const Index count = mesh_.vertex_count();
    const bool are_named_back = holds_for_all(count, [&](Offset begin, Offset end) {
      for (auto v = static_cast<Index>(begin); v < end; ++v) {
        const bool all = std::ranges::all_of(neighbours_of(v),
                                             [&](const Neighbour& edge) { return is_named_back(v, edge); });
        if (!all) return false;
      }
      return true;
    });
    if (!are_named_back) fail_one_sided();
    std::vector<Index> firsts(chunk_count(count, kAtOnce) + std::size_t{1});  // first edge of each chunk
    for_each_chunk(count, kAtOnce, [&](Index chunk, Index begin, Index end) {
      for (Index v = begin; v < end; ++v) firsts[chunk + 1] += index_size(greater_neighbours(v));
    });
    std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
    append_cells(mesh_.cells, Shape::line, 2, edges_);
    std::vector<std::int64_t> weights(has_edge_weights_ ? edges_ : 0);
    for_each_chunk(count, kAtOnce, [&](Index chunk, Index begin, Index end) {
      Index at = firsts[chunk];
      for (Index v = begin; v < end; ++v) {
        for (const Neighbour& edge : greater_neighbours(v)) {
          std::ranges::copy(std::array{v, edge.vertex}, mesh_.cells[at].begin());
          if (has_edge_weights_) weights[at] = edge.value;
          ++at;
        }
      }
    });
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
  std::vector<Offset> offsets_;
  std::vector<Neighbour> neighbours_;  // neighbours of all vertices; those of each vertex ascend
};

Mesh read_graph(const FilePath& path, Notes& /*notes*/) { return GraphReader(path).read(); }

// ---- writing

/// Each vertex's neighbours, ascending, with the cells that join them; counts of loops and repeated lines.
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

/// Returns the array if METIS accepts its values: integers of at least `least`; null otherwise.
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

/// Puts the edges in the order of a file: by smaller vertex, then by greater vertex.
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
    notes.push_back(
        fmt::format("{} repeated lines are not written: a graph has each edge once", graph.repeated));
  }
  note_all_unsupported(mesh, "METIS's graph", std::array{edge_weights, sizes, vertex_weights}, notes);
  if (own == nullptr) note_metadata_unsupported(mesh, "METIS's graph", notes);
}

}  // namespace
}  // namespace matrix

Format metis_graph_format() {
  Format format{"METIS",        {".graph", ".metis"}, false, matrix::read_graph, matrix::write_graph,
                matrix::is_edge};
  format.settle_cells = matrix::settle_edges;
  return format;
}

}  // namespace meshorder
