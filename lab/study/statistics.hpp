// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "lab/study/results.hpp"

#include <vector>

namespace meshorder {

/// Returns the summary of one order's runs; all 0 without runs. Throws InvalidArgument if the runs differ in
/// length. O(steps · runs).
TimeSummary summary_of(const std::vector<RunRecord>& runs);

/// Compares an order with the reference, run by run and turn by turn. A turn has `turn` steps; the last one
/// may be shorter. Differences between runs of the same turn are noise; differences between turns are
/// physics.
///
/// Let d[r][b] be the seconds that run r saves in turn b, of R runs and B turns. The saving is Σ_b mean_r
/// d[r][b]. Its variance is estimated by Σ_b s²_b / R, where s²_b is the variance of d[·][b] over the runs.
/// The interval is Student's with B (R − 1) degrees of freedom. A machine that is slower for a while does not
/// matter: in a turn, both orders are measured side by side. A whole run may differ, for instance by its
/// memory pages. Runs are assumed to differ if the variance of their sums is more than three times the
/// variance that the turns explain, which happens by chance in one case of twenty. The interval is then that
/// of the R sums, with R − 1 degrees, which is wider.
///
/// One run cannot separate noise from physics. Its interval comes from the ratio of the orders' seconds,
/// which is assumed to be the same in all turns (Cochran 1977, Sampling Techniques, 6.3), with B − 1 degrees,
/// which is wider. One turn of one run has no interval: `low` and `high` are then `percent`, and nothing is
/// beyond the noise.
///
/// Percentages refer to the reference's mean seconds, whose own noise is of second order and neglected.
/// `order_seconds` is the order's cost; the reference costs nothing. The break-even step is the first after
/// which the measured steps have, by their means, saved that cost; empty if there is no such step. Throws
/// InvalidArgument if the runs differ in number or length, if there are no runs, or if `turn` is not
/// positive. O(steps · runs).
Speedup speedup_of(const std::vector<RunRecord>& runs, const std::vector<RunRecord>& reference, Index turn,
                   double order_seconds);

/// Computes summaries, speedups and break-even steps of all scenarios from the runs. The cost of an order is
/// its cost on the scenario's mesh; 0 for a fluid, whose steps include it. An order of unknown cost never
/// breaks even. If an order and the reference differ in their number of runs, only the first runs that both
/// have are compared. Scenarios without runs of the reference get summaries only.
void summarise(StudyResults& results);

/// Returns the t for which a variable of Student's distribution lies between −t and t with the given
/// probability: 12.706 for (1, 0.95), 1.96 for (∞, 0.95). Uses the finite series for whole degrees of freedom
/// (Abramowitz and Stegun 1964, Handbook of Mathematical Functions, 26.7.3 and 26.7.4), and inverts it by
/// bisection. Throws InvalidArgument for less than one degree or a probability that is not between 0 and 1.
/// O(degrees).
double student_t(Index degrees, double probability);

}  // namespace meshorder
