// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "io/format.hpp"
#include "mesh/groups.hpp"
#include "mesh/stored_matrix.hpp"
#include "metrics/edge_span.hpp"
#include <meshorder/mesh.hpp>

#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {

// The report of `order` on its result; the page in browser/ shows this report as well.

/// The edge spans of the vertices before and after reordering.
struct SpanChange {
  EdgeSpan before;
  EdgeSpan after;
};

/// Returns the lines of the result: the methods with their reasons, the groups, the spans.
///
/// @param stored  null unless the mesh is a matrix or graph
std::vector<std::string> lines_of_order(const MeshOrder& order, const std::optional<Grouping>& groups,
                                        const SpanChange& spans, const StoredMatrix* stored);

/// Adds a note if the method requested by name does not improve the order of the vertices. `graph` is the
/// graph before reordering.
void note_no_better(GraphRef graph, const ReorderOptions& options, const Permutation& vertices, Notes& notes);

/// Adds a note if the method requested by name does not improve the order of the elements. `mesh` has been
/// reordered by `cells`.
void note_no_better(const Mesh& mesh, const ReorderOptions& options, const Permutation& cells, Notes& notes);

/// Returns whether vertices or cells have other numbers in an output of the format `to` than in the input.
/// `mesh` has been reordered.
bool has_new_numbers(const Mesh& mesh, const MeshOrder& order, const Format& to, Ids ids);

}  // namespace meshorder::command
