// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "mesh/simplices.hpp"
#include <meshorder/payoff.hpp>

namespace meshorder {

/// Returns how many threads compute an element or edge of a kernel, in the mean, when so many share a run as
/// KernelBench does: each computes all that touch a vertex that it owns. 1 for products with the matrix and
/// on one thread; 1.02 where every fiftieth lies between two threads' vertices; up to the number of threads
/// where the order is scrambled. `graph` is the vertex graph of a mesh and `simplices` the result of
/// `cut_into_simplices`, both in the order to be judged. O(entries · log threads).
double times_computed(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int threads);

}  // namespace meshorder
