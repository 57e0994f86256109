// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/figures/figures.hpp"

#include <algorithm>
#include <iterator>

namespace meshorder {

std::vector<Figure> figures_of(const StudyResults& results) {
  std::vector<Figure> figures;
  for (const auto& group :
       {speedup_figures, span_figures, cache_figures, phase_figures, prediction_figures}) {
    std::ranges::move(group(results), std::back_inserter(figures));
  }
  return figures;
}

}  // namespace meshorder
