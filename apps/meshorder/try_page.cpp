// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "try_report.hpp"
#include "wording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace meshorder::command {
namespace {

constexpr std::string_view kHead = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
:root {{ --paper: #fcfbf8; --ink: #1c2330; --soft: #5a6272; --bar: #b9c3cf; --best: #1b5e7b; }}
@media (prefers-color-scheme: dark) {{
  :root {{ --paper: #14181f; --ink: #e6e4de; --soft: #a3abb8; --bar: #4a5563; --best: #86c5de; }}
}}
body {{ margin: 0 auto; max-width: 62rem; padding: 2rem 1rem; background: var(--paper); color: var(--ink);
       font: 1rem/1.5 system-ui, sans-serif; }}
h1 {{ font-size: 1.4rem; line-height: 1.3; }}
p, td.soft {{ color: var(--soft); }}
table {{ width: 100%; border-collapse: collapse; }}
td {{ padding: .35rem .6rem .35rem 0; white-space: nowrap; }}
td.number {{ text-align: right; font-variant-numeric: tabular-nums; }}
td.bar {{ width: 50%; min-width: 8rem; }}
.track {{ position: relative; height: 1.1rem; }}
.track b, .track i {{ position: absolute; }}
.track b {{ height: 100%; background: var(--bar); border-radius: 2px; }}
.best b {{ background: var(--best); }}
.track i {{ top: 45%; height: 10%; background: var(--ink); }}
code {{ overflow-wrap: anywhere; }}
.wide {{ overflow-x: auto; }}
</style>
)";

/// Returns a bar: the time of an order as a share of the longest, with its interval.
std::string track(const TimeRatio& speedup, double longest) {
  const auto percent = [&](double ratio) { return 100 / ratio / longest; };
  std::string result =
      fmt::format("<div class=\"track\"><b style=\"width:{:.2f}%\"></b>", percent(speedup.ratio));
  if (!std::isinf(speedup.high)) {
    result += fmt::format("<i style=\"left:{:.2f}%;width:{:.2f}%\"></i>", percent(speedup.high),
                          percent(speedup.low) - percent(speedup.high));
  }
  return result + "</div>";
}

}  // namespace

std::string trial_page(const TrialReport& report) {
  const std::string title = xml_escaped(trial_in_words(report));
  std::string page = fmt::format(fmt::runtime(kHead), fmt::arg("title", title));
  page += fmt::format("<h1>{}</h1>\n", title);
  page += fmt::format("<p><code>{}</code></p>\n", xml_escaped(report.call));
  double longest = 1;
  const auto speedup_of = [&](std::size_t i) {
    return i == 0 ? TimeRatio{1, 1, 1} : report.trials.speedup(i);
  };
  for (std::size_t i = 1; i < report.orders.size(); ++i) {
    if (!report.orders[i].times.empty() && is_reportable(speedup_of(i)))
      longest = std::max(longest, 1 / speedup_of(i).ratio);
  }
  const std::optional<std::size_t> best = report.trials.best();
  page += "<div class=\"wide\"><table>\n";
  for (std::size_t i = 0; i < report.orders.size(); ++i) {
    const TriedOrder& order = report.orders[i];
    page += fmt::format("<tr{}><td>{}{}", best == i && is_faster(report) ? " class=\"best\"" : "",
                        i == 0 ? "as it is" : xml_escaped(order.name), order.by_auto ? " (auto)" : "");
    if (!order.fault.empty() || order.times.empty()) {
      page += fmt::format("<td class=\"soft\" colspan=\"4\">{}\n",
                          order.fault.empty() ? "not timed" : xml_escaped(order.fault));
      continue;
    }
    const TimeRatio speedup = speedup_of(i);
    if (!is_reportable(speedup)) {
      page += fmt::format("<td class=\"soft\" colspan=\"3\">{} {}<td class=\"soft\">{} runs\n", kNotToldApart,
                          interval_in_words(speedup), order.times.size());
      continue;
    }
    page += fmt::format(
        "<td class=\"bar\">{}<td class=\"number\">{}<td class=\"number\">{:.2f}×<td class=\"soft\">{} "
        "runs{}\n",
        track(speedup, longest), time_in_words(report, i), speedup.ratio, order.times.size(),
        order.count >= 0 ? fmt::format(", count {:.6g}", order.count) : "");
  }
  page += "</table></div>\n";
  page += fmt::format(
      "<p>{}; median in the mesh's own order, divided by the ratio of paired runs in others. The line on a "
      "bar "
      "is its 95 % interval. Orders with few runs were dropped early.</p>\n",
      report.time == "cpu"    ? "Processor time of the program and of all that it starts"
      : report.time == "wall" ? "Time by the clock"
                              : "What the program prints as its time");
  if (best && is_faster(report))
    page += fmt::format("<p>This makes it: <code>{}</code></p>\n", xml_escaped(report.orders[*best].made_by));
  return page + "</html>\n";
}

}  // namespace meshorder::command
