// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/registry.hpp>

#include <meshorder.h>

#include <string>

namespace meshorder {

/// Wraps a method of the C interface: gives it the arrays of the graph, and checks what it returns.
VertexMethod foreign_vertex_method(std::string name, bool needs_points, mo_method method, void* user);

}  // namespace meshorder
