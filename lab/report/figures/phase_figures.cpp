// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figure_style.hpp"
#include "lab/report/figures/figures.hpp"
#include "lab/report/figures/gnuplot.hpp"
#include "lab/report/findings/lookup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

namespace meshorder {
namespace {

struct PhaseStyle {
  double Phases::*seconds;
  const char* title;
  const char* colour;
  int pattern;
};
constexpr std::array kPhases{PhaseStyle{&Phases::mesh, "mesh", "#56b4e9", 5},
                             PhaseStyle{&Phases::order, "order", "#cc79a7", 6},
                             PhaseStyle{&Phases::elements, "by element", "#0072b2", 3},
                             PhaseStyle{&Phases::system, "system", "#e69f00", 4},
                             PhaseStyle{&Phases::collision, "collision", "#009e73", 1},
                             PhaseStyle{&Phases::other, "other", "#7f7f7f", 2}};

/// The bars of the orders of all scenarios, and their labels.
struct Bars {
  std::array<std::vector<std::string>, kPhases.size()> parts;  ///< "left right bottom top"
  std::vector<std::string> tics;
  std::vector<std::string> heads;  ///< "x y" of scenarios' names
  double height = 0;
};

/// Adds bars in per cent of the reference's seconds, or of the first order's if the reference has not run.
void add_scenario(Bars& bars, const StudyResults& results, const ScenarioRecord& scenario) {
  const ScenarioOrderRecord* whole = find_order(scenario, results.reference);
  bool headed = false;
  for (const OrderingSpec& ordering : results.orderings) {
    const ScenarioOrderRecord* const order = find_order(scenario, ordering.name);
    if (order == nullptr) continue;
    if (whole == nullptr) whole = order;
    const double total = phases_of(*whole).total();
    if (total <= 0) continue;
    if (!headed) {
      bars.heads.push_back(
          fmt::format("set label {} at graph 0, first {} offset character 0.5, 0 textcolor '#222222'\n",
                      gnuplot_quoted(scenario.name), -bars.height - 0.6));
      bars.height += 1.2;
      headed = true;
    }
    bars.height += 1;
    bars.tics.push_back(
        fmt::format("{} {}", gnuplot_tic(title_of(results, ordering.name)), -bars.height + 0.5));
    const Phases phases = phases_of(*order);
    double left = 0;
    for (std::size_t p = 0; p < kPhases.size(); ++p) {
      const double width = 100 * phases.*kPhases[p].seconds / total;
      if (width > 0) {
        bars.parts[p].push_back(
            fmt::format("{} {} {} {}", left, left + width, -bars.height + 0.1, -bars.height + 0.9));
      }
      left += width;
    }
  }
}

}  // namespace

std::vector<Figure> phase_figures(const StudyResults& results) {
  Bars bars;
  for (const ScenarioRecord& scenario : results.scenarios) add_scenario(bars, results, scenario);
  if (bars.tics.empty()) return {};
  std::string data;
  std::vector<std::string> plots;
  for (std::size_t p = 0; p < kPhases.size(); ++p) {
    if (bars.parts[p].empty()) continue;
    data += data_block(fmt::format("part{}", p), bars.parts[p]);
    plots.push_back(fmt::format(
        "$part{} using 1:3:1:2:3:4 with boxxyerror fillstyle pattern {} linecolor '{}' title '{}'", p,
        kPhases[p].pattern, kPhases[p].colour, kPhases[p].title));
  }
  const std::string reference = title_of(results, results.reference);
  Figure figure{"phases",
                "phases",
                "Where the time goes",
                fmt::format("Parts of the steps' time in per cent of that of “{}”. By element: assembly, or "
                            "ADMM's local step. System: the linear solve, or ADMM's global step.",
                            reference),
                {}};
  figure.svg =
      draw({figure.name, figure.title, figure.caption, 520, 100 + static_cast<int>(17 * bars.height),
            plain_axes() + data +
                fmt::format("set grid xtics noytics\n{}set yrange [{}:0]\nset xrange [0:*]\n"
                            "set ytics scale 0 ({})\nset xlabel {}\nplot {}",
                            fmt::join(bars.heads, ""), -bars.height - 0.3, fmt::join(bars.tics, ", "),
                            gnuplot_quoted(fmt::format("Seconds, in % of those of “{}”", reference)),
                            fmt::join(plots, ", \\\n  "))});
  return {std::move(figure)};
}

}  // namespace meshorder
