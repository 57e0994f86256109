// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/motion_record.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

namespace meshorder {
namespace {

/// A sentence without what numbers are written with, so that those that differ in numbers alone are the same.
std::string without_numbers(std::string_view sentence) {
  constexpr std::string_view kOfNumbers = "0123456789.,+-einfa";
  std::string result;
  std::copy_if(sentence.begin(), sentence.end(), std::back_inserter(result),
               [&](char c) { return kOfNumbers.find(c) == std::string_view::npos; });
  return result;
}

}  // namespace

bool add_warning(const std::string& warning, Index step, std::vector<WarningRecord>& warnings) {
  const auto known = std::find_if(warnings.begin(), warnings.end(), [&](const WarningRecord& w) {
    return without_numbers(w.first) == without_numbers(warning);
  });
  if (known != warnings.end()) {
    ++known->count;
    return false;
  }
  warnings.push_back({warning, step, 1});
  return true;
}

void add(StepReport report, double shape_distance, const Balance& balance, MotionRecord& record) {
  const std::vector<std::string> warnings = std::exchange(report.warnings, {});
  record.steps.push_back({std::move(report), shape_distance});
  record.balances.push_back(balance);
  for (const std::string& warning : warnings) add_warning(warning, index_size(record.steps), record.warnings);
}

}  // namespace meshorder
