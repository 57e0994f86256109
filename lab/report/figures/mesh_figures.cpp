// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figures.hpp"
#include "lab/report/figures/gnuplot.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Returns the points of the log–log histogram, "span edges". Each of the first bins is a point; further out,
/// where bins crowd on the logarithmic axis, the mean of the bins in each tenth of a decade is a point.
/// Points without edges are left out, as 0 has no logarithm.
std::vector<std::string> histogram_points(const std::vector<Offset>& histogram, Index width) {
  std::vector<std::string> points;
  for (std::size_t begin = 0; begin < histogram.size();) {
    const std::size_t end = std::min(
        histogram.size(), std::max(begin + 1, static_cast<std::size_t>(static_cast<double>(begin) * 1.26)));
    const auto bins = static_cast<double>(end - begin);
    const Offset edges = std::accumulate(histogram.begin() + static_cast<std::ptrdiff_t>(begin),
                                         histogram.begin() + static_cast<std::ptrdiff_t>(end), Offset{0});
    if (edges > 0) {
      const double middle = (static_cast<double>(begin + end) * width - 1) / 2;
      points.push_back(fmt::format("{} {}", std::max(middle, 0.5), static_cast<double>(edges) / bins));
    }
    begin = end;
  }
  return points;
}

/// A curve for all orders with the same spans.
struct Curve {
  std::string title;  ///< "Fiedler, VF Fiedler"
  OrderStyle style;
  const std::vector<Offset>* histogram = nullptr;
};
std::vector<Curve> curves_of(const StudyResults& results, const MeshRecord& mesh) {
  std::vector<Curve> curves;
  for (const OrderingSpec& ordering : results.orderings) {
    const MeshOrderRecord* const order = find_order(mesh, ordering.name);
    if (order == nullptr || order->span_histogram.empty()) continue;
    const auto same = std::find_if(curves.begin(), curves.end(), [order](const Curve& curve) {
      return *curve.histogram == order->span_histogram;
    });
    if (same != curves.end()) {
      same->title += ", " + title_of(results, ordering.name);
    } else {
      curves.push_back(
          {title_of(results, ordering.name), style_of(results, ordering.name), &order->span_histogram});
    }
  }
  return curves;
}

constexpr double kBarsOfLevel = 0.8;  ///< share of a level's width that its bars take

/// Returns the bars of an order in a panel, "left right misses", with misses in per cent of the accesses.
std::vector<std::string> bars_of(const MeshOrderRecord& order, std::size_t kernel, std::size_t hierarchy,
                                 std::size_t place, std::size_t orders) {
  std::vector<std::string> bars;
  const KernelRecord& record = order.kernels[kernel];
  if (hierarchy >= record.misses.size() || record.accesses <= 0) return bars;
  const double width = kBarsOfLevel / static_cast<double>(orders);
  for (std::size_t level = 0; level < record.misses[hierarchy].size(); ++level) {
    const double left =
        static_cast<double>(level) + 1 - kBarsOfLevel / 2 + width * static_cast<double>(place);
    const double share =
        100 * static_cast<double>(record.misses[hierarchy][level]) / static_cast<double>(record.accesses);
    bars.push_back(fmt::format("{} {} {}", left, left + 0.88 * width, share));
  }
  return bars;
}

double most_misses(const MeshRecord& mesh, std::size_t kernel) {
  double most = 0;
  for (const MeshOrderRecord& order : mesh.orders) {
    const KernelRecord& record = order.kernels[kernel];
    if (record.accesses <= 0) continue;
    for (const auto& levels : record.misses) {
      for (const Offset misses : levels) {
        most = std::max(most, 100 * static_cast<double>(misses) / static_cast<double>(record.accesses));
      }
    }
  }
  return most;
}

/// Returns the step, 1, 2 or 5 times a power of ten, that divides an axis up to `most` into two to five
/// parts.
double step_of_axis(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  const double leading = most / power;
  return power * (leading < 2 ? 0.5 : leading < 5 ? 1 : 2);
}

/// Returns "'48 KB' 1, '1 MB' 2".
std::string level_tics(const Caches& caches) {
  std::vector<std::string> tics;
  for (const Offset bytes : caches.level_bytes) {
    tics.push_back(
        fmt::format("{} {}", gnuplot_tic(bytes_in_words(static_cast<double>(bytes))), tics.size() + 1));
  }
  return fmt::format("{}", fmt::join(tics, ", "));
}

