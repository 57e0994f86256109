// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <vector>

namespace meshorder {

struct Figure {
  std::string name;     ///< file name without extension, "spans-dragon"
  std::string section;  ///< its section of the page: "speedup", "spans", "caches", "phases" or "prediction"
  std::string title;
  std::string caption;  ///< also the picture's alternative text
  std::string svg;
};

/// Returns whether gnuplot is installed, so that figures can be drawn.
bool can_draw_figures();

/// Draws all figures for which the results hold data: speedups with intervals, next to the paper's; log–log
/// span histograms of each mesh (the paper's Figure 10); simulated misses; time by phase; predicted and
/// measured kernels. The figures are readable without colour vision, and at a width of 360 pixels. Throws
/// Error, which names the package, if gnuplot is not installed or fails.
std::vector<Figure> figures_of(const StudyResults& results);

// The functions below return the figures of a section of the page; empty without data.

std::vector<Figure> speedup_figures(const StudyResults& results);
/// Returns the paper's Figure 10 for each mesh.
std::vector<Figure> span_figures(const StudyResults& results);
/// Returns one figure for each mesh.
std::vector<Figure> cache_figures(const StudyResults& results);
std::vector<Figure> phase_figures(const StudyResults& results);
std::vector<Figure> prediction_figures(const StudyResults& results);

}  // namespace meshorder
