// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/comparison/comparison_page.hpp"

#include "io/stream/output_file.hpp"
#include "lab/report/page/page.hpp"
#include "lab/report/page/prose.hpp"
#include "lab/report/page/viewer_sources.hpp"

#include <fmt/format.h>

#include <utility>

namespace meshorder {
namespace {

std::string machine_of(const StudyResults& results) {
  return results.machine.processor.empty() ? "an unknown machine" : results.machine.processor;
}

}  // namespace

WrittenComparison write_comparison(const ComparedStudy& a, const ComparedStudy& b, const FilePath& page) {
  check_comparable(a, b);
  Page content;
  content.title =
      fmt::format("What orders save: {} (A) and {} (B)", machine_of(a.results), machine_of(b.results));
  content.tables = comparison_tables(a, b);
  content.findings = comparison_findings(a, b);
  std::string markdown = "# " + markdown_escaped(content.title) + "\n\n";
  markdown += to_markdown({content.tables.front()});
  for (const std::string& finding : content.findings) markdown += "\n" + prose_as_markdown(finding) + "\n";
  markdown += "\n" + to_markdown({content.tables.begin() + 1, content.tables.end()});

  WrittenComparison written;
  std::vector<OutputFile> files;
  const auto add = [&](const FilePath& path, const std::string& text) {
    files.emplace_back(path).write(text);
    written.files.push_back(path.path());
  };
  add(page.companion(".md"), markdown);
  add(page.companion(".csv"), to_csv(content.tables));
  add(page, fill_page(viewer_sources().comparison, content));
  OutputFile::commit_all(files);
  written.tables = std::move(content.tables);
  written.findings = std::move(content.findings);
  return written;
}

}  // namespace meshorder
