// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Measures the cost of one order, in a process of its own for its peak memory; scaling.py runs it.
//   scaling make CUBES FILE               a grid of tetrahedra, CUBES across, scrambled
//   scaling vertices|elements METHOD FILE prints vertices, elements, seconds, MB before, MB at the peak
// Elements are ordered on vertices in Hilbert order. Memory includes the mesh and its graph.
#include "base/stopwatch.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "ordering/method.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace mo = meshorder;

namespace {

/// Returns, in MB, the number in a line of /proc/self/status, which is in kB.
double megabytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key + ":")) return std::atof(line.c_str() + key.size() + 1) / 1e3;
  }
  return 0;
}

void make(mo::Index cubes, const std::string& file) {
  mo::Mesh mesh = mo::make_grid({.size = cubes});
  mo::reorder(mesh, {.methods = {"scrambled", "scrambled"}});
  mo::write_mesh(mesh, file);
}

void measure(bool of_vertices, const std::string& method, const std::string& file) {
  const mo::Mesh mesh = mo::read_mesh(file);
  const mo::CsrGraph graph = mo::vertex_graph(mesh);
  std::ofstream("/proc/self/clear_refs") << "5";  // forgets the peak so far
  const double before = megabytes("VmRSS");
  double seconds = 0;
  if (of_vertices) {
    const mo::Stopwatch stopwatch;
    (void)mo::order_graph(method, {graph, mesh.points});
    seconds = stopwatch.seconds();
  } else {
    seconds = mo::compute_reordering(mesh, graph, {.methods = {"hilbert", method}}).cells.seconds;
  }
  fmt::print("{} {} {:.6f} {:.1f} {:.1f}\n", mesh.vertex_count(), mesh.cell_count(), seconds, before,
             megabytes("VmHWM"));
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string what = argc == 4 ? argv[1] : "";
  if (what == "make") {
    make(std::atoi(argv[2]), argv[3]);
  } else if (what == "vertices" || what == "elements") {
    measure(what == "vertices", argv[2], argv[3]);
  } else {
    fmt::print(stderr, "usage: scaling make CUBES FILE | scaling vertices|elements METHOD FILE\n");
    return 2;
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "scaling: {}\n", error.what());
  return 2;
}