/// Returns gnuplot's commands for the panel of a kernel on a cache hierarchy.
std::string panel(const StudyResults& results, const MeshRecord& mesh, std::size_t kernel,
                  std::size_t hierarchy) {
  const NamedCaches& caches = mesh.hierarchies[hierarchy];
  std::string data;
  std::vector<std::string> plots;
  for (std::size_t o = 0; o < results.orderings.size(); ++o) {
    const MeshOrderRecord* const order = find_order(mesh, results.orderings[o].name);
    if (order == nullptr) continue;
    const auto bars = bars_of(*order, kernel, hierarchy, o, results.orderings.size());
    if (bars.empty()) continue;
    const OrderStyle style = style_of(results, results.orderings[o].name);
    const std::string block = fmt::format("bars{}_{}_{}", kernel, hierarchy, o);
    data += data_block(block, bars);
    plots.push_back(
        fmt::format("${} using 1:(0):1:2:(0):3 with boxxyerror fillstyle pattern {} linecolor '{}' "
                    "notitle",
                    block, style.pattern, style.colour));
  }
  if (plots.empty()) return {};
  // an axis of at least 1 %, so that negligible misses look negligible
  const double most = std::max(most_misses(mesh, kernel), 1.0);
  return data + fmt::format(
                    "set title {}\nset label 1 {} at graph 0.97, 0.9 right textcolor '#222222'\n"
                    "set yrange [0:{}]\nset ytics 0,{},{}\nset format y '{}'\nset xrange [0.5:{}]\n"
                    "set xtics scale 0 ({})\nplot {}\n",
                    kernel == 0 ? gnuplot_key(caches.name, 32) : "''", gnuplot_quoted(kKernelTitles[kernel]),
                    1.3 * most, step_of_axis(most), 1.05 * most, hierarchy == 0 ? "%g %%" : "",
                    static_cast<double>(caches.caches.level_bytes.size()) + 0.5, level_tics(caches.caches),
                    fmt::join(plots, ", \\\n  "));
}

/// Returns gnuplot's commands for the key, a row above the panels.
std::string key(const StudyResults& results, const MeshRecord& mesh) {
  std::vector<std::string> plots;
  for (const OrderingSpec& ordering : results.orderings) {
    if (find_order(mesh, ordering.name) == nullptr) continue;
    const OrderStyle style = style_of(results, ordering.name);
    plots.push_back(fmt::format("NaN with boxes fillstyle pattern {} linecolor '{}' title {}", style.pattern,
                                style.colour, gnuplot_key(title_of(results, ordering.name))));
  }
  return fmt::format(
      "unset border\nunset tics\nunset grid\nset key center center horizontal maxcols 2 textcolor '#222222' "
      "samplen 2\nset xrange [0:1]\nset yrange [0:1]\nplot {}\n",
      fmt::join(plots, ", "));
}

/// Edges of a panel in pixels from the picture's upper left corner.
struct SpanPanel {
  int left, right, top, bottom;
};
std::string place(const SpanPanel& panel, double width, double height) {
  return fmt::format(
      "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\n"
      "set bmargin at screen {}\n",
      panel.left / width, panel.right / width, 1 - panel.top / height, 1 - panel.bottom / height);
}

Figure cache_figure(const StudyResults& results, const MeshRecord& mesh) {
  Figure figure{
      figure_name("misses", results, mesh),
      "caches",
      "Simulated cache misses on " + mesh.name,
      "Cache lines that a repeated kernel fetches from beyond each level, in per cent of its accesses: a row "
      "for each kernel, a column for each processor. Where the bars of a level are alike, the order does "
      "not matter.",
      {}};
  // in pixels, like the height of the text
  constexpr int kWidth = 520;
  constexpr int kLeft = 54;
  constexpr int kKeyRow = 22;
  const int key_height = kKeyRow * (static_cast<int>(mesh.orders.size()) + 1) / 2;
  const int panels = key_height + 40;
  constexpr int kRow = 140;
  // kernels with accesses come first; a matrix has only products
  const auto is_run = [&](const KernelRecord& kernel) { return kernel.accesses > 0; };
  const std::array<KernelRecord, kKernels.size()>& records = mesh.orders.front().kernels;
  const auto kernels = static_cast<std::size_t>(std::count_if(records.begin(), records.end(), is_run));
  const int height = panels + kRow * static_cast<int>(kernels);
  const int column = (kWidth - kLeft) / static_cast<int>(mesh.hierarchies.size());
  std::string script = "set multiplot\nset grid noxtics\nunset key\n";
  for (std::size_t k = 0; k < kernels; ++k) {
    for (std::size_t h = 0; h < mesh.hierarchies.size(); ++h) {
      const int left = kLeft + column * static_cast<int>(h);
      const int top = panels + kRow * static_cast<int>(k);
      script += place({left, left + column - 14, top, top + kRow - 34}, kWidth, height);
      script += panel(results, mesh, k, h);
    }
  }
  script += "set title ''\nunset label 1\n" + place({0, kWidth, 0, key_height}, kWidth, height) +
            key(results, mesh) + "unset multiplot";
  return drawn(std::move(figure), height, script);
}

