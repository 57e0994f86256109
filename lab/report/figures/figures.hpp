// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// A picture made of results.
struct Figure {
  std::string name;     ///< of its file, "spans-dragon"
  std::string section;  ///< of the page: "speedup", "spans", "caches", "phases", "prediction"
  std::string title;
  std::string caption;  ///< also its text for those who do not see it
  std::string svg;
};

/// Whether figures can be drawn here: gnuplot is installed.
bool can_draw_figures();

/// All figures for which the results hold something: speedups with intervals and the paper's beside them;
/// span histograms, log–log (the paper's Figure 10), of each mesh; simulated misses; time by phase; predicted
/// against measured. Drawn by gnuplot, readable without colour vision and at 360 pixels. Throws Error, which
/// names the package, when gnuplot is not installed or fails.
std::vector<Figure> figures_of(const StudyResults& results);

// The figures of each section of the page, as gnuplot draws them; none where the results hold nothing.

std::vector<Figure> speedup_figures(const StudyResults& results);
/// The paper's Figure 10, one for each mesh.
std::vector<Figure> span_figures(const StudyResults& results);
/// One for each mesh.
std::vector<Figure> cache_figures(const StudyResults& results);
std::vector<Figure> phase_figures(const StudyResults& results);
std::vector<Figure> prediction_figures(const StudyResults& results);

}  // namespace meshorder
