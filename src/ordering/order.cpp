// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The public functions: they check the caller's input, convert it to the library's types, and call the
// method.
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "cells/facets.hpp"
#include "cells/vertex_joins.hpp"
#include "graph/clean_graph.hpp"
#include "ordering/grouped.hpp"
#include "ordering/method.hpp"
#include "ordering/order_cells.hpp"
#include "ordering/point_checks.hpp"
#include "spectral/fiedler.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>

#include <string>
#include <utility>

namespace meshorder {
inline namespace v0_3 {
namespace {

void append(std::vector<std::string>& notes, const std::vector<std::string>& more) {
  notes.insert(notes.end(), more.begin(), more.end());
}

/// Returns the points. If the method uses points and these do not fit the graph, adds a note, and for `auto`
/// returns no points.
PointsView usable_points(const PointsView& points, GraphRef graph, std::string_view method,
                         std::vector<std::string>& notes) {
  if (points.empty()) return points;
  const bool goes_by_points = method == "auto" || needs_points(vertex_methods(), method);
  if (!goes_by_points || points_fit(graph, points)) return points;
  const bool is_auto = method == "auto";
  notes.push_back(std::string("neighbours are as far apart as any two points") +
                  (is_auto ? ", so auto does not use the coordinates" : "") +
                  ": is an array transposed, or of another mesh?");
  return is_auto ? PointsView() : points;
}

Graph adopted(CsrGraph&& graph) {
  return Graph::adopt(std::move(graph.offsets), std::move(graph.neighbours));
}

}  // namespace

Order order_vertices(const GraphView& graph, std::string_view method, const OrderOptions& options,
                     const PointsView& points) {
  return in_call(options.run, [&] {
    const Stopwatch stopwatch;
    report("check");
    const GraphArrays clean = clean_graph(graph, options.check, options.symmetry);
    check_finite(points, static_cast<std::size_t>(clean.size()), options.check);
    const GraphRef clean_rows(clean.offsets, clean.neighbours);
    std::vector<std::string> notes = clean.notes;
    const PointsView usable = usable_points(points, clean_rows, method, notes);
    Order result = order_vertices_by_options(method, {clean_rows, usable, clean.weights}, options);
    append(result.notes, notes);
    result.seconds = stopwatch.seconds();
    return result;
  });
}

Order order_elements(const CellsView& cells, const Permutation& vertices, std::string_view method,
                     const OrderOptions& options, const PointsView& points) {
  return in_call(options.run, [&] {
    const Stopwatch stopwatch;
    report("check");
    const CellArrays arrays = cell_arrays(cells, static_cast<std::size_t>(vertices.size()), options.check);
    check_finite(points, static_cast<std::size_t>(vertices.size()), options.check);
    Order result = order_cells(method, arrays, vertices, points, options.cell_groups, options);
    append(result.notes, arrays.notes);
    result.seconds = stopwatch.seconds();
    return result;
  });
}

Permutation order_edges(const IndexView& ends, const Permutation& vertices, const Run& run) {
  if (ends.size() % 2 != 0)
    throw InvalidArgument("order_edges: " + std::to_string(ends.size()) + " ends, must be two for each edge");
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (ends[k] >= 0 && ends[k] < vertices.size()) continue;
    throw InvalidArgument("order_edges: end " + std::to_string(k) + " is " + std::to_string(ends[k]) +
                          ", outside 0 … " + std::to_string(vertices.size() - 1));
  }
  return order_elements(CellsView::uniform(Shape::line, 2, ends), vertices, "lexmax",
                        {.check = Check::none, .run = run})
      .permutation;
}

MeshOrder order_mesh(const MeshView& mesh, const MeshMethods& methods, const OrderOptions& options) {
  return in_call(options.run, [&] {
    const Stopwatch vertex_time;
    report("check");
    const std::size_t n = vertex_count_of(mesh);
    const CellArrays arrays = cell_arrays(mesh.cells, n, options.check);
    check_finite(mesh.points, n, options.check);
    MeshOrder result;
    {
      report("graph");
      const CsrGraph graph = vertex_graph(arrays);
      std::vector<std::string> notes;
      const PointsView usable = usable_points(mesh.points, graph, methods.vertices, notes);
      result.vertices = order_vertices_by_options(methods.vertices, {graph, usable}, options);
      append(result.vertices.notes, notes);
      result.vertices.seconds = vertex_time.seconds();
    }
    const Stopwatch cell_time;
    result.cells = order_cells(methods.elements, arrays, result.vertices.permutation, mesh.points,
                               options.cell_groups, options);
    result.cells.seconds = cell_time.seconds();
    append(result.cells.notes, arrays.notes);
    return result;
  });
}

Graph vertex_graph(const CellsView& cells, std::size_t vertex_count, const Run& run) {
  return in_call(run, [&] {
    report("graph");
    const CellArrays arrays = cell_arrays(cells, vertex_count, Check::full);
    return adopted(vertex_graph(arrays));
  });
}

Graph dual_graph(const CellsView& cells, std::size_t vertex_count, bool by_facet, const Run& run) {
  return in_call(run, [&] {
    report("graph");
    const CellArrays arrays = cell_arrays(cells, vertex_count, Check::full);
    const CellSelection elements = CellSelection::elements(arrays);
    return adopted(by_facet ? joined_by_facet(arrays, elements) : joined_by_vertex(elements.incidence()));
  });
}

Fiedler fiedler_vector(const GraphView& graph, const OrderOptions& options) {
  return in_call(options.run, [&] {
    report("check");
    const GraphArrays clean = clean_graph(graph, options.check, options.symmetry);
    FiedlerVectors vectors =
        fiedler_vectors({clean.offsets, clean.neighbours}, clean.weights, solver_options(options));
    Fiedler result;
    result.component_of.resize(vectors.values.size());
    for (std::size_t c = 0; c < vectors.component_vertices.size(); ++c) {
      for (const Index v : vectors.component_vertices[c]) {
        result.component_of[static_cast<std::size_t>(v)] = static_cast<Index>(c);
      }
    }
    result.values = std::move(vectors.values);
    result.components = std::move(vectors.components);
    result.complete = vectors.complete;
    result.notes = clean.notes;
    return result;
  });
}

}  // namespace v0_3
}  // namespace meshorder
