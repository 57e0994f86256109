// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figure_style.hpp"
#include "lab/report/figures/figures.hpp"
#include "lab/report/figures/gnuplot.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/paper.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace meshorder {
namespace {

/// Returns the scenarios in which the reference has run.
std::vector<const ScenarioRecord*> compared_scenarios(const StudyResults& results) {
  std::vector<const ScenarioRecord*> scenarios;
  for (const ScenarioRecord& scenario : results.scenarios) {
    if (find_order(scenario, results.reference) != nullptr) scenarios.push_back(&scenario);
  }
  return scenarios;
}

/// Returns the orders without the reference.
std::vector<const OrderingSpec*> compared_orders(const StudyResults& results) {
  std::vector<const OrderingSpec*> orders;
  for (const OrderingSpec& ordering : results.orderings) {
    if (ordering.name != results.reference) orders.push_back(&ordering);
  }
  return orders;
}

/// Rows of a picture: scenarios one below another, and in each scenario its orders.
struct Rows {
  std::size_t orders = 0;

  /// Returns the height at which an order of a scenario is drawn; a scenario is 1 high.
  [[nodiscard]] double at(std::size_t scenario, std::size_t order) const {
    const double place = (static_cast<double>(order) + 0.5) / static_cast<double>(orders);
    return -static_cast<double>(scenario) - (0.1 + 0.8 * place);
  }
};

}  // namespace

std::vector<Figure> speedup_figures(const StudyResults& results) {
  const auto scenarios = compared_scenarios(results);
  const auto orders = compared_orders(results);
  if (scenarios.empty() || orders.empty()) return {};
  const Rows rows{orders.size()};

  std::string data;
  std::vector<std::string> plots;
  bool has_paper = false;
  for (std::size_t o = 0; o < orders.size(); ++o) {
    std::vector<std::string> ours;
    std::vector<std::string> papers;
    for (std::size_t s = 0; s < scenarios.size(); ++s) {
      const ScenarioOrderRecord* const order = find_order(*scenarios[s], orders[o]->name);
      if (order == nullptr) continue;
      const Speedup& speedup = order->speedup;
      ours.push_back(fmt::format("{} {} {} {}", speedup.percent, rows.at(s, o), speedup.low, speedup.high));
      const auto saving = paper_saving(scenarios[s]->name, orders[o]->name);
      if (results.reference == "scrambled" && saving) {
        papers.push_back(fmt::format("{} {}", saving->percent, rows.at(s, o)));
      }
    }
    if (ours.empty()) continue;
    const OrderStyle style = style_of(results, orders[o]->name);
    data += data_block(fmt::format("ours{}", o), ours);
    plots.push_back(
        fmt::format("$ours{} using 1:2:3:4 with xerrorbars linecolor '{}' linewidth 1.6 "
                    "pointtype {} pointsize 0.75 title {}",
                    o, style.colour, style.filled, gnuplot_key(title_of(results, orders[o]->name))));
    if (papers.empty()) continue;
    has_paper = true;
    data += data_block(fmt::format("paper{}", o), papers);
    plots.push_back(
        fmt::format("$paper{} using 1:2 with points linecolor '{}' linewidth 1.3 pointtype {} pointsize 0.9 "
                    "notitle",
                    o, style.colour, style.hollow));
  }
  if (plots.empty()) return {};
  if (has_paper) {
    plots.emplace_back(
        "NaN with points linecolor '#555555' pointtype 6 pointsize 0.9 title 'hollow: the paper'");
  }

  std::vector<std::string> tics;
  std::string separators;
  for (std::size_t s = 0; s < scenarios.size(); ++s) {
    tics.push_back(fmt::format("{} {}", gnuplot_tic(scenarios[s]->name), -static_cast<double>(s) - 0.5));
    separators += fmt::format(
        "set arrow from graph 0, first {0} to graph 1, first {0} nohead linecolor "
        "'#dddddd'\n",
        -static_cast<double>(s));
  }
  const std::string reference = title_of(results, results.reference);
  Figure figure{
      "speedup",
      "speedup",
      "What each order saves",
      fmt::format("Time saved in per cent of that of “{}”, in each scenario: filled marks with their "
                  "95 % intervals, measured here; an interval that holds 0 is noise.{}",
                  reference, has_paper ? " Hollow marks of the same shape: the paper's figures." : ""),
      {}};
  const int height = 90 + static_cast<int>(scenarios.size()) * (16 + 13 * static_cast<int>(orders.size()));
  figure.svg = draw(
      {figure.name, figure.title, figure.caption, 520, height,
       plain_axes() + data +
           fmt::format(
               "set grid xtics noytics\nset errorbars small\n{}set yrange [{}:0]\nset ytics scale 0 ({})\n"
               "set arrow from 0, graph 0 to 0, graph 1 nohead linecolor '#555555'\n"
               "set xlabel {}\nset offsets graph 0.04, graph 0.04, 0, 0\nplot {}",
               separators, -static_cast<double>(scenarios.size()), fmt::join(tics, ", "),
               gnuplot_quoted(fmt::format("Saved of the time of “{}”, %", reference)),
               fmt::join(plots, ", \\\n  "))});
  return {std::move(figure)};
}

}  // namespace meshorder
