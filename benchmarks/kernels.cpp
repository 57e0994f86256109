// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// kernels [cubes across, default 40 [plain|tuned]]: times the kernels on a lattice of tetrahedra in three
// orders: scrambled, the lattice's own, and along a Hilbert curve. Prints the best time, the rate of
// compulsory memory traffic, and the speedup over the scrambled order.
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "payoff/kernel_timing.hpp"
#include "payoff/memory_probe.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <string>

namespace mo = meshorder;

int main(int argc, char** argv) {
  const mo::Mesh grid = mo::make_grid({.size = argc > 1 ? std::atoi(argv[1]) : 40});
  const std::array<std::array<std::string, 2>, 3> orders{
      {{"scrambled", "scrambled"}, {"original", "original"}, {"hilbert", "lexmax"}}};
  std::vector<std::array<double, mo::kKernels.size()>> bytes(orders.size());
  const auto prepare = [&](mo::Index order) {
    mo::Mesh mesh = grid;
    mo::reorder(mesh, {.methods = {orders[order][0], orders[order][1]}});
    auto bench =
        mo::prepare_kernels(mo::parse_kernels(argc > 2 ? argv[2] : "plain"), mesh, mo::vertex_graph(mesh));
    for (std::size_t k = 0; k < mo::kKernels.size(); ++k) {
      bytes[order][k] = bench->streamed_bytes(mo::kKernels[k]);
    }
    return bench;
  };
  const auto times = mo::time_orders(mo::index_size(orders), prepare).orders;

  fmt::print("{} vertices, {} tetrahedra; one thread reads {:.1f} GB/s\n", grid.vertex_count(),
             grid.cell_count(), mo::read_bandwidth());
  fmt::print("{:<20}{:<10}{:>10}{:>10}{:>8}{:>9}\n", "order", "kernel", "best ms", "median", "GB/s",
             "speedup");
  for (std::size_t i = 0; i < orders.size(); ++i) {
    for (std::size_t k = 0; k < mo::kKernels.size(); ++k) {
      const mo::KernelTimes& t = times[i].times[k];
      fmt::print("{:<20}{:<10}{:>10.3f}{:>10.3f}{:>8.1f}{:>9.2f}\n", orders[i][0],
                 mo::to_string(mo::kKernels[k]), t.best_ms, t.median_ms, 1e-6 * bytes[i][k] / t.best_ms,
                 t.gain.ratio);
    }
  }
}
