// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"

namespace meshorder {

/// The vertex method that measurements favour for that graph and use: never `auto` itself, and none that
/// needs coordinates where there are none that tell vertices apart. The rules stand in auto.cpp, one line and
/// its evidence each. O(n).
MethodChoice choose_vertex_method(const VertexProblem& problem, Workload use);

/// The element method that measurements favour for that use. O(1).
MethodChoice choose_element_method(const ElementProblem& problem, Workload use);

}  // namespace meshorder
