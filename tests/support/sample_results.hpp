// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::test {

/// Invented figures of a scenario in an order. The reference's runs take 100 s on average.
struct SampleTimes {
  double mean = 0;
  double half_interval = 0;  ///< of the speedup, in per cent
  std::optional<Index> break_even_step;
};

/// A mesh of 300 vertices and 1000 edges with figures that are simple to check. Kernels have 100 accesses.
/// The scrambled order has a mean span of 100; 80, 40 and 20 misses on this machine and 90, 60 and 50 on the
/// paper's; 2 ms predicted and 1 ms measured. Order k has `share[k]` times these figures.
inline MeshRecord sample_mesh(const std::string& name, const std::vector<OrderingSpec>& orderings,
                              const std::vector<double>& share) {
  MeshRecord mesh;
  mesh.name = name;
  mesh.file = "data/" + name + ".vtu";
  mesh.vertices = 300;
  mesh.tetrahedra = 900;
  mesh.edges = 1000;
  mesh.hierarchies = {{"this machine", {{48 << 10, 1 << 20, 32 << 20}}},
                      {"the paper's Xeon E5-1620 v4", {{32 << 10, 256 << 10, 10 << 20}}}};
  for (std::size_t i = 0; i < orderings.size(); ++i) {
    const auto of = [&share, i](double whole) { return static_cast<Offset>(whole * share[i] + 0.5); };
    MeshOrderRecord order;
    order.ordering = orderings[i].name;
    order.vertex_method = orderings[i].vertices;
    order.element_method = orderings[i].elements;
    order.seconds = orderings[i].name == "original" ? 0 : 0.25 * static_cast<double>(i);
    order.span = {100 * share[i], static_cast<Index>(std::min<Offset>(299, of(299))), 6 * share[i]};
    // `near` edges are in the first bin; all other edges are spread evenly over the other bins
    const Offset near = 1000 - std::min<Offset>(800, of(800));
    const Index far_bins = order.span.max / mesh.span_bin;
    order.span_histogram.assign(static_cast<std::size_t>(far_bins + 1), (1000 - near) / far_bins);
    order.span_histogram.front() = near;
    for (KernelRecord& kernel : order.kernels) {
      kernel = {2 * share[i], share[i], 100, {{of(80), of(40), of(20)}, {of(90), of(60), of(50)}}};
    }
    mesh.orders.push_back(order);
  }
  return mesh;
}

/// Three runs whose sums have this mean and a standard deviation of 0.5 s.
inline std::vector<RunRecord> sample_runs(const ScenarioRecord& scenario, double mean) {
  std::vector<RunRecord> runs(3);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double sum = mean + 0.5 * (static_cast<double>(r) - 1);
    runs[r].began = "2026-11-20T17:3" + std::to_string(r) + ":00Z";
    runs[r].step_seconds.assign(static_cast<std::size_t>(scenario.steps),
                                sum / static_cast<double>(scenario.steps));
    runs[r].seconds.total = sum;
    const bool implicit = scenario.method == "backward-euler";
    (implicit ? runs[r].seconds.assembly : runs[r].seconds.local) = 0.25 * sum;
    (implicit ? runs[r].seconds.solve : runs[r].seconds.global) = 0.5 * sum;
    (implicit ? runs[r].cg_iterations : runs[r].admm_iterations) = 20 * scenario.steps;
    runs[r].setup_seconds = 1.5;
    runs[r].bytes = 10 << 20;
  }
  return runs;
}

/// Fills in the orders of a scenario of 4 steps, and the figures that a study computes from their runs.
inline void add_sample_orders(ScenarioRecord& scenario, const std::vector<OrderingSpec>& orderings,
                              const std::vector<SampleTimes>& times) {
  scenario.precision = "double";
  scenario.fingerprint = "5eed";
  scenario.steps = 4;
  scenario.turn = 2;
  scenario.fixed_addresses = true;
  scenario.processors = {0};
  scenario.frame_steps = {0, 2, 4};
  for (std::size_t i = 0; i < orderings.size(); ++i) {
    const SampleTimes& t = times[i];
    ScenarioOrderRecord order;
    order.ordering = orderings[i].name;
    order.runs = sample_runs(scenario, t.mean);
    order.time = {t.mean, 0.5, t.mean - 0.5};
    if (orderings[i].name != "scrambled") {
      const double percent = 100 - t.mean;
      order.speedup = {.saved_seconds = 100 - t.mean,
                       .percent = percent,
                       .low = percent - t.half_interval,
                       .high = percent + t.half_interval,
                       .beyond_noise = percent - t.half_interval > 0 || percent + t.half_interval < 0,
                       .undisturbed_percent = 100 * (100 - t.mean) / 99.5,
                       .break_even_step = t.break_even_step};
    }
    order.motion = {{0, 1e-15, 2e-12}, 2e-12};
    scenario.orders.push_back(order);
  }
}

/// Two scenarios on one mesh in the paper's five orders, with invented figures. In `falling` orders save
/// time; in `stretch` the original order is within the noise, and the VF scrambled one is slower.
inline StudyResults sample_results() {
  StudyResults results;
  results.began = "2026-11-20T17:30:00Z";
  results.reference = "scrambled";
  results.orderings = {{"original", "Original", "original", "original"},
                       {"fiedler", "Fiedler", "fiedler", "original"},
                       {"vf-fiedler", "VF Fiedler", "fiedler", "fiedler"},
                       {"scrambled", "Scrambled", "scrambled", "original"},
                       {"vf-scrambled", "VF scrambled", "scrambled", "scrambled"}};
  results.machine = {.processor = "Made-up 9000",
                     .cores = 2,
                     .system = "Linux 6.1.0 x86_64",
                     .caches = {{48 << 10, 1 << 20, 32 << 20}},
                     .memory_bytes = std::uint64_t{8} << 30,
                     .read_bandwidth = 12.5,
                     .read_bandwidth_all = 20,
                     .program = "0.1.0",
                     .revision = "",
                     .compiler = "GNU 12.2.0",
                     .flags = "-O3 -DNDEBUG",
                     .simd = "AVX3"};
  results.meshes = {sample_mesh("dragon", results.orderings, {0.5, 0.25, 0.2, 1, 1.1})};

  ScenarioRecord falling;
  falling.name = "falling";
  falling.title = "A body drifts";
  falling.method = "backward-euler";
  falling.material = "corotational";
  falling.mesh = "dragon";
  add_sample_orders(falling, results.orderings,
                    {{90, 1, 1}, {75, 1, 2}, {74, 1, 3}, {100, 0, {}}, {102, 1, {}}});
  ScenarioRecord stretch;
  stretch.name = "stretch";
  stretch.title = "A web of springs stretches";
  stretch.method = "admm";
  stretch.material = "springs";
  stretch.mesh = "dragon";
  add_sample_orders(stretch, results.orderings,
                    {{99.5, 1, 4}, {88, 2, 2}, {75, 2, {}}, {100, 0, {}}, {106, 1, {}}});
  results.scenarios = {falling, stretch};
  return results;
}

}  // namespace meshorder::test
