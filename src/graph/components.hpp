// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <vector>

namespace meshorder {

/// The vertices of each connected component, rising; components by falling size, ties by their smallest
/// vertex, so that isolated vertices come last. O(n + edges).
std::vector<std::vector<Index>> connected_components(const CsrGraph& graph);

}  // namespace meshorder
