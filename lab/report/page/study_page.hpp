// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include "lab/report/page/page_parts.hpp"
#include "lab/study/folder.hpp"

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace meshorder {

/// Called as each stage begins, with the fraction of the work that is done.
using ReportProgress = std::function<void(std::string_view what, double fraction)>;

/// Fills a page's tables, findings and figures from its results. Without gnuplot, adds a note instead of
/// figures.
void fill_from_results(Page& page, Notes& notes);

/// Returns the page of a study: its results, and the meshes, orders, motions and obstacles in its folder.
/// Adds a note for each missing file. Throws Error, which names the file, for a file that is broken or does
/// not match the others.
Page page_of(const StudyFolder& folder, const StudyResults& results, Notes& notes,
             const ReportProgress& progress = {}, const PageDetail& detail = {});

/// The files that write_report wrote, with the results and findings in them; `notes` are warnings.
struct WrittenReport {
  StudyResults results;
  std::vector<std::string> findings;
  std::vector<std::filesystem::path> files;  ///< the page is the last one
  Notes notes;
};

/// Writes tables.md, tables.csv, the figures and report.html from a study's results.json and data: all of
/// them or none. Throws Error if results or data cannot be read or a file cannot be written.
WrittenReport write_report(const StudyFolder& folder, const ReportProgress& progress = {});

}  // namespace meshorder
