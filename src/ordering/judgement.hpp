// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include <meshorder/options.hpp>
#include <meshorder/permutation.hpp>

#include <span>
#include <string>
#include <string_view>

namespace meshorder {

/// Judges an order by the figure for the workload: the bandwidth, the entries of the Cholesky factor, the
/// sectors that a product reads on a graphics processor, or else the edge spans. The bandwidth and the
/// entries must fall, sectors by at least 10 %. The mean or the geometric mean of the spans must fall by at
/// least 2 %, and the mean must not grow by more than 5 %. From 100,000 vertices on, the share of jumps
/// decides first: it refuses the order if it grows by more than 0.1, and accepts the order if it falls so far
/// and the workload reads vectors along rows or edges.
///
/// Returns why the vertices should stay where they are, a sentence with the method's name and both figures;
/// empty if the order is better. O(n + entries).
std::string reason_to_keep(GraphRef graph, const Permutation& order, std::string_view method,
                           Workload workload);

/// Judges an order of elements by the working sets of `kElementsAtOnce` elements: at least one working set
/// must fall by 2 % or more, and none may grow by more than 5 %. Returns why the elements should stay where
/// they are, as `reason_to_keep` does. O(vertices + elements).
///
/// @param as_is  the elements in their old order; empty: the order of their numbers
/// @param order  the elements in the order to be judged
std::string reason_to_keep_elements(IncidenceRef elements, std::span<const Index> as_is,
                                    std::span<const Index> order, std::string_view method);

/// Judges an order of elements by the sectors of their additions on a graphics processor, which must fall by
/// at least 10 % in the geometric mean of the three layouts. Returns why the elements should stay where they
/// are, as `reason_to_keep` does. If there are many elements, only a sample is counted.
///
/// @param vertices  the order of the vertices
/// @param order     the elements in the order to be judged
std::string reason_to_keep_on_gpu(IncidenceRef elements, const Permutation& vertices,
                                  std::span<const Index> order, std::string_view method);

}  // namespace meshorder
