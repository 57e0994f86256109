// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>
#include <meshorder/fiedler.hpp>
#include <meshorder/options.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/view.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// The method that made an order.
struct MethodChoice {
  std::string name;    ///< never "auto"
  std::string reason;  ///< why `auto` chose it; empty if it was requested by name

  bool operator==(const MethodChoice&) const = default;
};

/// An order and a report on how it was found.
struct Order {
  Permutation permutation;
  MethodChoice method = {};
  /// For methods that use Fiedler vectors: a report on each component.
  std::vector<FiedlerComponent> fiedler = {};
  /// For `fiedler` and `minla`: n entries, to pass as `OrderOptions::start` to the next call.
  std::vector<double> vector = {};
  bool complete = true;  ///< false: `Run::time_limit` ended the method early
  double seconds = 0;    ///< wall-clock time of the call
  /// What was changed in a copy of the input ("12 loops dropped"), and what looks wrong in the input.
  std::vector<std::string> notes = {};
};

/// Orders of a mesh's vertices and of all its cells.
struct MeshOrder {
  Order vertices;
  Order cells;
};

/// Names of the methods for a mesh's vertices and elements (`vertex_methods` and `element_methods` list
/// them).
struct MeshMethods {
  std::string vertices = "auto";
  std::string elements = "auto";

  bool operator==(const MeshMethods&) const = default;
};

/// Orders the vertices of a graph or the rows of a matrix. Nothing is changed.
///
/// Vertices without neighbours come last, in their old order, except under `original` and registered methods.
/// With `options.groups` the groups ascend, and the method orders each group.
///
/// @param graph    n vertices (see `GraphView`); only fiedler, mdf and registered methods use the
///                 weights
/// @param method   name of a vertex method
/// @param options  see `OrderOptions`
/// @param points   n points for geometric methods (hilbert, morton); n or none for others, of which only
///                 `auto` and registered methods use the points
/// @throws InvalidArgument for an unknown method (the message lists the known ones), for a geometric method
///         without coordinates, for sizes that do not match or options out of range, and for what `check`
///         refuses
/// @throws TooLarge for more than 2,147,483,647 vertices, or for more entries than METIS's integers can count
/// @throws Unavailable for a method that this build lacks
/// @throws Stopped if the progress callback returned false
/// @note Time of the methods:
///       - rcm and bfs: O(n + entries · log degree), with a copy of the graph;
///       - mdf: O(n · degree² + entries · log n), with a copy of the graph;
///       - hilbert and morton: O(n log n);
///       - fiedler: O((n + entries) · iterations), with about six iterations;
///       - spectral: the time of fiedler times log n;
///       - minla: the time of fiedler, and O(n + entries) for each pass.
/// @note A clean graph with int64 offsets and int32 neighbours is read in place; other offsets take 8 bytes a
///       vertex, other neighbours 4 bytes an entry. Same input, options and version give the same order on
///       any number of threads and for any integer types. Reentrant.
MESHORDER_API Order order_vertices(const GraphView& graph, std::string_view method = "auto",
                                   const OrderOptions& options = {}, const PointsView& points = {});

/// Orders the cells of a mesh. Nothing is changed.
///
/// The method orders the elements, which are the cells of the highest dimension; `lexmax` orders the cells of
/// lower dimension (under `original` they do not move). Cells stay within their block. In a block, a cell
/// moves only to places that cells of its dimension had.
///
/// @param cells     m cells of n vertices, any layout; see `CellsView`
/// @param vertices  order of the n vertices, which most element orders follow
/// @param method    name of an element method
/// @param options   see `OrderOptions`; `cell_groups` has m entries or none, `groups` is not used
/// @param points    n points in their old order for geometric methods; n or none for others
/// @return permutation of all m cells
/// @throws as `order_vertices`
/// @note lexmax, mean, min, max O(entries + m log m); fiedler as for vertices, on the dual graph. As
///       deterministic as `order_vertices`.
MESHORDER_API Order order_elements(const CellsView& cells, const Permutation& vertices,
                                   std::string_view method = "auto", const OrderOptions& options = {},
                                   const PointsView& points = {});

/// Orders edges by the larger of the new places of their two ends, then by the smaller place, then by edge
/// number: `lexmax` for edges.
///
/// A loop over the edges then reaches the vertices nearly in their new order, whichever method ordered them.
/// Do not sort by the smaller end: springs then take up to 1.5 times as long in orders along curves.
///
/// @param ends      2 m numbers in 0 … n − 1: the ends of one edge after another. They are old numbers, so
///                  call this function before `vertices.renumber(ends)`. If they are renumbered already,
///                  pass `Permutation::identity(n)` as `vertices`
/// @param vertices  order of the n vertices
/// @param run       threads, progress
/// @return permutation of the m edges. The function does not change `ends`: move the edges by this
///         permutation, then renumber their ends by `vertices`
/// @throws InvalidArgument for an odd number of ends, and ends out of range; as `order_elements`
/// @note O(m log m). As deterministic as `order_vertices`.
MESHORDER_API Permutation order_edges(const IndexView& ends, const Permutation& vertices,
                                      const Run& run = {});

/// Orders the vertices of a mesh, by the graph that joins the vertices of each element, and then the cells.
///
/// @param mesh     n vertices, m cells
/// @param methods  names of the two methods
/// @param options  see `OrderOptions`; `groups` has n entries or none, `cell_groups` m or none; the time
///                 limit and the progress are those of the whole call
/// @throws as `order_vertices` and `vertex_graph`
/// @note The graph costs O(Σ (vertices of an element)²) and about 60 bytes a tetrahedron.
MESHORDER_API MeshOrder order_mesh(const MeshView& mesh, const MeshMethods& methods = {},
                                   const OrderOptions& options = {});

