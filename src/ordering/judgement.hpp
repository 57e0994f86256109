// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/options.hpp>
#include <meshorder/permutation.hpp>

#include <string>
#include <string_view>

namespace meshorder {

/// Returns what a method asked for by name is to be judged by.
Workload made_for(std::string_view method);

/// Judges an order by what the workload asks for: the bandwidth, the entries of the Cholesky factor, and else
/// the edge spans. These must fall, in the mean or in the geometric mean, by 2 % at least, and the mean must
/// not grow by more than 5 %.
///
/// Returns why the vertices are better left where they are, a sentence with the method's name and both
/// figures; empty if the order is better. O(n + entries).
std::string reason_to_keep(GraphRef graph, const Permutation& order, std::string_view method,
                           Workload workload);

}  // namespace meshorder
