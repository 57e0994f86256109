// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "lab/report/tables/tables.hpp"
#include "lab/study/results.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// A study that is compared with another study.
struct ComparedStudy {
  std::string file;  ///< path of its results.json, for errors and tables
  StudyResults results;
};

/// Throws InputError, which names the difference, unless both studies ran the same scenarios, at least one,
/// on the same meshes with the same parameters and the same reference. They may differ in machine, program,
/// threads, steps, runs and further orders.
void check_comparable(const ComparedStudy& a, const ComparedStudy& b);

/// The percentage of time that an order saves in a study B minus that percentage in a study A.
struct SavingDifference {
  double points = 0;          ///< B's per cent minus A's
  double low = 0, high = 0;   ///< 95 % confidence interval of `points`
  bool beyond_noise = false;  ///< the interval does not contain 0

  bool operator==(const SavingDifference&) const = default;
};

/// Returns the difference between the savings in two independent studies. The lower end of its interval is
/// √((b − b's low)² + (a's high − a)²) below the difference, the upper end likewise above (Zou and Donner
/// 2008, Construction of confidence limits about effect measures: a general approach, Statistics in Medicine
/// 27). Empty if a study has no interval.
std::optional<SavingDifference> difference_of(const Speedup& a, const Speedup& b);

/// An order in a scenario. Both studies have run the scenario in this order and in the reference.
struct ComparedOrder {
  std::string scenario;
  std::string ordering;
  Speedup a, b;
  std::optional<SavingDifference> difference;
};

/// Returns the scenarios and orders that both studies have run, in the sequence of the first study.
std::vector<ComparedOrder> compared_orders(const StudyResults& a, const StudyResults& b);

/// Returns the tables of a comparison. Their ids:
/// - comparison: what the orders save in both studies, and the difference
/// - comparison-seconds: seconds of the reference
/// - comparison-kernels: measured speedups of the kernels
/// - comparison-machines: machines, programs and dates
std::vector<Table> comparison_tables(const ComparedStudy& a, const ComparedStudy& b);

/// Returns findings that the tables do not show, as sentences.
std::vector<std::string> comparison_findings(const ComparedStudy& a, const ComparedStudy& b);

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
