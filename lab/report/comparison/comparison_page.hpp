// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "lab/report/comparison/comparison.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder {

/// The files that write_comparison wrote, with the tables and findings in them.
struct WrittenComparison {
  std::vector<Table> tables;
  std::vector<std::string> findings;
  std::vector<std::filesystem::path> files;  ///< the page is the last one
};

/// Writes a page for the browser, and beside it the tables as Markdown and as CSV, with the page's name and
/// the extensions .md and .csv. Throws Error if the studies cannot be compared or a file cannot be written.
WrittenComparison write_comparison(const ComparedStudy& a, const ComparedStudy& b, const FilePath& page);

}  // namespace meshorder
