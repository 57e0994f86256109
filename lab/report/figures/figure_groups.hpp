// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/figures/figures.hpp"

#include <vector>

namespace meshorder {

// The figures of each section of the page, as gnuplot draws them; none where the results hold nothing.

std::vector<Figure> speedup_figures(const StudyResults& results);
/// The paper's Figure 10, one for each mesh.
std::vector<Figure> span_figures(const StudyResults& results);
/// One for each mesh.
std::vector<Figure> cache_figures(const StudyResults& results);
std::vector<Figure> phase_figures(const StudyResults& results);
std::vector<Figure> prediction_figures(const StudyResults& results);

}  // namespace meshorder
