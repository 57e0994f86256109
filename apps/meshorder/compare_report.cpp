// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "compare_report.hpp"

#include "reuse_report.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace meshorder::command {
namespace {

constexpr const char* kFloor = "band";

/// Returns the time divided by the band's. Both are taken relative to the reference, since orders that do not
/// fit into memory together are timed in groups, each with the reference.
double of_floor(const KernelTimes& times, const KernelTimes& floor) { return floor.speedup / times.speedup; }

void print_quality(const Console& console, const Comparison& comparison) {
  console.print("\n{:<11} {:<14} {:>8} {:>12} {:>10} {:>10}", "vertices", "elements", "cost", "span: mean",
                "max", "mean log2");
  const auto print_row = [&](const std::string& vertices, const std::string& elements,
                             const std::string& cost, const EdgeSpan& span) {
    console.print("{:<11} {:<14} {:>8} {:>12.1f} {:>10} {:>10.2f}", vertices, elements, cost, span.mean,
                  with_commas(span.max), span.mean_log2);
  };
  for (const ComparedOrder& c : comparison.orders) {
    print_row(c.vertices, c.elements, duration(c.order.vertices.seconds + c.order.cells.seconds), c.span);
  }
  print_row(kFloor, kFloor, "-", comparison.floor_span);
  for (const ComparedOrder& c : comparison.orders) {
    const MethodChoice& taken = c.order.vertices.method;
    if (!taken.reason.empty()) console.print("auto takes {}: {}", taken.name, taken.reason);
  }
}

void print_reuse(const Console& console, const Comparison& comparison) {
  if (!comparison.orders.front().reuse) {
    console.log("not shown, to save time on a large mesh: cache misses; --cache this predicts them");
    return;
  }
  console.print("\nPredicted for each run of a kernel\n{}", kReuseLegend);
  console.print("{}", reuse_header(comparison.caches, 26));
  for (const ComparedOrder& c : comparison.orders) {
    console.print("{:<11} {:<14}{}", c.vertices, c.elements, reuse_cells(*c.reuse, comparison.caches));
  }
}

void print_kernels(const Console& console, const Comparison& comparison, const KernelTable& table) {
  console.print(
      "\nKernels on {} thread{}: best milliseconds, speedup over scrambled, time divided by the band's",
      table.threads, table.threads == 1 ? "" : "s");
  const bool parallel = table.threads > 1;
  console.print("{:<11} {:<14} {:>20} {:>20} {:>20} {:>20}{}", "vertices", "elements", "SpMV",
                "element force", "assembly", "springs", parallel ? "     twice" : "");
  const auto print_row = [&](const std::string& vertices, const std::string& elements,
                             const OrderTimes& times, const std::string& twice) {
    std::string row = fmt::format("{:<11} {:<14}", vertices, elements);
    for (const Kernel kernel : kKernels) {
      const KernelTimes& t = times[kernel];
      row +=
          fmt::format(" {:>7.3g} {:>5.2f}x {:>5.2f}", t.best_ms, t.speedup, of_floor(t, table.floor[kernel]));
    }
    console.print("{}{}", row, twice);
  };
  for (std::size_t i = 0; i < comparison.orders.size(); ++i) {
    print_row(comparison.orders[i].vertices, comparison.orders[i].elements, table.orders[i],
              parallel ? fmt::format(" {:>8.1f}%", 100 * table.redundancy[i]) : "");
  }
  print_row(kFloor, kFloor, table.floor, "");
}

nlohmann::ordered_json kernels_json(const OrderTimes& times, const OrderTimes& floor) {
  nlohmann::ordered_json kernels;
  for (const Kernel kernel : kKernels) {
    const KernelTimes& t = times[kernel];
    kernels[std::string(to_string(kernel))] = {{"milliseconds", t.median_ms},
                                               {"best_milliseconds", t.best_ms},
                                               {"samples", t.samples},
                                               {"speedup", t.speedup},
                                               {"of_floor", of_floor(t, floor[kernel])}};
  }
  return kernels;
}

/// Adds "kernels" for one thread, and "parallel_kernels" for several.
template <class TimesOf>
void add_kernels(nlohmann::ordered_json& to, const Comparison& comparison, TimesOf times_of) {
  for (const KernelTable& table : comparison.kernels) {
    to[table.threads == 1 ? "kernels" : "parallel_kernels"] = kernels_json(times_of(table), table.floor);
  }
}

}  // namespace

void print_comparison(const Console& console, const Comparison& comparison) {
  print_quality(console, comparison);
  print_reuse(console, comparison);
  for (const KernelTable& table : comparison.kernels) print_kernels(console, comparison, table);
  if (comparison.kernels.back().threads > 1) {
    console.print(
        "\ntwice: share of elements that two threads compute, since each adds only to its own vertices.");
  }
  console.print(
      "\n{} is not an order of your mesh; it is a lower bound: a synthetic mesh of its size that streams.",
      kFloor);
}

nlohmann::ordered_json to_json(const Comparison& comparison) {
  auto methods = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < comparison.orders.size(); ++i) {
    const ComparedOrder& c = comparison.orders[i];
    nlohmann::ordered_json method{
        {"vertices", c.vertices},
        {"elements", c.elements},
        {"taken", {{"vertices", c.order.vertices.method.name}, {"elements", c.order.cells.method.name}}},
        {"seconds", c.order.vertices.seconds + c.order.cells.seconds},
        {"edge_span", to_json(c.span)},
        {"fiedler", to_json(c.order.vertices.fiedler)}};
    if (c.reuse) method["reuse"] = to_json(*c.reuse, comparison.caches);
    add_kernels(method, comparison,
                [&](const KernelTable& table) -> const OrderTimes& { return table.orders[i]; });
    for (const KernelTable& table : comparison.kernels) {
      if (table.threads > 1) method["redundancy"] = table.redundancy[i];
    }
    methods.push_back(method);
  }
  nlohmann::ordered_json floor{{"vertices", kFloor}, {"edge_span", to_json(comparison.floor_span)}};
  add_kernels(floor, comparison, [&](const KernelTable& table) -> const OrderTimes& { return table.floor; });
  return {{"threads", comparison.kernels.back().threads},
          {"caches", comparison.caches.level_bytes},
          {"methods", methods},
          {"floor", floor}};
}

}  // namespace meshorder::command
