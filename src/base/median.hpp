// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

namespace meshorder {

/// Returns the median; for an even number of values, the mean of the middle two; for none, 0.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

}  // namespace meshorder
