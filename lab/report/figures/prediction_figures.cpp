// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figure_style.hpp"
#include "lab/report/figures/figures.hpp"
#include "lab/report/figures/gnuplot.hpp"
#include "lab/report/findings/lookup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

namespace meshorder {
namespace {

struct KernelStyle {
  const char* colour;
  int point;
};
constexpr std::array<KernelStyle, kKernels.size()> kStyles{
    {{"#0072b2", 7}, {"#e69f00", 5}, {"#009e73", 9}, {"#d55e00", 12}}};

}  // namespace

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
  figure.svg =
      draw({figure.name, figure.title, figure.caption, 520, 420,
            plain_axes() + data +
                fmt::format("set logscale xy 2\nset size square\nset xrange [{0}:{1}]\nset yrange [{0}:{1}]\n"
                            "set xlabel 'Predicted speedup, times'\nset ylabel 'Measured speedup, times'\n"
                            "set format xy '%g'\nplot {2}",
                            least / 1.2, most * 1.2, fmt::join(plots, ", \\\n  "))});
  return {std::move(figure)};
}

}  // namespace meshorder
