// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figure_style.hpp"
#include "lab/report/figures/figures.hpp"
#include "lab/report/figures/gnuplot.hpp"
#include "lab/report/findings/lookup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Returns the points of the log–log histogram, "span edges". First come single bins; further out, where bins
/// crowd on the logarithmic axis, the mean of the bins of each tenth of a decade. Bins without edges are left
/// out, as they have no logarithm.
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

/// Orders with the same spans share a curve.
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
    figure.svg = draw({figure.name, figure.title, figure.caption, 520, 360,
                       plain_axes() + data +
                           fmt::format("set logscale xy\nset xlabel 'Edge span, vertices'\n"
                                       "set ylabel {}\nset format x '%.0f'\nset format y '%g'\nplot {}",
                                       gnuplot_quoted(fmt::format("Edges in a bin of {}", mesh.span_bin)),
                                       fmt::join(plots, ", \\\n  "))});
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace meshorder
