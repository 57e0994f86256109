// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "order_report.hpp"

#include "mesh/graphs.hpp"
#include "ordering/judgement.hpp"
#include "ordering/method.hpp"
#include "payoff/quantities.hpp"
#include "wording.hpp"

#include <fmt/format.h>

namespace meshorder::command {

std::vector<std::string> lines_of_order(const MeshOrder& order, const std::optional<Grouping>& groups,
                                        const SpanChange& spans, const StoredMatrix* stored) {
  std::vector<std::string> lines;
  const auto& [before, after] = spans;
  const bool is_matrix = stored != nullptr && !stored->is_graph;
  const auto add_method = [&](const char* of, const MethodChoice& method, double seconds) {
    lines.push_back(fmt::format("{:<10} {:<14} {}", of, method_in_words(method), duration(seconds)));
    if (!method.reason.empty()) lines.push_back(fmt::format("{:<10} {}", "", method.reason));
  };
  add_method(is_matrix ? "rows" : "vertices", order.vertices.method, order.vertices.seconds);
  // entries stay unless a method is named for them; a graph's file lists edges in the order of its vertices
  const bool entries_stay = stored != nullptr && !order.cells.method.reason.empty();
  if (!entries_stay)
    add_method(stored != nullptr ? "entries" : "elements", order.cells.method, order.cells.seconds);
  else if (is_matrix)
    lines.push_back(fmt::format("{:<10} keep their places in the file", "entries"));
  if (groups) lines.push_back(fmt::format("{:<10} {}", "groups", groups_in_words(*groups)));
  lines.push_back(fmt::format("{:<10} mean {:.1f} → {:.1f}, largest {} → {}, mean log2 {:.2f} → {:.2f}",
                              stored != nullptr ? "distance" : "edge span", before.mean, after.mean,
                              with_commas(before.max), with_commas(after.max), before.mean_log2,
                              after.mean_log2));
  return lines;
}

void note_no_better(GraphRef graph, const ReorderOptions& options, const Permutation& vertices,
                    Notes& notes) {
  const std::string& method = options.methods.vertices;
  if (method == "auto" || method == "original" || method == "scrambled" || !options.group_by.empty()) return;
  const std::string reason = reason_to_keep(graph, vertices, method, made_for(method));
  if (!reason.empty()) notes.push_back(reason + "; --vertices original keeps the order");
}

void note_no_better(const Mesh& mesh, const ReorderOptions& options, const Permutation& cells, Notes& notes) {
  const std::string& method = options.methods.elements;
  if (method == "auto" || method == "original" || method == "scrambled" || !options.group_by.empty()) return;
  const CellSelection elements = CellSelection::elements(cell_arrays(mesh));
  const Permutation as_written = Permutation::identity(elements.size());
  std::vector<Index> element_of(static_cast<std::size_t>(cells.size()), -1);  // of each cell
  for (Index e = 0; e < elements.size(); ++e) element_of[elements.cell(e)] = e;
  std::vector<Index> as_it_was;
  as_it_was.reserve(static_cast<std::size_t>(elements.size()));
  for (const Index cell : cells.old_to_new()) {
    if (element_of[cell] >= 0) as_it_was.push_back(element_of[cell]);
  }
  const std::string reason =
      reason_to_keep_elements(elements.incidence(), as_it_was, as_written.new_to_old(), method);
  if (!reason.empty()) notes.push_back(reason + "; --elements original keeps the order");
}

bool has_new_numbers(const Mesh& mesh, const MeshOrder& order, const Format& to, Ids ids) {
  const bool are_moved = !order.vertices.permutation.is_identity() || !order.cells.permutation.is_identity();
  const bool are_bound = mesh.format_metadata != nullptr && mesh.format_metadata->binds_ids();
  return are_moved && !are_bound && ids != Ids::keep && to.has_numbers;
}

}  // namespace meshorder::command
