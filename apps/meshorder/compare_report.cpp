// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "compare_report.hpp"

#include "reuse_report.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace meshorder::command {
namespace {

constexpr const char* kFloor = "band";

/// Returns the time divided by the band's. Both are taken relative to the reference, since orders that do not
/// fit into memory together are timed in groups, each with the reference.
double of_floor(const KernelTimes& times, const KernelTimes& floor) { return floor.speedup / times.speedup; }

/// Returns the beginning of a row; of a matrix, which has no elements, the order of its rows alone.
std::string row_head(const Comparison& comparison, const std::string& vertices, const std::string& elements) {
  return comparison.is_matrix() ? fmt::format("{:<15}", vertices)
                                : fmt::format("{:<15} {:<12}", vertices, elements);
}

std::string title_row(const Comparison& comparison) {
  return comparison.is_matrix() ? row_head(comparison, "order", "")
                                : row_head(comparison, "vertices", "elements");
}

void print_quality(const Console& console, const Comparison& comparison) {
  console.print("\n{} {:>8} {:>12} {:>10} {:>10}", title_row(comparison), "cost",
                comparison.is_matrix() ? "distance" : "span: mean", "max", "mean log2");
  const auto print_row = [&](const std::string& vertices, const std::string& elements,
                             const std::string& cost, const EdgeSpan& span) {
    console.print("{} {:>8} {:>12.1f} {:>10} {:>10.2f}", row_head(comparison, vertices, elements), cost,
                  span.mean, with_commas(span.max), span.mean_log2);
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

/// A table with a row for each order and columns for each kernel.
struct KernelColumns {
  std::vector<std::string> rows;                                          ///< their heads
  std::string heads;                                                      ///< of the columns of a kernel
  std::function<std::string(std::size_t row, std::size_t kernel)> cells;  ///< as wide as `heads`
  std::vector<std::string> last;  ///< last column: its head and its cells; may be empty
};

/// Prints the table, as many kernels side by side as fit 100 columns.
void print_columns(const Console& console, const Comparison& comparison, const KernelColumns& table) {
  constexpr std::size_t kColumns = 100;
  const std::size_t kernels = comparison.kernels_run.size();
  const std::size_t left = title_row(comparison).size();
  const std::size_t at_most = std::max<std::size_t>(1, (kColumns - left) / table.heads.size());
  const std::size_t blocks = (kernels + at_most - 1) / at_most;
  const std::size_t side_by_side = (kernels + blocks - 1) / blocks;
  for (std::size_t first = 0; first < kernels; first += side_by_side) {
    const std::size_t end = std::min(first + side_by_side, kernels);
    const bool is_last = end == kernels && !table.last.empty();
    std::string titles(left, ' ');
    std::string heads = title_row(comparison);
    for (std::size_t k = first; k < end; ++k) {
      titles += fmt::format("{:>{}}", kKernelTitles[k], table.heads.size());
      heads += table.heads;
    }
    if (!comparison.is_matrix()) console.print("{}", titles);
    console.print("{}{}", heads, is_last ? table.last.front() : "");
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      std::string row = table.rows[i];
      for (std::size_t k = first; k < end; ++k) row += table.cells(i, k);
      console.print("{}{}", row, is_last ? table.last[i + 1] : "");
    }
  }
}

std::vector<std::string> row_heads(const Comparison& comparison) {
  std::vector<std::string> rows;
  rows.reserve(comparison.orders.size() + 1);
  for (const ComparedOrder& c : comparison.orders)
    rows.push_back(row_head(comparison, c.vertices, c.elements));
  return rows;
}

void print_reuse(Console& console, const Comparison& comparison) {
  if (!comparison.orders.front().reuse) {
    console.warn("not shown, to save time on a large mesh: cache misses; --cache this predicts them");
    return;
  }
  console.print("\nPredicted for each {}\n{}", comparison.is_matrix() ? kProduct : "run of a kernel",
                kReuseLegend);
  const auto cells = [&](std::size_t i, std::size_t k) {
    return reuse_cells((*comparison.orders[i].reuse)[k], comparison.caches);
  };
  print_columns(console, comparison, {row_heads(comparison), reuse_header(comparison.caches), cells, {}});
}

void print_kernels(const Console& console, const Comparison& comparison, const KernelTable& table) {
  console.print(
      "\n{} on {} thread{}: best milliseconds, speedup over scrambled, time divided by the band's",
      comparison.is_matrix() ? "Products" : fmt::format("Kernels ({})", to_string(comparison.kernel_set)),
      table.threads, table.threads == 1 ? "" : "s");
  std::vector<std::string> rows = row_heads(comparison);
  rows.push_back(row_head(comparison, kFloor, kFloor));
  const auto cells = [&](std::size_t i, std::size_t k) {
    const KernelTimes& t = (i < table.orders.size() ? table.orders[i] : table.floor)[kKernels[k]];
    return fmt::format("{:>9.3g} {:>6.2f}x {:>7.2f}", t.best_ms, t.speedup,
                       of_floor(t, table.floor[kKernels[k]]));
  };
  std::vector<std::string> twice;
  if (table.threads > 1 && !comparison.is_matrix()) {
    twice.push_back(fmt::format("{:>9}", "twice"));
    for (const double share : table.redundancy) twice.push_back(fmt::format(" {:>7.1f}%", 100 * share));
    twice.emplace_back();
  }
  print_columns(console, comparison,
                {rows, fmt::format("{:>9} {:>7} {:>7}", "ms", "speedup", "/ band"), cells, twice});
}

nlohmann::ordered_json kernels_json(const OrderTimes& times, const OrderTimes& floor,
                                    std::span<const Kernel> run) {
  nlohmann::ordered_json kernels;
  for (const Kernel kernel : run) {
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
    to[table.threads == 1 ? "kernels" : "parallel_kernels"] =
        kernels_json(times_of(table), table.floor, comparison.kernels_run);
  }
}

}  // namespace

void print_comparison(Console& console, const Comparison& comparison) {
  print_quality(console, comparison);
  print_reuse(console, comparison);
  for (const KernelTable& table : comparison.kernels) print_kernels(console, comparison, table);
  if (comparison.kernels.back().threads > 1 && !comparison.is_matrix()) {
    console.print(
        "\ntwice: share of elements that two threads compute, since each adds only to its own vertices.");
  }
  console.print(
      "\n{} is not an order of your {}; it is a lower bound: a synthetic {} of its size that streams.",
      kFloor, comparison.is_matrix() ? "matrix" : "mesh", comparison.is_matrix() ? "matrix" : "mesh");
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
    if (c.reuse) method["reuse"] = to_json(*c.reuse, comparison.caches, comparison.kernels_run);
    add_kernels(method, comparison,
                [&](const KernelTable& table) -> const OrderTimes& { return table.orders[i]; });
    for (const KernelTable& table : comparison.kernels) {
      if (table.threads > 1) method["redundancy"] = table.redundancy[i];
    }
    methods.push_back(method);
  }
  nlohmann::ordered_json floor{{"vertices", kFloor}, {"edge_span", to_json(comparison.floor_span)}};
  add_kernels(floor, comparison, [&](const KernelTable& table) -> const OrderTimes& { return table.floor; });
  auto steadiness = nlohmann::ordered_json::array();
  for (const KernelTable& table : comparison.kernels) {
    steadiness.push_back({{"threads", table.threads},
                          {"waiting", table.steadiness.waiting},
                          {"pace", table.steadiness.pace},
                          {"repeat", table.steadiness.repeat}});
  }
  return {{"kernel_set", to_string(comparison.kernel_set)},
          {"threads", comparison.kernels.back().threads},
          {"caches", comparison.caches.level_bytes},
          {"methods", methods},
          {"floor", floor},
          {"steadiness", steadiness}};
}

}  // namespace meshorder::command
