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

/// Is told what is done, and which fraction of the work is over by then.
using ReportProgress = std::function<void(std::string_view what, double fraction)>;

/// Fills a page's tables, findings and figures from its results. Without gnuplot there are no figures, which
/// is noted.
void fill_from_results(Page& page, Notes& notes);

/// The page of a study: its results with what its folder holds of meshes, orders, motions and obstacles. What
/// is not there is left out of the page, with a note. Throws Error, with its name, for a file that is broken
/// or does not belong to the others.
Page page_of(const StudyFolder& folder, const StudyResults& results, Notes& notes,
             const ReportProgress& progress = {}, const PageDetail& detail = {});

/// What was written, of what, and what deserves a word.
struct WrittenReport {
  StudyResults results;
  std::vector<std::string> findings;
  std::vector<std::filesystem::path> files;  ///< the page is the last one
  Notes notes;
};

/// Makes of a study's results.json and data what stands beside them: tables.md, tables.csv, the figures and
/// report.html, all of them whole or none. Throws Error for results that cannot be read, for broken data, and
/// when something cannot be written.
WrittenReport write_report(const StudyFolder& folder, const ReportProgress& progress = {});

}  // namespace meshorder