/// A clean undirected graph that owns its arrays: rows ascend, no loops, no repeats, every edge in the rows
/// of both its ends. A named graph converts to `GraphView`. A temporary one does not compile, because its
/// view would dangle.
class MESHORDER_API Graph {
 public:
  /// The graph without vertices.
  Graph() = default;

  /// Takes over the arrays of a clean graph without checking them; call `check` if in doubt.
  ///
  /// @param offsets     n + 1, from 0
  /// @param neighbours  offsets[n] numbers in 0 … n−1
  /// @param weights     one for each neighbour, or none
  [[nodiscard]] static Graph adopt(std::vector<Offset> offsets, std::vector<Index> neighbours,
                                   std::vector<double> weights = {}) noexcept {
    Graph graph;
    graph.offsets_ = std::move(offsets);
    graph.neighbours_ = std::move(neighbours);
    graph.weights_ = std::move(weights);
    return graph;
  }

  operator GraphView() const& noexcept MESHORDER_LIFETIMEBOUND {  // NOLINT(google-explicit-constructor)
    return {.offsets = offsets_, .neighbours = neighbours_, .weights = weights_};
  }
  operator GraphView() const&& = delete;

  /// Returns the number of vertices n.
  [[nodiscard]] Index size() const noexcept {
    return offsets_.empty() ? Index{0} : static_cast<Index>(offsets_.size() - 1);
  }
  /// Returns the number of edges, half the number of entries.
  [[nodiscard]] Offset edge_count() const noexcept { return static_cast<Offset>(neighbours_.size() / 2); }
  /// Returns the n + 1 offsets, or none for a default or moved-from graph. Valid while this object lives
  /// unchanged.
  [[nodiscard]] std::span<const Offset> offsets() const& noexcept MESHORDER_LIFETIMEBOUND { return offsets_; }
  [[nodiscard]] std::span<const Index> neighbours() const& noexcept MESHORDER_LIFETIMEBOUND {
    return neighbours_;
  }
  [[nodiscard]] std::span<const double> weights() const& noexcept MESHORDER_LIFETIMEBOUND { return weights_; }
  [[nodiscard]] std::span<const Offset> offsets() const&& = delete;
  [[nodiscard]] std::span<const Index> neighbours() const&& = delete;
  [[nodiscard]] std::span<const double> weights() const&& = delete;

  bool operator==(const Graph&) const = default;

 private:
  std::vector<Offset> offsets_;
  std::vector<Index> neighbours_;
  std::vector<double> weights_;
};

/// Builds the graph that joins all vertices of each element, or of each piece of an element (docs/limits.md).
///
/// @param cells         the cells; elements are those of the highest dimension, others are ignored
/// @param vertex_count  n; vertices that no element uses have no neighbours
/// @param run           threads, progress
/// @throws InvalidArgument for faulty cells: sizes that do not match, a vertex out of range
/// @throws TooLarge for more than 2,147,483,647 vertices or cells, and a graph beyond the memory limit
/// @note O(Σ (vertices of an element)² · log degree). The same graph on any number of threads.
[[nodiscard]] MESHORDER_API Graph vertex_graph(const CellsView& cells, std::size_t vertex_count,
                                               const Run& run = {});

/// Builds the graph that joins elements that share a facet, or elements that share a vertex.
///
/// @param cells         the cells; vertex e of the graph is the e-th cell of the highest dimension
/// @param vertex_count  number of the mesh's vertices
/// @param by_facet      true: join elements that share a face (volumes), an edge (surfaces) or an end
///                      (lines). If more than two elements share a facet, each is joined to the next. A
///                      polyhedron is joined to the elements that have three of its vertices. false: join
///                      elements that share a vertex, about 50 neighbours for a tetrahedron
/// @param run           threads, progress
/// @throws as `vertex_graph`; InvalidArgument for `by_facet` with cells of unknown shape
/// @note By facet O(facets · log facets at a vertex), by vertex O(Σ (elements at a vertex)²).
[[nodiscard]] MESHORDER_API Graph dual_graph(const CellsView& cells, std::size_t vertex_count,
                                             bool by_facet = true, const Run& run = {});

/// Returns a copy of a graph with ascending rows, without loops and repeats; weights of repeats are added.
///
/// @param graph     n vertices; offsets and numbers must be in range
/// @param symmetry  mirror: adds the missing entries, weights become those of (A + Aᵀ) / 2; require: throws
///                  if entries or weights are missing on one side
/// @param run       threads
/// @throws InvalidArgument as `check`, but for asymmetry only under `Symmetry::require`
/// @throws TooLarge for more than 2,147,483,647 vertices
/// @note O(n + entries · log degree) time; memory for one copy of the result and, under `mirror`, one of the
///       input.
[[nodiscard]] MESHORDER_API Graph cleaned(const GraphView& graph, Symmetry symmetry = Symmetry::mirror,
                                          const Run& run = {});

/// Checks that a graph is what the functions of this library accept: see `Check`. Loops, repeats and unsorted
/// rows pass.
///
/// @param graph  its arrays may hold any numbers, but must be as long as the views
/// @param level  what to check
/// @throws InvalidArgument for the first fault; the message names the row, the entry and the fault
/// @throws TooLarge for more than 2,147,483,647 vertices
/// @note O(n + entries) time, on all threads. No memory for int64 offsets and int32 neighbours; for other
///       types as `order_vertices`. If the hash test of symmetry fails, a slower test compares the rows,
///       or a sorted copy of the rows.
MESHORDER_API void check(const GraphView& graph, Check level = Check::full);

}  // namespace v0_3
}  // namespace meshorder
