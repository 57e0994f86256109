// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// What a Fiedler vector costs, from a ready graph, on one thread: `fiedler MESH…`. Prints the median of five
// runs at two accuracies, with the mean edge span of the order that follows.
#include <meshorder/base/stopwatch.hpp>
#include <meshorder/io/format.hpp>
#include <meshorder/mesh/graphs.hpp>
#include <meshorder/metrics/edge_span.hpp>
#include <meshorder/ordering/method.hpp>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>

namespace {

using namespace meshorder;

void measure(const CsrGraph& graph, double tolerance) {
  std::array<double, 5> seconds{};
  FiedlerResult result;
  for (double& s : seconds) {
    const Stopwatch stopwatch;
    result = fiedler_vector(graph, {.tolerance = tolerance});
    s = stopwatch.seconds();
  }
  std::sort(seconds.begin(), seconds.end());
  const FiedlerComponent& largest = result.components.front();
  const Ordering order = order_vertices("fiedler", {graph, {}}, {.tolerance = tolerance});
  fmt::print(
      "  tolerance {:<7g} {:8.1f} ms  {:3} iterations  lambda2 {:.6e}  residual/lambda2 {:.2g}{}  mean span "
      "{:.1f}\n",
      tolerance, 1e3 * seconds[2], largest.iterations, largest.lambda2, largest.residual / largest.lambda2,
      largest.converged ? "" : " (not converged)", edge_span(graph, order.permutation).mean);
}

}  // namespace

int main(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  for (int i = 1; i < argc; ++i) {
    const Mesh mesh = read_mesh(argv[i]);
    const Stopwatch stopwatch;
    const CsrGraph graph = vertex_graph(mesh);
    fmt::print("{}: {} vertices, {} edges, graph built in {:.1f} ms\n", argv[i], graph.size(),
               graph.edge_count(), 1e3 * stopwatch.seconds());
    for (const double tolerance : {0.1, 1e-5}) measure(graph, tolerance);
  }
}
