// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/study/motion_record.hpp>

#include <algorithm>
#include <string_view>

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

void add(const StepReport& report, const Balance& balance, MotionRecord& record) {
  record.steps.push_back({report.newton_iterations, report.cg_iterations, report.residual,
                          report.seconds.total, report.seconds.assembly, report.seconds.solve});
  record.balances.push_back(balance);
  for (const std::string& warning : report.warnings) {
    const auto known = std::find_if(
        record.warnings.begin(), record.warnings.end(),
        [&](const WarningRecord& w) { return without_numbers(w.first) == without_numbers(warning); });
    if (known != record.warnings.end()) {
      ++known->count;
    } else {
      record.warnings.push_back({warning, index_size(record.steps), 1});
    }
  }
}

}  // namespace meshorder
