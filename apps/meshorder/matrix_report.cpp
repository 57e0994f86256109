// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "matrix_report.hpp"

#include "io/matrix/matrix.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

double mean_in_row(const EntryPattern& pattern) {
  return static_cast<double>(pattern.entries()) / std::max<Index>(1, pattern.rows());
}

std::string components_in_words(const ComponentCounts& counts, bool is_graph) {
  const Index joined = counts.components - counts.isolated;
  std::string words = fmt::format("{} component{}", with_commas(joined), joined == 1 ? "" : "s");
  if (counts.isolated == 0) return words;
  const bool one = counts.isolated == 1;
  return words + fmt::format(", {} {} that no {} joins to others", with_commas(counts.isolated),
                             is_graph ? (one ? "vertex" : "vertices") : (one ? "row" : "rows"),
                             is_graph ? "edge" : "entry");
}

void print_pattern(const Console& console, const StoredMatrix& stored, const MatrixReport& report) {
  const PatternFacts& facts = report.facts;
  console.print("{:<12} {}{}", "field", stored.field,
                stored.is_half ? fmt::format("; one half is stored: {}", stored.symmetry) : "");
  console.print("{:<12} mean {:.1f}, most {} entries", "in a row", mean_in_row(report.pattern),
                with_commas(facts.most_in_row));
  console.print("{:<12} {}", "pattern",
                facts.is_symmetric ? "symmetric" : "not symmetric: orders use that of A + A'");
  console.print("{:<12} {}", "diagonal",
                facts.missing_diagonal == 0
                    ? "complete"
                    : fmt::format("{} of {} entries are missing", with_commas(facts.missing_diagonal),
                                  with_commas(report.pattern.rows())));
  if (facts.block > 1) {
    // rounded down: only full blocks show 100 %
    console.print("{:<12} {}×{}, {} % full", "blocks", facts.block, facts.block,
                  static_cast<int>(100 * facts.block_fill));
  }
}

}  // namespace

void print_attachments(const Console& console, const Mesh& mesh, const char* on_vertices,
                       const char* on_cells) {
  const bool is_matrix = stored_matrix(mesh) != nullptr && !stored_matrix(mesh)->is_graph;
  for (const auto& [association, title] :
       {std::pair(Association::vertices, on_vertices), std::pair(Association::cells, on_cells)}) {
    std::vector<std::string> names;
    for (const DataArray& array : mesh.data) {
      if (array.association == association && !(is_matrix && array.name == matrix::kValue))
        names.push_back(visible(array.name));
    }
    for (const EntitySet& set : mesh.sets) {
      if (set.association == association) names.push_back("set " + visible(set.name));
    }
    if (!names.empty()) console.print("{:<12} {}", title, join(names));
  }
}

std::string size_in_words(const StoredMatrix& stored, const EntryPattern& pattern) {
  return stored.is_graph ? fmt::format("{} vertices, {} edges", with_commas(pattern.rows()),
                                       with_commas(pattern.entries() / 2))
                         : fmt::format("{} rows, {} entries", with_commas(pattern.rows()),
                                       with_commas(pattern.entries()));
}

void print_matrix(const Console& console, const Mesh& mesh, const MatrixReport& report,
                  const GraphFacts& graph) {
  const StoredMatrix& stored = *stored_matrix(mesh);
  const PatternFacts& facts = report.facts;
  console.print("{:<12} {}", stored.is_graph ? "graph" : "matrix", size_in_words(stored, report.pattern));
  if (stored.is_graph) {
    console.print("{:<12} mean {:.1f}, most {}", "degree", mean_in_row(report.pattern),
                  with_commas(facts.most_in_row));
  } else {
    print_pattern(console, stored, report);
  }
  if (has_places(mesh)) console.print("{:<12} in {} dimensions", "coordinates", mesh.dimension);
  print_attachments(console, mesh, stored.is_graph ? "on vertices" : "on rows",
                    stored.is_graph ? "on edges" : "on entries");
  console.print("{:<12} {}", "joined", components_in_words(graph.components, stored.is_graph));
  console.print("{:<12} mean {:.1f} {}, mean log2 {:.2f} (a random order: mean {:.0f})", "distance",
                graph.span.mean, stored.is_graph ? "between the ends of an edge" : "from the diagonal",
                graph.span.mean_log2, (mesh.vertex_count() + 1) / 3.0);
  console.print("{:<12} {}", "bandwidth", with_commas(graph.span.max));
  console.print("{:<12} {}", "profile", with_commas(graph.profile));
}

nlohmann::ordered_json to_json(const Mesh& mesh, const MatrixReport& report) {
  const StoredMatrix& stored = *stored_matrix(mesh);
  const PatternFacts& facts = report.facts;
  nlohmann::ordered_json result{
      {"kind", stored.is_graph ? "graph" : "matrix"},
      {"rows", report.pattern.rows()},
      {"entries", report.pattern.entries()},
      {"stored", stored.is_half ? "half" : "all"},
      {"field", or_null(stored.is_graph ? "" : stored.field)},
      {"symmetry", or_null(stored.is_graph ? "" : stored.symmetry)},
      {"in_a_row", {{"mean", mean_in_row(report.pattern)}, {"most", facts.most_in_row}}},
      {"symmetric_pattern", facts.is_symmetric},
      {"missing_diagonal", facts.missing_diagonal},
      {"blocks", nullptr},
      {"distance_histogram_log2", facts.histogram_log2}};
  if (facts.block > 1) result["blocks"] = {{"size", facts.block}, {"fill", facts.block_fill}};
  return result;
}

}  // namespace meshorder::command
