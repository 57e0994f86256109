// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Measures how often an order reports its progress, and how soon it stops: `progress [N] [METHOD…]`. On a
// lattice of N³ cubes, six tetrahedra each, its vertices scrambled (default N = 122: 1.86 million vertices),
// for every method: the time of the call, the longest time between two calls of the progress function (from
// the beginning and to the end, too), and the longest time from the moment that this function returns false
// to the exception, over stops at five moments of the call.
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/registry.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace meshorder;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Gap {
  double seconds = 0;
  std::string after = "check";  ///< the stage in which the gap began
};

/// Returns the time of `call(run)`, and the longest gap between its start, its progress calls and its end.
template <class Call>
std::pair<double, Gap> longest_gap(const Call& call) {
  const auto start = Clock::now();
  auto last = start;
  Gap longest;
  std::string stage = "start";
  const auto note = [&] {
    const double gap = seconds_since(last);
    if (gap > longest.seconds) longest = {gap, stage};
    last = Clock::now();
  };
  call({.progress = [&](const Progress& progress) {
    note();
    stage = progress.stage;
    return true;
  }});
  note();
  return {seconds_since(start), longest};
}

/// Returns the time from the progress function's last false, at least `after` s into the call, to Stopped.
template <class Call>
double time_to_stop(const Call& call, double after) {
  const auto start = Clock::now();
  Clock::time_point asked;
  bool is_asked = false;
  try {
    call({.progress = [&](const Progress&) {
      if (seconds_since(start) < after) return true;
      asked = Clock::now();
      is_asked = true;
      return false;
    }});
  } catch (const Stopped&) {
    return seconds_since(asked);
  }
  return is_asked ? seconds_since(asked) : 0;
}

template <class Call>
void measure(const std::string& name, const Call& call) {
  const auto [seconds, gap] = longest_gap(call);
  double stop = 0;
  for (int k = 0; k < 5; ++k) stop = std::max(stop, time_to_stop(call, seconds * k / 5));
  fmt::print("{:<24} {:7.2f} s   longest gap {:5.3f} s after '{}'   stops within {:5.3f} s\n", name, seconds,
             gap.seconds, gap.after, stop);
  std::fflush(stdout);
}

bool is_wanted(const std::vector<std::string>& wanted, const std::string& name) {
  return (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end()) &&
         name.rfind("metis", 0) != 0 && name != "auto";
}

}  // namespace

int main(int argc, char** argv) {
  const int size = argc > 1 ? std::atoi(argv[1]) : 122;
  const std::vector<std::string> wanted(argv + std::min(argc, 2), argv + argc);
  Mesh mesh = make_grid({.size = size});
  reorder(mesh, {.methods = {"scrambled", "scrambled"}});
  const CsrGraph graph = vertex_graph(mesh);
  const PointsView points(mesh.points);
  fmt::print("{} vertices, {} edges\n", graph.size(), graph.edge_count());
  for (const MethodInfo& method : vertex_methods()) {
    if (!is_wanted(wanted, method.name)) continue;
    measure("vertices " + method.name, [&](const Run& run) {
      (void)order_vertices({graph.offsets, graph.neighbours}, method.name, {.run = run}, points);
    });
  }
  const CellsView cells = CellsView::mixed(mesh.cells.offsets, mesh.cells.vertices, mesh.cells.shapes);
  const Permutation vertices = Permutation::identity(graph.size());
  for (const MethodInfo& method : element_methods()) {
    if (!is_wanted(wanted, method.name)) continue;
    measure("elements " + method.name, [&](const Run& run) {
      (void)order_elements(cells, vertices, method.name, {.run = run}, points);
    });
  }
}
