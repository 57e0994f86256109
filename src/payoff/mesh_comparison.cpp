// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/mesh_comparison.hpp"

#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "payoff/advice.hpp"
#include "payoff/band.hpp"
#include "payoff/product_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

namespace meshorder {
namespace {

/// Largest number of simplices for which `reuse` suffices; larger meshes need `reuse_of_large`, too. Up to
/// this size the reuse takes a few seconds, and 13 bytes for each line that a kernel touches.
constexpr Offset kQuickReuse = 2'000'000;

void begin_stage(const MeshComparisonOptions& options, const std::string& stage, double from, double to) {
  if (options.begins) options.begins(stage, from, to);
}

MeshMethods taken(const MeshOrder& order) { return {order.vertices.method.name, order.cells.method.name}; }

bool is_own(const MeshOrder& order) {
  return order.vertices.permutation.is_identity() && order.cells.permutation.is_identity();
}

/// Returns the methods without repeats, the mesh's own order first.
std::vector<MeshMethods> each_once(const std::vector<MeshMethods>& methods) {
  std::vector<MeshMethods> result{{"original", "original"}};
  for (const MeshMethods& one : methods) {
    if (std::ranges::find(result, one) == result.end()) result.push_back(one);
  }
  return result;
}

/// Computes the orders. If `auto` keeps the mesh's own order, adds no second order for it.
void add_orders(MeshComparison& comparison, const Mesh& mesh, const KernelInput& input, double graph_seconds,
                const MeshComparisonOptions& options) {
  const bool adds_reuse =
      options.reuse && (options.reuse_of_large || input.simplices().size() <= kQuickReuse);
  const std::vector<MeshMethods> methods = each_once(options.methods);
  const double share = 0.35 / static_cast<double>(methods.size());
  std::optional<MeshMethods> by_auto;
  for (const MeshMethods& asked : methods) {
    if (options.only_new && asked == by_auto) continue;
    const double from = 0.05 + share * static_cast<double>(comparison.orders.size());
    begin_stage(options, "ordering by " + asked.vertices + (input.is_matrix() ? "" : "/" + asked.elements),
                from, from + share);
    const Stopwatch stopwatch;
    ComparedMeshOrder c{
        .asked = asked,
        .order = compute_order_in_file(mesh, input.graph(), {.methods = asked, .order = options.ordering})};
    if (asked.vertices == "auto") {
      by_auto = taken(c.order);
      if (by_auto == methods.front()) {
        comparison.auto_keeps = asked;
        comparison.orders.front().order = std::move(c.order);
        continue;
      }
    }
    if (!comparison.orders.empty()) c.seconds = graph_seconds + stopwatch.seconds();
    c.span = edge_span(input.graph(), c.order.vertices.permutation);
    if (adds_reuse) {
      c.reuse = reuse_of_kernels(input.moved(c.order));
      if (options.iterations) c.iterations = iterations_in(input.graph(), c.order.vertices.permutation);
    }
    comparison.orders.push_back(std::move(c));
  }
}

/// Times the kernels in all orders and on the band, in interleaved rounds.
KernelTable timed(const MeshComparison& comparison, const KernelInput& input, const Band& band, int threads,
                  const TimingOptions& options) {
  KernelTable table;
  table.threads = threads;
  const Index orders = index_size(comparison.orders);
  const auto prepare = [&](Index i) -> std::unique_ptr<KernelBench> {
    if (i < orders) {
      const MeshOrder& order = comparison.orders[i].order;
      auto bench = is_own(order) ? prepare_kernels(comparison.kernel_set, input, threads)
                                 : prepare_kernels(comparison.kernel_set, input.moved(order), threads);
      table.redundancy.push_back(bench->redundancy());
      return bench;
    }
    if (!input.is_matrix()) return prepare_kernels(comparison.kernel_set, band.mesh, band.graph, threads);
    auto bench = std::make_unique<ProductBench>(ideal_pattern(input.pattern()));
    bench->share(threads);
    return bench;
  };
  Timings timings = time_orders(orders + 1, prepare, options);
  table.orders = std::move(timings.orders);
  table.again = timings.again;
  table.steadiness = timings.steadiness;
  table.band = table.orders.back();
  table.orders.pop_back();
  return table;
}

}  // namespace

MeshComparison compare_orders(const Mesh& mesh, const MeshComparisonOptions& options) {
  MeshComparison result{.kernel_set = options.kernels,
                        .workload = options.ordering.workload,
                        .orders = {},
                        .band_span = {},
                        .kernels = {},
                        .kernels_run = kernels_of(mesh)};
  const Stopwatch since_call;
  const Stopwatch building_graph;
  const CsrGraph graph = vertex_graph(mesh);
  const double graph_seconds = building_graph.seconds();
  const KernelInput input(mesh, graph);
  add_orders(result, mesh, input, graph_seconds, options);
  begin_stage(options, "running kernels", 0.4, 1);
  const Band band = ideal_band(input.simplices(), graph);
  result.band_span = edge_span(band.graph, Permutation::identity(band.graph.size()));
  std::vector<int> thread_counts{1};
  if (options.threads > 1) thread_counts.push_back(options.threads);
  const double left = std::max(0.0, options.budget_seconds - since_call.seconds());
  TimingOptions timing{.budget_seconds = left / static_cast<double>(thread_counts.size()),
                       .min_rounds = 2,
                       .in_stretches = true};
  for (const int threads : thread_counts) {
    timing.processor_time = threads == 1;
    result.kernels.push_back(timed(result, input, band, threads, timing));
  }
  return result;
}

std::string parts_in_words(const MeshComparison& comparison) {
  double share = 1;
  std::vector<std::string> of_kernels;
  for (const Kernel kernel : comparison.kernels_run) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < comparison.orders.size(); ++i) {
      double least = 1;
      for (const KernelTable& table : comparison.kernels)
        least = std::min(least, table.orders[i][kernel].share);
      share = std::min(share, least);
      const MeshOrder& order = comparison.orders[i].order;
      if (least < 1)
        names.push_back(order_in_words({.vertices = order.vertices.method, .elements = order.cells.method}));
    }
    if (!names.empty())
      of_kernels.push_back(
          fmt::format("{} in {}", kKernelTitles[static_cast<std::size_t>(kernel)], join(names)));
  }
  if (of_kernels.empty()) return {};
  return fmt::format("slow, so computed from the time of 1/{:.0f} of the elements: {}", 1 / share,
                     join(of_kernels, std::string_view("; ")));
}

