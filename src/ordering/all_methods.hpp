// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"

#include <vector>

namespace meshorder {

// The built-in methods. Each is defined in the file of its family; method.cpp lists them.
Order auto_vertices(const VertexInput&, const OrderOptions&);
Order original_vertices(const VertexInput&, const OrderOptions&);
Order scrambled_vertices(const VertexInput&, const OrderOptions&);
Order fiedler_vertices(const VertexInput&, const OrderOptions&);
Order minla_vertices(const VertexInput&, const OrderOptions&);
Order spectral_vertices(const VertexInput&, const OrderOptions&);
Order rcm_vertices(const VertexInput&, const OrderOptions&);
Order bfs_vertices(const VertexInput&, const OrderOptions&);
Order mdf_vertices(const VertexInput&, const OrderOptions&);
Order morton_vertices(const VertexInput&, const OrderOptions&);
Order hilbert_vertices(const VertexInput&, const OrderOptions&);
Order metis_nd_vertices(const VertexInput&, const OrderOptions&);
Order metis_rb_vertices(const VertexInput&, const OrderOptions&);

Order auto_elements(const ElementInput&, const OrderOptions&);
Order original_elements(const ElementInput&, const OrderOptions&);
Order scrambled_elements(const ElementInput&, const OrderOptions&);
Order fiedler_elements(const ElementInput&, const OrderOptions&);
Order fiedler_facet_elements(const ElementInput&, const OrderOptions&);
Order mean_elements(const ElementInput&, const OrderOptions&);
Order min_elements(const ElementInput&, const OrderOptions&);
Order max_elements(const ElementInput&, const OrderOptions&);
Order lexmax_elements(const ElementInput&, const OrderOptions&);
Order hilbert_elements(const ElementInput&, const OrderOptions&);

std::vector<MethodInfo> built_in_vertex_methods();
std::vector<MethodInfo> built_in_element_methods();

// Functions that several methods share.

/// Renumbers each chunk of 2,048 vertices of an order breadth first. The search starts from the vertices with
/// neighbours in earlier chunks, those with the earliest neighbour first.
///
/// A sweep over rows or edges then touches new vertices nearly in the order of their numbers. It reads memory
/// forward, as after breadth-first numbering of the whole graph, so that processors prefetch vectors that
/// exceed the last cache. Vertices move only within their chunk, so each chunk remains the same compact
/// region.
///
/// O(n + edges · log degree) on all threads; the result does not depend on the number of threads.
Permutation in_fronts(GraphRef graph, const Permutation& order);

/// Orders a small graph by bisection down to a few vertices. Returns the vertices in their new order.
///
/// Each piece is cut at the median of a smooth function: the distance from one far end minus the distance
/// from the other far end, averaged over neighbours a few times. These are a few steps of the power method
/// from a good start; in small graphs the result is close enough to the Fiedler vector. A piece that is not
/// connected is ordered component by component.
///
/// For each vertex, `pull` has the number of neighbours that come before this graph in the whole order, minus
/// the number that come after. Each cut takes the direction that brings vertices nearer to these neighbours.
/// O((n + edges) · log n) time, O(n + edges) memory; one thread.
std::vector<Index> smoothed_bisection(CsrGraph graph, std::vector<float> pull);

}  // namespace meshorder
