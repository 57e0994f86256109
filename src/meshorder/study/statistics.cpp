// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/study/statistics.hpp>

namespace meshorder {

TimeSummary summary_of(const std::vector<RunRecord>& /*runs*/) { return {}; }
Speedup speedup_of(const std::vector<RunRecord>& /*runs*/, const std::vector<RunRecord>& /*reference*/,
                   Index /*turn*/, double /*order_seconds*/) {
  return {};
}
void summarise(StudyResults& /*results*/) {}

}  // namespace meshorder