Advice advice_of(const MeshComparison& comparison) {
  const KernelTable& table = comparison.kernels.back();
  Advice advice;
  advice.threads = table.threads;
  advice.kernel_set = comparison.kernel_set;
  advice.is_matrix = comparison.is_matrix();
  advice.doubt = reason_to_doubt(table.steadiness);
  const auto candidate_of = [&](std::size_t i) {
    const ComparedMeshOrder& c = comparison.orders[i];
    Candidate candidate{.vertices = c.order.vertices.method,
                        .elements = c.order.cells.method,
                        .workload = comparison.workload,
                        .order_seconds = c.seconds};
    KernelMilliseconds& milliseconds = candidate.costs.measured.emplace();
    auto& gains = candidate.costs.gains.emplace();
    for (const Kernel kernel : comparison.kernels_run) {
      milliseconds[static_cast<std::size_t>(kernel)] = table.orders[i][kernel].best_ms;
      gains[static_cast<std::size_t>(kernel)] = table.orders[i][kernel].gain;
    }
    return candidate;
  };
  advice.as_is = candidate_of(0);
  for (std::size_t i = 1; i < comparison.orders.size(); ++i) advice.candidates.push_back(candidate_of(i));
  advice.kernels = kernel_advice(advice);
  return advice;
}

}  // namespace meshorder
