// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// cache_misses MESH predict [CACHES]: prints the misses that the cache model predicts for each kernel in the
// file's order, for CACHES such as 48K,1M,32M (default: this machine's), and the cost of the prediction.
// cache_misses MESH KERNEL RUNS: prepares all kernels and runs one of them; benchmarks/cachegrind.py counts
// the misses of this run.
#include "base/stopwatch.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/machine.hpp"

#include <fmt/core.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <exception>
#include <string>

namespace mo = meshorder;

namespace {

void predict(const mo::Mesh& mesh, const mo::Caches& caches) {
  mo::Stopwatch stopwatch;
  const mo::CsrGraph graph = mo::vertex_graph(mesh);
  const double graph_seconds = stopwatch.seconds();
  stopwatch = {};
  const mo::Simplices simplices = mo::cut_into_simplices(mesh);
  fmt::print("graph {:.3f} s, simplices {:.3f} s, caches {}\n", graph_seconds, stopwatch.seconds(),
             mo::to_string(caches));
  for (const mo::Kernel kernel : mo::kKernels) {
    stopwatch = {};
    const mo::RunReuse reuse = mo::reuse_of(kernel, graph, simplices);
    fmt::print("{} seconds {:.3f} accesses {} mean_log2 {:.3f} misses", mo::to_string(kernel),
               stopwatch.seconds(), reuse.all.accesses(), reuse.all.mean_log2());
    for (const mo::Offset misses : mo::misses(reuse.all, caches)) fmt::print(" {}", misses);
    fmt::print("\n");
  }
}

bool run(const mo::Mesh& mesh, const std::string& kernel_name, int runs) {
  for (const mo::Kernel kernel : mo::kKernels) {
    if (mo::to_string(kernel) != kernel_name) continue;
    const auto bench = mo::prepare_kernels(mo::KernelSet::plain, mesh, mo::vertex_graph(mesh));
    for (int i = 0; i < runs; ++i) bench->run(kernel);
    return true;
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string what = argc > 2 ? argv[2] : "";
  const std::string how = argc > 3 ? argv[3] : "";
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  if (what == "predict") {
    predict(mo::read_mesh(argv[1]), mo::parse_caches(how));
    return 0;
  }
  if (what.empty() || !run(mo::read_mesh(argv[1]), what, std::atoi(how.c_str()))) {
    fmt::print(stderr,
               "usage: cache_misses MESH predict [CACHES] | MESH spmv|element|assembly|springs RUNS\n");
    return 2;
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "cache_misses: {}\n", error.what());
  return 2;
}
