// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"

namespace meshorder {

// Each is defined in the file of its name; method.cpp lists them.
Ordering auto_vertices(const VertexProblem&, const OrderingOptions&);
Ordering original_vertices(const VertexProblem&, const OrderingOptions&);
Ordering scrambled_vertices(const VertexProblem&, const OrderingOptions&);
Ordering fiedler_vertices(const VertexProblem&, const OrderingOptions&);
Ordering minla_vertices(const VertexProblem&, const OrderingOptions&);
Ordering spectral_vertices(const VertexProblem&, const OrderingOptions&);
Ordering rcm_vertices(const VertexProblem&, const OrderingOptions&);
Ordering bfs_vertices(const VertexProblem&, const OrderingOptions&);
Ordering morton_vertices(const VertexProblem&, const OrderingOptions&);
Ordering hilbert_vertices(const VertexProblem&, const OrderingOptions&);
Ordering metis_nd_vertices(const VertexProblem&, const OrderingOptions&);
Ordering metis_rb_vertices(const VertexProblem&, const OrderingOptions&);

Ordering auto_elements(const ElementProblem&, const OrderingOptions&);
Ordering original_elements(const ElementProblem&, const OrderingOptions&);
Ordering scrambled_elements(const ElementProblem&, const OrderingOptions&);
Ordering fiedler_elements(const ElementProblem&, const OrderingOptions&);
Ordering fiedler_facet_elements(const ElementProblem&, const OrderingOptions&);
Ordering mean_elements(const ElementProblem&, const OrderingOptions&);
Ordering min_elements(const ElementProblem&, const OrderingOptions&);
Ordering max_elements(const ElementProblem&, const OrderingOptions&);
Ordering lexmax_elements(const ElementProblem&, const OrderingOptions&);
Ordering hilbert_elements(const ElementProblem&, const OrderingOptions&);

}  // namespace meshorder
