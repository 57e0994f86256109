// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Measures what the checks of `order_vertices` cost: `checks [N] [ROUNDS]`. On a lattice of N³ cubes, six
// tetrahedra each, its vertices scrambled (default N = 122: 1.86 million vertices), on one thread: the time
// of some methods at `Check::none`, and what `fast`, `full` and arrays of other integer types add to it.
// Medians of interleaved rounds.
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/order.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

using namespace meshorder;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double seconds_of(const GraphView& graph, const char* method, Check check) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  (void)order_vertices(graph, method, {.check = check, .run = {.threads = 1}});
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  const int size = argc > 1 ? std::atoi(argv[1]) : 122;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  Mesh mesh = make_grid({.size = size});
  (void)reorder(mesh, {.methods = {"scrambled", "original"}});
  const CsrGraph graph = vertex_graph(mesh);
  const std::vector<std::int32_t> narrow_offsets(graph.offsets.begin(), graph.offsets.end());
  const std::vector<std::int64_t> wide_neighbours(graph.neighbours.begin(), graph.neighbours.end());
  const GraphView own{.offsets = graph.offsets, .neighbours = graph.neighbours};
  const GraphView narrow{.offsets = narrow_offsets, .neighbours = graph.neighbours};
  const GraphView wide{.offsets = graph.offsets, .neighbours = wide_neighbours};
  struct Way {
    const char* name;
    const GraphView& graph;
    Check check;
  };
  const std::array ways{Way{"none", own, Check::none}, Way{"fast", own, Check::fast},
                        Way{"full", own, Check::full}, Way{"full, int32 offsets", narrow, Check::full},
                        Way{"full, int64 neighbours", wide, Check::full}};
  fmt::print("{} vertices, {} edges\n", graph.size(), graph.edge_count());
  for (const char* const method : {"rcm", "bfs", "fiedler"}) {
    std::array<std::vector<double>, ways.size()> seconds;
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t w = 0; w < ways.size(); ++w) {
        seconds[w].push_back(seconds_of(ways[w].graph, method, ways[w].check));
      }
    }
    const double none = median(seconds[0]);
    fmt::print("{:<8} none {:.3f} s", method, none);
    for (std::size_t w = 1; w < ways.size(); ++w) {
      fmt::print("   {} {:+.1f} %", ways[w].name, 100 * (median(seconds[w]) / none - 1));
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
}
