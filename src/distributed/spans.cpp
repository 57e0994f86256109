// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/spans.hpp"

#include <algorithm>
#include <cmath>

namespace meshorder::distributed {
namespace {

struct SpanSums {
  GlobalIndex entries = 0;  ///< each edge is in two rows
  GlobalIndex sum = 0;
  GlobalIndex max = 0;
  double log2_sum = 0;

  SpanSums& operator+=(const SpanSums& other) {
    entries += other.entries;
    sum += other.sum;
    max = std::max(max, other.max);
    log2_sum += other.log2_sum;
    return *this;
  }
};

}  // namespace

GlobalEdgeSpan edge_span(const Communicator& communicator, const GlobalGraph& graph,
                         const HaloValues<GlobalIndex>& place_of) {
  SpanSums own;
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    for (const GlobalIndex neighbour : graph.rows[row]) {
      const GlobalIndex span = std::abs(place_of[neighbour] - place_of.own(row));
      own += {1, span, span, std::log2(static_cast<double>(span))};
    }
  }
  const SpanSums all = communicator.sum(own);
  if (all.entries == 0) return {};
  const auto entries = static_cast<double>(all.entries);
  return {static_cast<double>(all.sum) / entries, all.max, all.log2_sum / entries};
}

}  // namespace meshorder::distributed
