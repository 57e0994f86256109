// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// hard_graphs: runs the Fiedler solver on graphs that are not meshes, on one thread; prints time, iterations,
// λ₂ and its exact value if known, the residual, and whether the solver converged.
#include "base/stopwatch.hpp"
#include "spectral/fiedler.hpp"
#include "support/sample_graphs.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace meshorder;

void report(const std::string& name, const CsrGraph& graph, std::optional<double> exact = {},
            const std::vector<double>& weights = {}) {
  const Stopwatch stopwatch;
  const FiedlerVectors result = weights.empty() ? fiedler_vectors(graph) : fiedler_vectors(graph, weights);
  const double seconds = stopwatch.seconds();
  const FiedlerComponent& largest = result.components.front();
  int unfinished = 0;
  for (const FiedlerComponent& component : result.components) unfinished += component.converged ? 0 : 1;
  fmt::print("{:<46} {:>9} {:>9.3f} {:>5} {:>12.5g} {:>12} {:>10.2g} {}\n", name, graph.size(), seconds,
             largest.iterations, largest.lambda2, exact ? fmt::format("{:.5g}", *exact) : "",
             largest.lambda2 > 0 ? largest.residual / largest.lambda2 : 0.0,
             unfinished == 0 ? "" : fmt::format("{} not converged", unfinished));
}

/// Returns weights spread evenly over `decades` decades. An edge has the same weight in both of its rows.
std::vector<double> weights_over(const CsrGraph& graph, double decades) {
  std::vector<double> weights;
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) {
      const auto hash = (7919LL * std::min(u, v) + 104729LL * std::max(u, v)) % 1000;
      weights.push_back(std::pow(10.0, decades * (static_cast<double>(hash) / 1000 - 0.5)));
    }
  }
  return weights;
}

}  // namespace

int main() {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto path_lambda2 = [](Index n) { return 2 - 2 * std::cos(std::numbers::pi / n); };
  fmt::print("{:<46} {:>9} {:>9} {:>5} {:>12} {:>12} {:>10}\n", "graph", "vertices", "seconds", "its.",
             "lambda2", "exact", "residual");
  report("path", test::path(1'000'000), path_lambda2(1'000'000));
  report("cycle", test::cycle(1'000'000), 2 - 2 * std::cos(2 * std::numbers::pi / 1e6));
  report("star", test::star(1'000'000), 1.0);
  report("complete graph", test::complete(3000), 3000.0);
  report("hypercube of 17 dimensions", test::hypercube(17), 2.0);
  report("random regular graph of degree 6", test::random_regular(100'000, 6, 1));
  report("random tree with as many edges again", test::random_connected(100'000, 100'000, 1));
  report("preferential attachment, 3 edges a vertex", test::preferential_attachment(100'000, 3, 1));
  report("100,000 paths of 10", test::disjoint_union(std::vector<CsrGraph>(100'000, test::path(10))),
         path_lambda2(10));
  const CsrGraph grid = test::grid(300, 300);
  report("grid, weights over 6 decades", grid, {}, weights_over(grid, 6));
  report("grid, weights over 12 decades", grid, {}, weights_over(grid, 12));
}
