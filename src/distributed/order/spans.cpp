// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/spans.hpp"

#include "metrics/edge_span.hpp"

#include <cmath>
#include <cstdlib>

namespace meshorder::distributed {

GlobalEdgeSpan edge_span(const Communicator& communicator, const GlobalGraph& graph,
                         const HaloValues<GlobalIndex>& place_of) {
  SpanSums<GlobalIndex> own;
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    for (const GlobalIndex neighbour : graph.rows[row]) {
      const GlobalIndex span = std::abs(place_of[neighbour] - place_of.own(row));
      own += {1, span, span, std::log2(static_cast<double>(span))};
    }
  }
  const SpanSums<GlobalIndex> all = communicator.sum(own);
  if (all.entries == 0) return {};
  const auto entries = static_cast<double>(all.entries);
  return {static_cast<double>(all.sum) / entries, all.max, all.log2_sum / entries};
}

}  // namespace meshorder::distributed
