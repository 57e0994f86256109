// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

namespace meshorder {

/// The t within whose ± a variable of Student's distribution with so many degrees of freedom lies with the
/// given probability: 12.706 for (1, 0.95), 1.96 at the limit. From the distribution's finite series for
/// whole degrees (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4), inverted by bisection. Throws
/// InvalidArgument for less than one degree or a probability that is not between 0 and 1. O(degrees).
double student_t(Index degrees, double probability);

}  // namespace meshorder
