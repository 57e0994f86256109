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

}  // namespace meshorder
