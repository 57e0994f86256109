// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "compare_report.hpp"

#include "gpu_counts.hpp"
#include "payoff/advice.hpp"
#include "payoff/kernel_bench.hpp"
#include "payoff/machine_choice.hpp"
#include "reuse_report.hpp"
#include "verdict.hpp"
#include "wording.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

constexpr const char* kBand = "band";

/// Returns the best time of an order divided by that of the order `band`.
double of_band(const KernelTimes& times, const KernelTimes& band) { return times.best_ms / band.best_ms; }

/// Returns the name of an order in the table: "hilbert", or "rcm (auto)".
std::string label(const ComparisonReport& report, std::size_t i) {
  const ComparedMeshOrder& c = report.orders[i];
  const Candidate methods{.vertices = c.order.vertices.method, .elements = c.order.cells.method};
  const bool by_auto = c.asked.vertices == "auto" || (i == 0 && report.auto_keeps);
  return order_in_words(methods, report.is_matrix()) + (by_auto ? " (auto)" : "");
}

/// Returns the answer in a sentence; an empty text if --methods names only the file's own order.
std::string sentence_on(const ComparisonReport& report, const Advice& advice, Workload judged) {
  if (!advice.candidates.empty()) return comparison_in_words(advice, judged);
  return report.auto_keeps ? "auto keeps the file's own order" : "";
}

constexpr int kBarWidth = 12;

/// A column of the table: each order's ratio to the file's own order; then the band's, if known.
struct Column {
  std::string title;
  std::vector<TimeRatio> ratios;
  double again = 1;  ///< ratio of two times of the file's own order: the noise
  double best = 1;   ///< largest ratio of the orders that are told apart, at least 1
};

Column column(std::string title, const KernelTable& table,
              const std::function<TimeRatio(const OrderTimes&)>& ratio_of) {
  Column result{std::move(title), {}};
  for (const OrderTimes& times : table.orders) {
    const TimeRatio ratio = ratio_of(times);
    if (is_told_apart(ratio)) result.best = std::max(result.best, ratio.ratio);
    result.ratios.push_back(ratio);
  }
  result.ratios.push_back(ratio_of(table.band));
  result.again = ratio_of(table.again).ratio;
  return result;
}

/// Returns the geometric mean over the kernels.
TimeRatio mean_gain(const OrderTimes& times, std::span<const Kernel> kernels) {
  std::vector<TimeRatio> gains;
  for (const Kernel kernel : kernels) gains.push_back(times[kernel].gain);
  return geometric_mean(gains);
}

/// Returns a column for each kernel. For a mesh, a column for the geometric mean of all kernels comes first.
std::vector<Column> columns_of(const ComparisonReport& comparison, const KernelTable& table) {
  std::vector<Column> columns;
  if (!comparison.is_matrix()) {
    columns.push_back(column(
        "all", table, [&](const OrderTimes& times) { return mean_gain(times, comparison.kernels_run); }));
  }
  for (const Kernel kernel : comparison.kernels_run) {
    columns.push_back(column(
        std::string(comparison.is_matrix() ? kProduct : kKernelTitles[static_cast<std::size_t>(kernel)]),
        table, [&](const OrderTimes& times) { return times[kernel].gain; }));
  }
  return columns;
}

