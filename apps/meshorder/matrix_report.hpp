// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "graph/traversal.hpp"
#include "mesh/stored_matrix.hpp"
#include "metrics/edge_span.hpp"

#include <nlohmann/json_fwd.hpp>

namespace meshorder::command {

/// Counts of the vertex graph of a mesh; for a matrix A, of the graph of A + A′.
struct GraphFacts {
  ComponentCounts components;
  EdgeSpan span;
  Offset profile = 0;
  std::vector<Offset> histogram;
};

/// The report of `info` on a matrix or graph.
struct MatrixReport {
  EntryPattern pattern;
  PatternFacts facts;
};

/// Prints the names of arrays and sets, except a matrix's values.
void print_attachments(const Console& console, const Mesh& mesh, const char* on_vertices,
                       const char* on_cells);

/// Prints the report in terms of matrices, or of graphs. `mesh` is as it was read.
void print_matrix(const Console& console, const Mesh& mesh, const MatrixReport& report,
                  const GraphFacts& graph);

/// Returns the object `matrix` of docs/json.md.
nlohmann::ordered_json to_json(const Mesh& mesh, const MatrixReport& report);

/// Returns "8,000 rows, 53,600 entries", or "8,000 vertices, 22,800 edges".
std::string size_in_words(const StoredMatrix& stored, const EntryPattern& pattern);

}  // namespace meshorder::command
