// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "lab/study/results.hpp"

#include <vector>

namespace meshorder {

/// Of the runs of one order; all 0 without runs. Throws InvalidArgument when they differ in length. O(steps ·
/// runs).
TimeSummary summary_of(const std::vector<RunRecord>& runs);

/// Compares an order with the reference, run by run and turn by turn of `turn` steps (the last may be
/// shorter): what differs between two runs of the same turn is noise, what differs between turns is physics.
///
/// With d[r][b] the seconds that run r saves in turn b, B turns and R runs, the saving is Σ_b mean_r d[r][b];
/// its variance is estimated by Σ_b s²_b / R, s²_b the variance of d[·][b] over the runs, and the interval is
/// Student's of B (R − 1) degrees of freedom. A machine that gets slower for a while takes nothing away: both
/// orders of a turn were measured side by side. But a run may have something of its own, such as the pages
/// that it was given. Where the variance of the runs' sums is more than three times the one that the turns
/// explain, which chance does in one case of twenty, the interval is the wider one of the R sums, of R − 1
/// degrees.
///
/// One run does not tell noise from physics. Its interval is that of the ratio of the orders' seconds, taken
/// as the same in all turns (Cochran 1977, Sampling Techniques, 6.3), of B − 1 degrees, which is wider. One
/// turn of one run tells nothing: `low` and `high` are then `percent`, and nothing is beyond the noise.
///
/// The percentages are of the reference's mean seconds, whose own noise is of second order and left out.
/// `order_seconds` is the order's cost; the reference costs nothing. It is paid when the means of the steps
/// so far have saved as much, in the steps that were measured: none otherwise. Throws InvalidArgument when
/// the runs differ in number or length, or there are none, or `turn` is not positive. O(steps · runs).
Speedup speedup_of(const std::vector<RunRecord>& runs, const std::vector<RunRecord>& reference, Index turn,
                   double order_seconds);

/// Fills what is computed from the runs in all scenarios: summaries, speedups, break-even steps. The orders'
/// costs are those of the scenario's mesh; an order whose cost is not known breaks even never. Where an order
/// has not as many runs as the reference, the first ones are compared. Scenarios without the reference's runs
/// keep their summaries alone.
void summarise(StudyResults& results);

/// The t within whose ± a variable of Student's distribution with so many degrees of freedom lies with the
/// given probability: 12.706 for (1, 0.95), 1.96 at the limit. From the distribution's finite series for
/// whole degrees (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4), inverted by bisection. Throws
/// InvalidArgument for less than one degree or a probability that is not between 0 and 1. O(degrees).
double student_t(Index degrees, double probability);

}  // namespace meshorder