/// Returns a column for each layout: the factor by which additions on a GPU touch fewer sectors.
std::vector<Column> counted_columns(const ComparisonReport& comparison) {
  std::vector<Column> columns;
  for (std::size_t k = 0; k < comparison.gpu_layouts.size(); ++k) {
    Column column{"gpu " + std::string(to_string(comparison.gpu_layouts[k])), {}};
    for (const std::vector<GpuCost>& costs : comparison.gpu) {
      const double ratio = sector_ratio(comparison.gpu.front()[k], costs[k]);
      column.ratios.push_back({ratio, ratio, ratio});
      column.best = std::max(column.best, ratio);
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

/// Prints the speedups of the kernels over the file's own order, with bars for the workload `judged`.
void print_speedups(const Console& console, const ComparisonReport& comparison, const KernelTable& table,
                    Workload judged) {
  std::vector<Column> columns = columns_of(comparison, table);
  std::ranges::move(counted_columns(comparison), std::back_inserter(columns));
  // a matrix has one column; a mesh has a column for all kernels, and then one for each kernel
  const std::size_t column = comparison.is_matrix() || judged == Workload::all ? 0 : kernel_of(judged) + 1;
  const auto width = [](const Column& c) { return std::max<std::size_t>(7, c.title.size() + 1); };
  std::string heads = fmt::format("{:<26} {:>8}", "order", "cost");
  for (const Column& c : columns) heads += fmt::format("{:>{}} ", c.title, width(c));
  console.print(
      "\nHow many times faster than in the file's own order{}. =: not told apart from it;\n"
      "*: the best, and orders not told apart from the best\n{}",
      on_threads(table.threads), heads);
  const auto cell = [](const TimeRatio& ratio, bool is_own) {
    return is_own || is_told_apart(ratio) ? fmt::format("{:.2f}", ratio.ratio) : "=";
  };
  const double longest = columns[column].best;
  for (std::size_t i = 0; i <= comparison.orders.size(); ++i) {
    const bool is_band = i == comparison.orders.size();
    std::string row = fmt::format("{:<26} {:>8}", is_band ? kBand : label(comparison, i),
                                  is_band || i == 0 ? "-" : duration(comparison.orders[i].seconds));
    for (const Column& c : columns) {
      const bool is_known = i < c.ratios.size();
      const bool is_best = is_known && !is_band && c.ratios[i].high >= c.best;
      row +=
          fmt::format("{:>{}}{}", is_known ? cell(c.ratios[i], i == 0) : "-", width(c), is_best ? '*' : ' ');
    }
    const TimeRatio& shown = columns[column].ratios[i];
    console.print("{} {}", row, bar((is_told_apart(shown) ? shown.ratio : 1) / longest, kBarWidth));
  }
  std::string again = fmt::format("{:<26} {:>8}", "the file's own once more", "-");
  for (const Column& c : columns) again += fmt::format("{:>{}.2f} ", c.again, width(c));
  console.print("{}", again);
}

/// Returns the beginning of a row: both methods, or only the first for a matrix, which has no elements.
std::string row_head(const ComparisonReport& comparison, const std::string& vertices,
                     const std::string& elements) {
  return comparison.is_matrix() ? fmt::format("{:<15}", vertices)
                                : fmt::format("{:<15} {:<12}", vertices, elements);
}

/// Returns the beginning of the row of an order.
std::string row_head(const ComparisonReport& comparison, std::size_t i) {
  const MeshMethods& asked = comparison.orders[i].asked;
  const bool is_of_auto = i == 0 && comparison.auto_keeps;
  return row_head(comparison, asked.vertices + (is_of_auto ? " (auto)" : ""), asked.elements);
}

std::string title_row(const ComparisonReport& comparison) {
  return comparison.is_matrix() ? row_head(comparison, "order", "")
                                : row_head(comparison, "vertices", "elements");
}

void print_quality(const Console& console, const ComparisonReport& comparison) {
  const bool has_iterations = comparison.orders.front().iterations.has_value();
  console.print("{} {:>8} {:>12} {:>10} {:>10}{}", title_row(comparison), "cost",
                comparison.is_matrix() ? "distance" : "span: mean", "max", "mean log2",
                has_iterations ? fmt::format("{:>7} {:>7}", "IC", "SGS") : "");
  const auto print_row = [&](const std::string& head, const std::string& cost, const EdgeSpan& span,
                             const std::string& iterations) {
    console.print("{} {:>8} {:>12.1f} {:>10} {:>10.2f}{}", head, cost, span.mean, with_commas(span.max),
                  span.mean_log2, iterations);
  };
  for (std::size_t i = 0; i < comparison.orders.size(); ++i) {
    const ComparedMeshOrder& c = comparison.orders[i];
    const std::string iterations =
        c.iterations
            ? fmt::format("{:>7} {:>7}", c.iterations->incomplete_cholesky, c.iterations->gauss_seidel)
            : "";
    print_row(row_head(comparison, i), duration(c.seconds), c.span, iterations);
  }
  print_row(row_head(comparison, kBand, kBand), "-", comparison.band_span, "");
  if (has_iterations) {
    console.print(
        "IC, SGS: iterations of conjugate gradients on a Laplacian of the {}, preconditioned by an\n"
        "incomplete Cholesky factor and by symmetric Gauss–Seidel sweeps, which depend on the order",
        comparison.is_matrix() ? "graph" : "mesh");
  }
}

/// A table with a row for each order and the same columns for each kernel.
struct KernelColumns {
  std::vector<std::string> rows;                                          ///< first cells of the rows
  std::string heads;                                                      ///< of the columns of a kernel
  std::function<std::string(std::size_t row, std::size_t kernel)> cells;  ///< as wide as `heads`
  std::vector<std::string> last;  ///< last column: its head and its cells; may be empty
};

/// Prints the table in blocks of kernels side by side: as few blocks as fit into 100 columns.
void print_columns(const Console& console, const ComparisonReport& comparison, const KernelColumns& table) {
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

std::vector<std::string> row_heads(const ComparisonReport& comparison) {
  std::vector<std::string> rows;
  rows.reserve(comparison.orders.size() + 1);
  for (std::size_t i = 0; i < comparison.orders.size(); ++i) rows.push_back(row_head(comparison, i));
  return rows;
}

void print_reuse(Console& console, const ComparisonReport& comparison) {
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

void print_kernels(const Console& console, const ComparisonReport& comparison, const KernelTable& table) {
  console.print(
      "\n{} on {} thread{}: best milliseconds, speedup, time divided by the band's",
      comparison.is_matrix() ? "Products" : fmt::format("Kernels ({})", to_string(comparison.kernel_set)),
      table.threads, table.threads == 1 ? "" : "s");
  std::vector<std::string> rows = row_heads(comparison);
  rows.push_back(row_head(comparison, kBand, kBand));
  const auto cells = [&](std::size_t i, std::size_t k) {
    const KernelTimes& t = (i < table.orders.size() ? table.orders[i] : table.band)[kKernels[k]];
    const bool is_stated = i == 0 || is_told_apart(t.gain);
    return fmt::format("{:>9.3g} {:>7} {:>7.2f}", t.best_ms,
                       is_stated ? fmt::format("{:.2f}x", t.gain.ratio) : "=",
                       of_band(t, table.band[kKernels[k]]));
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

nlohmann::ordered_json kernels_json(const OrderTimes& times, const OrderTimes& band,
                                    std::span<const Kernel> run) {
  nlohmann::ordered_json kernels;
  for (const Kernel kernel : run) {
    const KernelTimes& t = times[kernel];
    kernels[std::string(to_string(kernel))] = {{"milliseconds", t.median_ms},
                                               {"best_milliseconds", t.best_ms},
                                               {"samples", t.samples},
                                               {"share", t.share},
                                               {"speedup", t.gain.ratio},
                                               {"interval", interval_json(t.gain)},
                                               {"told_apart", is_told_apart(t.gain)},
                                               {"of_band", of_band(t, band[kernel])}};
  }
  return kernels;
}

/// Adds "kernels" for one thread, and "parallel_kernels" for several.
template <class TimesOf>
void add_kernels(nlohmann::ordered_json& to, const ComparisonReport& comparison, TimesOf times_of) {
  for (const KernelTable& table : comparison.kernels) {
    to[table.threads == 1 ? "kernels" : "parallel_kernels"] =
        kernels_json(times_of(table), table.band, comparison.kernels_run);
  }
}

}  // namespace

void print_comparison(const Console& console, const ComparisonReport& comparison) {
  const Advice advice = advice_of(comparison);
  const Workload judged = judged_by_kernels(advice, comparison.workload);
  const std::string sentence = sentence_on(comparison, advice, judged);
  console.print("{}: {}", comparison.file,
                sentence.empty() ? "--methods names only the file's own order" : sentence);
  if (const std::optional<std::size_t> best = winner_for(judged, advice))
    print_line_for(console, advice.candidates[*best], advice.is_matrix, comparison.file);
  for (const ComparedMeshOrder& c : comparison.orders) {
    const MethodChoice& taken = c.order.vertices.method;
    if (!taken.reason.empty()) console.print("auto takes {}: {}", taken.name, taken.reason);
  }
  for (const KernelTable& table : comparison.kernels) print_speedups(console, comparison, table, judged);
  if (const std::string parts = parts_in_words(comparison); !parts.empty()) console.print("{}", parts);
  if (!comparison.gpu_layouts.empty()) {
    console.print(
        "gpu: factor by which atomic additions touch fewer sectors of memory on a graphics processor");
  }
  console.print("{0} is not an order of your {1}: it is a synthetic {1} of its size, read front to back.",
                kBand, comparison.is_matrix() ? "matrix" : "mesh");
}

void print_comparison_details(Console& console, const ComparisonReport& comparison) {
  console.print("\n{}", comparison.size);
  print_quality(console, comparison);
  print_reuse(console, comparison);
  for (const KernelTable& table : comparison.kernels) print_kernels(console, comparison, table);
  if (comparison.kernels.back().threads > 1 && !comparison.is_matrix()) {
    console.print(
        "\ntwice: share of elements that two threads compute, since each adds only to its own vertices.");
  }
}

nlohmann::ordered_json to_json(const ComparisonReport& comparison) {
  auto methods = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < comparison.orders.size(); ++i) {
    const ComparedMeshOrder& c = comparison.orders[i];
    nlohmann::ordered_json method{
        {"vertices", c.asked.vertices},
        {"elements", c.asked.elements},
        {"taken", {{"vertices", c.order.vertices.method.name}, {"elements", c.order.cells.method.name}}},
        {"seconds", c.seconds},
        {"edge_span", to_json(c.span)},
        {"fiedler", to_json(c.order.vertices.fiedler)}};
    if (c.iterations) {
      method["iterations"] = {{"incomplete_cholesky", c.iterations->incomplete_cholesky},
                              {"gauss_seidel", c.iterations->gauss_seidel}};
    }
    for (std::size_t k = 0; k < comparison.gpu_layouts.size(); ++k)
      method["gpu"][std::string(to_string(comparison.gpu_layouts[k]))] = to_json(comparison.gpu[i][k]);
    if (c.reuse) method["reuse"] = to_json(*c.reuse, comparison.caches, comparison.kernels_run);
    add_kernels(method, comparison,
                [&](const KernelTable& table) -> const OrderTimes& { return table.orders[i]; });
    for (const KernelTable& table : comparison.kernels) {
      if (table.threads > 1) method["redundancy"] = table.redundancy[i];
    }
    methods.push_back(method);
    if (i > 0 || !comparison.auto_keeps) continue;
    // lists the file's order once more, under the methods that `auto` chose
    method["vertices"] = comparison.auto_keeps->vertices;
    method["elements"] = comparison.auto_keeps->elements;
    methods.push_back(method);
  }
  nlohmann::ordered_json band{{"vertices", kBand}, {"edge_span", to_json(comparison.band_span)}};
  add_kernels(band, comparison, [&](const KernelTable& table) -> const OrderTimes& { return table.band; });
  nlohmann::ordered_json again = nlohmann::ordered_json::object();
  add_kernels(again, comparison, [&](const KernelTable& table) -> const OrderTimes& { return table.again; });
  const Advice advice = advice_of(comparison);
  const Workload judged = judged_by_kernels(advice, comparison.workload);
  nlohmann::ordered_json verdict{{"sentence", nullptr},
                                 {"best", nullptr},
                                 {"factor", nullptr},
                                 {"interval", nullptr},
                                 {"reliable", advice.doubt.empty()}};
  if (std::string sentence = sentence_on(comparison, advice, judged); !sentence.empty())
    verdict["sentence"] = std::move(sentence);
  if (const std::optional<std::size_t> best = winner_for(judged, advice)) {
    verdict["best"] = *best + (comparison.auto_keeps ? 2 : 1);
    verdict["factor"] = gain_for(judged, advice, *best).ratio;
    verdict["interval"] = interval_json(gain_for(judged, advice, *best));
  }
  auto steadiness = nlohmann::ordered_json::array();
  for (const KernelTable& table : comparison.kernels) {
    steadiness.push_back({{"threads", table.threads},
                          {"waiting", table.steadiness.waiting},
                          {"pace", table.steadiness.pace},
                          {"repeat", table.steadiness.repeat}});
  }
  return {{"verdict", verdict},
          {"kernel_set", to_string(comparison.kernel_set)},
          {"threads", comparison.kernels.back().threads},
          {"caches", comparison.caches.level_bytes},
          {"methods", methods},
          {"band", band},
          {"again", again},
          {"steadiness", steadiness}};
}

}  // namespace meshorder::command
