// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "mesh/simplices.hpp"
#include <meshorder/payoff.hpp>

namespace meshorder {

/// Returns the mean number of threads that compute an element or edge of a kernel, when so many threads share
/// a run: each computes all that touch a vertex that it owns (see KernelBench). 1 for products with the
/// matrix and on one thread; 1.02 if every fiftieth lies between vertices of two threads; more in scrambled
/// orders, up to the number of threads or corners. `graph` is the vertex graph of a mesh and `simplices` the
/// result of `cut_into_simplices`, both in the order to be judged. O(entries · log threads).
double times_computed(Kernel kernel, const CsrGraph& graph, SimplicesRef simplices, int threads);

}  // namespace meshorder
