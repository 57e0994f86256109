// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figures.hpp"
#include "lab/report/figures/gnuplot.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/paper.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
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

/// Returns all orders but the reference.
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

  /// Returns the y coordinate at which an order of a scenario is drawn; a scenario is 1 high.
  [[nodiscard]] double at(std::size_t scenario, std::size_t order) const {
    const double place = (static_cast<double>(order) + 0.5) / static_cast<double>(orders);
    return -static_cast<double>(scenario) - (0.1 + 0.8 * place);
  }
};

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

/// The bars of all scenarios and orders, and the bars' labels.
struct Bars {
  std::array<std::vector<std::string>, kPhases.size()> parts;  ///< "left right bottom top"
  std::vector<std::string> tics;
  std::vector<std::string> heads;  ///< commands that draw the scenarios' names
  double height = 0;
};

/// Adds bars in per cent of the reference's seconds, or of the first order's seconds without a reference.
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
  return {drawn(
      std::move(figure), height,
      data + fmt::format(
                 "set grid xtics noytics\nset errorbars small\n{}set yrange [{}:0]\nset ytics scale 0 ({})\n"
                 "set arrow from 0, graph 0 to 0, graph 1 nohead linecolor '#555555'\n"
                 "set xlabel {}\nset offsets graph 0.04, graph 0.04, 0, 0\nplot {}",
                 separators, -static_cast<double>(scenarios.size()), fmt::join(tics, ", "),
                 gnuplot_quoted(fmt::format("Saved of the time of “{}”, %", reference)),
                 fmt::join(plots, ", \\\n  ")))};
}

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
  return {drawn(std::move(figure), 100 + static_cast<int>(17 * bars.height),
                data + fmt::format("set grid xtics noytics\n{}set yrange [{}:0]\nset xrange [0:*]\n"
                                   "set ytics scale 0 ({})\nset xlabel {}\nplot {}",
                                   fmt::join(bars.heads, ""), -bars.height - 0.3, fmt::join(bars.tics, ", "),
                                   gnuplot_quoted(fmt::format("Seconds, in % of those of “{}”", reference)),
                                   fmt::join(plots, ", \\\n  ")))};
}

}  // namespace meshorder
