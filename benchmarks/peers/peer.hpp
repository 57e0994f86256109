// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Shared by the programs that compare.py runs: `peer-NAME GRAPH TOLERANCE VECTOR` reads the folder that
// `peer-graph_of` wrote, times its solver, and writes the vector.
#pragma once

#include "base/stopwatch.hpp"
#include "graph/csr_graph.hpp"
#include "io/npy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace peer {

using namespace meshorder;

struct Arguments {
  CsrGraph graph;
  double tolerance;              ///< in the solver's own sense
  std::filesystem::path vector;  ///< file to write
};

inline Arguments read_arguments(int argc, char** argv) {
  if (argc < 4) throw std::runtime_error("usage: peer-NAME GRAPH TOLERANCE VECTOR");
  const std::filesystem::path folder = argv[1];
  Arguments result{{}, std::atof(argv[2]), argv[3]};
  const std::vector<std::int64_t> offsets = read_npy(folder / "offsets.npy");
  const std::vector<std::int64_t> neighbours = read_npy(folder / "neighbours.npy");
  result.graph.offsets.assign(offsets.begin(), offsets.end());
  result.graph.neighbours.assign(neighbours.begin(), neighbours.end());
  return result;
}

/// A matrix in compressed sparse rows with ascending columns, in the types that all the peers take.
struct Matrix {
  int size = 0;
  std::vector<int> offsets{0};
  std::vector<int> columns;
  std::vector<double> values;
};

/// Returns the graph's Laplacian with `shift` added to its diagonal.
inline Matrix laplacian(const CsrGraph& graph, double shift = 0) {
  Matrix result;
  result.size = static_cast<int>(graph.size());
  for (Index v = 0; v < graph.size(); ++v) {
    bool diagonal_done = false;
    const auto put_diagonal = [&] {
      result.columns.push_back(static_cast<int>(v));
      result.values.push_back(graph.degree(v) + shift);
      diagonal_done = true;
    };
    for (const Index u : graph[v]) {
      if (u > v && !diagonal_done) put_diagonal();
      result.columns.push_back(static_cast<int>(u));
      result.values.push_back(-1);
    }
    if (!diagonal_done) put_diagonal();
    result.offsets.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

/// Solves up to three times, but not again after a second; prints the least seconds and writes the vector.
template <class Solve>
void measure(const std::filesystem::path& vector, const Solve& solve) {
  std::vector<double> values;
  double best = 0;
  const Stopwatch all;
  for (int run = 0; run < 3 && (run == 0 || all.seconds() < 1); ++run) {
    const Stopwatch stopwatch;
    values = solve();
    const double seconds = stopwatch.seconds();
    best = run == 0 ? seconds : std::min(best, seconds);
  }
  std::ofstream file(vector, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(double)));
  fmt::print("{}\n", best);
}

/// Runs `solver(arguments)` as a peer's `main`; prints errors on stderr. Returns the exit status.
template <class Solver>
int run(int argc, char** argv, const Solver& solver) {
  try {
    solver(read_arguments(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 1;
  }
}

}  // namespace peer
