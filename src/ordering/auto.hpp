// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"

namespace meshorder {

/// Returns the vertex method that measurements favour for this graph and workload: never `auto` itself, and a
/// method that needs coordinates only if coordinates distinguish the vertices. docs/auto.md has the evidence.
/// O(n).
MethodChoice choose_vertex_method(const VertexInput& input, Workload workload);

/// Returns the element method that measurements favour for that workload. O(1).
MethodChoice choose_element_method(const ElementInput& input, Workload workload);

}  // namespace meshorder