struct KernelStyle {
  const char* colour;
  int point;
};
constexpr std::array<KernelStyle, kKernels.size()> kStyles{
    {{"#0072b2", 7}, {"#e69f00", 5}, {"#009e73", 9}, {"#d55e00", 12}}};

}  // namespace

std::vector<Figure> span_figures(const StudyResults& results) {
  std::vector<Figure> figures;
  for (const MeshRecord& mesh : results.meshes) {
    std::string data;
    std::vector<std::string> plots;
    for (const Curve& curve : curves_of(results, mesh)) {
      const auto points = histogram_points(*curve.histogram, mesh.span_bin);
      if (points.empty()) continue;
      const std::string block = fmt::format("curve{}", plots.size());
      data += data_block(block, points);
      plots.push_back(fmt::format(
          "${} using 1:2 with linespoints linecolor '{}' linewidth 1.3 dashtype {} pointtype {} "
          "pointsize 0.55 title {}",
          block, curve.style.colour, curve.style.dashes, curve.style.filled, gnuplot_key(curve.title)));
    }
    if (plots.empty()) continue;
    Figure figure{
        figure_name("spans", results, mesh),
        "spans",
        "Edge spans of " + mesh.name,
        fmt::format("How many edges have which span, in bins of {} as in the paper's Figure 10, both "
                    "axes logarithmic; further out, means of "
                    "neighbouring bins. The "
                    "steeper a curve falls, the nearer in memory are neighbours in the mesh.",
                    mesh.span_bin),
        {}};
    figures.push_back(
        drawn(std::move(figure), 360,
              data + fmt::format("set logscale xy\nset xlabel 'Edge span, vertices'\n"
                                 "set ylabel {}\nset format x '%.0f'\nset format y '%g'\nplot {}",
                                 gnuplot_quoted(fmt::format("Edges in a bin of {}", mesh.span_bin)),
                                 fmt::join(plots, ", \\\n  "))));
  }
  return figures;
}

std::vector<Figure> cache_figures(const StudyResults& results) {
  std::vector<Figure> figures;
  for (const MeshRecord& mesh : results.meshes) {
    const bool simulated =
        std::any_of(mesh.orders.begin(), mesh.orders.end(), [](const MeshOrderRecord& order) {
          return !order.kernels.front().misses.empty() && order.kernels.front().accesses > 0;
        });
    if (simulated && !mesh.hierarchies.empty()) figures.push_back(cache_figure(results, mesh));
  }
  return figures;
}

std::vector<Figure> prediction_figures(const StudyResults& results) {
  std::string data;
  std::vector<std::string> plots;
  double least = 1;
  double most = 1;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    std::vector<std::string> points;
    for (const MeshRecord& mesh : results.meshes) {
      const MeshOrderRecord* const reference = find_order(mesh, results.reference);
      if (reference == nullptr) continue;
      const KernelRecord& whole = reference->kernels[k];
      for (const MeshOrderRecord& order : mesh.orders) {
        const KernelRecord& kernel = order.kernels[k];
        if (&order == reference || kernel.predicted_ms <= 0 || kernel.measured_ms <= 0 ||
            whole.predicted_ms <= 0 || whole.measured_ms <= 0) {
          continue;
        }
        const double predicted = whole.predicted_ms / kernel.predicted_ms;
        const double measured = whole.measured_ms / kernel.measured_ms;
        least = std::min({least, predicted, measured});
        most = std::max({most, predicted, measured});
        points.push_back(fmt::format("{} {}", predicted, measured));
      }
    }
    if (points.empty()) continue;
    data += data_block(fmt::format("kernel{}", k), points);
    plots.push_back(
        fmt::format("$kernel{} using 1:2 with points linecolor '{}' linewidth 1.4 pointtype {} "
                    "pointsize 0.8 title {}",
                    k, kStyles[k].colour, kStyles[k].point, gnuplot_quoted(kKernelTitles[k])));
  }
  if (plots.empty()) return {};
  plots.emplace_back("x with lines linecolor '#555555' dashtype (4,4) title 'as predicted'");
  const std::string reference = title_of(results, results.reference);
  Figure figure{
      "prediction",
      "prediction",
      "Kernels: predicted and measured",
      fmt::format("How many times faster than in the order “{}” the kernels run, a mark for each mesh "
                  "and order, both axes logarithmic. Above the line: faster than predicted; below: "
                  "slower.",
                  reference),
      {}};
  return {drawn(
      std::move(figure), 420,
      data + fmt::format("set logscale xy 2\nset size square\nset xrange [{0}:{1}]\nset yrange [{0}:{1}]\n"
                         "set xlabel 'Predicted speedup, times'\nset ylabel 'Measured speedup, times'\n"
                         "set format xy '%g'\nplot {2}",
                         least / 1.2, most * 1.2, fmt::join(plots, ", \\\n  ")))};
}

}  // namespace meshorder
