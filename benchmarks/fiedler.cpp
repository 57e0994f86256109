// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Measures what a Fiedler vector costs: `fiedler [MESH | grid-N]…`. grid-N is a lattice of N cubes in every
// direction, its vertices scrambled. Prints for each mesh:
// - the time from cells to graph;
// - the time from the graph to the vector, at two accuracies, on one and two threads: medians of five runs;
// - the mean edge span of the order by the vector;
// - the memory that the solver took, relative to that of the graph.
#include "spectral/fiedler.hpp"

#include "base/stopwatch.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "peak_memory.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <string>

namespace {

using namespace meshorder;

template <class Work>
double median_milliseconds(Work work) {
  std::array<double, 5> seconds{};
  for (double& s : seconds) {
    const Stopwatch stopwatch;
    work();
    s = stopwatch.seconds();
  }
  std::sort(seconds.begin(), seconds.end());
  return 1e3 * seconds[2];
}

/// Measures five runs on one thread, then five on two, and prints both medians.
void measure(const CsrGraph& graph, double tolerance) {
  FiedlerVectors result;
  std::array<double, 2> milliseconds{};
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    milliseconds[threads - 1] =
        median_milliseconds([&] { result = fiedler_vectors(graph, {.tolerance = tolerance}); });
  }
  const FiedlerComponent& largest = result.components.front();
  const Order order = order_graph("fiedler", {graph, {}}, {.tolerance = tolerance});
  fmt::print(
      "  tolerance {:<7g} {:8.1f} ms, two threads {:8.1f} ms ({:.2f}x) {:3} iterations  lambda2 {:.6e}  "
      "residual/lambda2 {:.2g}{}  mean span {:.1f}\n",
      tolerance, milliseconds[0], milliseconds[1], milliseconds[0] / milliseconds[1], largest.iterations,
      largest.lambda2, largest.residual / largest.lambda2, largest.converged ? "" : " (not converged)",
      edge_span(graph, order.permutation).mean);
}

void report(const std::string& name) {
  Mesh mesh;
  if (name.rfind("grid-", 0) == 0) {
    mesh = make_grid({.size = std::stoi(name.substr(5))});
    reorder(mesh, {.methods = {"scrambled", "scrambled"}});
  } else {
    mesh = read_mesh(name);
  }
  CsrGraph graph;
  double graph_milliseconds = 0;
  {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    graph_milliseconds = median_milliseconds([&] { graph = vertex_graph(mesh); });
  }
  const PeakMemory memory;
  (void)fiedler_vectors(graph);
  const double graph_bytes =
      static_cast<double>(sizeof(Offset) * graph.offsets.size() + sizeof(Index) * graph.neighbours.size());
  fmt::print(
      "{}: {} vertices, {} edges; from cells to graph {:.1f} ms; the solver takes {:.1f} times its memory\n",
      name, graph.size(), graph.edge_count(), graph_milliseconds,
      static_cast<double>(memory.bytes()) / graph_bytes);
  for (const double tolerance : {0.1, 1e-5}) measure(graph, tolerance);
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) report(argv[i]);
}
