// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/metis.hpp"

#include "base/error.hpp"

#include <limits>
#include <stdexcept>
#include <string>

namespace meshorder {

MetisGraph::MetisGraph(const CsrGraph& graph, std::uint64_t seed) : size(graph.size()) {
  if (graph.offsets.back() > std::numeric_limits<idx_t>::max()) {
    throw InvalidArgument("METIS here counts with " + std::to_string(8 * sizeof(idx_t)) +
                          " bits; this graph has " + std::to_string(graph.offsets.back()) + " entries");
  }
  offsets.assign(graph.offsets.begin(), graph.offsets.end());
  neighbours.assign(graph.neighbours.begin(), graph.neighbours.end());
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = static_cast<idx_t>(seed % 1000000007U);
  options[METIS_OPTION_NUMBERING] = 0;
}

void check_metis(int status, const char* call) {
  if (status != METIS_OK)
    throw std::runtime_error(std::string(call) + " failed with " + std::to_string(status));
}

}  // namespace meshorder
