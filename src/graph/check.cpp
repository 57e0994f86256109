// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "graph/clean_graph.hpp"
#include "graph/examine.hpp"
#include "graph/graph_arrays.hpp"
#include <meshorder/order.hpp>

#include <utility>

namespace meshorder {
inline namespace v0_3 {
namespace {

/// Throws if the graph without its repeats and loops is asymmetric; all entries must be in range. Compares
/// the clean rows, because asymmetric repeats alone also make the hash nonzero.
void refuse_asymmetry_of(const GraphView& view, const GraphArrays& graph, const GraphFindings& findings) {
  if (findings.asymmetry == 0) return;
  if (findings.is_clean()) {
    refuse_asymmetry(graph.offsets, graph.neighbours, graph.weights, view.base);
  } else {
    const OwnedGraph clean = cleaned_copy(graph, findings);
    refuse_asymmetry(clean.offsets, clean.neighbours, clean.weights, view.base);
  }
}

}  // namespace

void check(const GraphView& graph, Check level) {
  if (level == Check::none) return;
  in_arena({}, [&] {
    const GraphArrays arrays = graph_arrays(graph);
    const GraphFindings findings = examine(arrays, level == Check::full);
    refuse_faults(graph, arrays, findings);
    refuse_asymmetry_of(graph, arrays, findings);
  });
}

Graph cleaned(const GraphView& graph, Symmetry symmetry, const Run& run) {
  return in_arena(run, [&] {
    const GraphArrays arrays = graph_arrays(graph);
    const GraphFindings findings = examine(arrays, true);
    refuse_faults(graph, arrays, findings);
    const bool mirror = symmetry == Symmetry::mirror && findings.asymmetry != 0;
    OwnedGraph clean = mirror ? mirrored_copy(arrays) : cleaned_copy(arrays, findings);
    if (!mirror && findings.asymmetry != 0) {
      refuse_asymmetry(clean.offsets, clean.neighbours, clean.weights, graph.base);
    }
    return Graph::adopt(std::move(clean.offsets), std::move(clean.neighbours), std::move(clean.weights));
  });
}

}  // namespace v0_3
}  // namespace meshorder
