// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/study/results.hpp>

#include <vector>

namespace meshorder {

/// Of the runs of one order. All of them have as many steps.
TimeSummary summary_of(const std::vector<RunRecord>& runs);

/// Compares an order with the reference, run by run and turn by turn of `turn` steps: what differs between
/// two runs of the same turn is noise, what differs between turns is physics. The interval is Student's, of
/// the turns' differences of the two orders about their means over the runs; of one run, which tells no noise
/// from physics, about a ratio that is the same in all turns, which is wider. `order_seconds` is the order's
/// cost. Throws InvalidArgument when the runs differ in number or length.
Speedup speedup_of(const std::vector<RunRecord>& runs, const std::vector<RunRecord>& reference, Index turn,
                   double order_seconds);

/// Fills what is computed from the runs in all scenarios: summaries, speedups, break-even steps. Scenarios
/// without the reference's runs keep their summaries alone.
void summarise(StudyResults& results);

}  // namespace meshorder
