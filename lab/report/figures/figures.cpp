// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figures.hpp"

#include "base/text.hpp"
#include "lab/report/figures/gnuplot.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace meshorder {
namespace {

constexpr std::array kPaperStyles{
    std::pair<std::string_view, OrderStyle>{"original", {"#e69f00", 5, 4, "(12,4)", 7}},
    std::pair<std::string_view, OrderStyle>{"fiedler", {"#0072b2", 7, 6, "solid", 3}},
    std::pair<std::string_view, OrderStyle>{"vf-fiedler", {"#009e73", 9, 8, "(6,3)", 4}},
    std::pair<std::string_view, OrderStyle>{"scrambled", {"#d55e00", 13, 12, "(2,3)", 0}},
    std::pair<std::string_view, OrderStyle>{"vf-scrambled", {"#cc79a7", 11, 10, "(8,3,2,3)", 1}}};

constexpr std::array kOtherStyles{OrderStyle{"#56b4e9", 15, 14, "(3,3)", 5},
                                  OrderStyle{"#000000", 1, 1, "(10,2,2,2,2,2)", 2},
                                  OrderStyle{"#7f7f7f", 2, 2, "(1,4)", 6}};

const OrderStyle* paper_style(std::string_view ordering) {
  const auto found = std::find_if(kPaperStyles.begin(), kPaperStyles.end(),
                                  [ordering](const auto& style) { return style.first == ordering; });
  return found == kPaperStyles.end() ? nullptr : &found->second;
}

/// Returns `text` in lower case; each run of characters other than letters and digits becomes one '-'.
std::string slug(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const char lower = lower_case(c);
    if ((lower >= 'a' && lower <= 'z') || (c >= '0' && c <= '9')) {
      result += lower;
    } else if (!result.ends_with('-')) {
      result += '-';
    }
  }
  return result;
}

}  // namespace

OrderStyle style_of(const StudyResults& results, std::string_view ordering) {
  if (const OrderStyle* const style = paper_style(ordering)) return *style;
  std::size_t others = 0;
  for (const OrderingSpec& each : results.orderings) {
    if (each.name == ordering) break;
    if (paper_style(each.name) == nullptr) ++others;
  }
  return kOtherStyles[others % kOtherStyles.size()];
}

std::string data_block(std::string_view name, const std::vector<std::string>& lines) {
  return fmt::format("${} << EOD\n{}\nEOD\n", name, fmt::join(lines, "\n"));
}

std::string figure_name(std::string_view kind, const StudyResults& results, const MeshRecord& mesh) {
  const std::string own = slug(mesh.name);
  int same = 1;
  for (const MeshRecord& each : results.meshes) {
    if (&each == &mesh) break;
    if (slug(each.name) == own) ++same;
  }
  return same == 1 ? fmt::format("{}-{}", kind, own) : fmt::format("{}-{}--{}", kind, own, same);
}

std::vector<Figure> figures_of(const StudyResults& results) {
  std::vector<Figure> figures;
  for (const auto& group :
       {speedup_figures, span_figures, cache_figures, phase_figures, prediction_figures}) {
    std::ranges::move(group(results), std::back_inserter(figures));
  }
  return figures;
}

}  // namespace meshorder
