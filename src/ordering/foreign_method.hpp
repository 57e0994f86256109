// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/registry.hpp>

#include <meshorder.h>

#include <cstdint>
#include <string>

namespace meshorder {

/// Wraps a method of the C interface: passes the arrays of the graph to the method and checks the result.
///
/// The wrapper throws InternalError if the method fails or returns no bijection.
VertexMethod foreign_vertex_method(std::string name, mo_method method, void* user);

/// Registers a method of the C interface for the rest of the program; the parameters are those of
/// `mo_register`.
///
/// @param source  `MethodInfo::source` of the method
/// @throws InvalidArgument as `register_vertex_method`, and for a null name or method
void register_foreign_method(const char* name, const char* description, std::int32_t needs_points,
                             mo_method method, void* user, const std::string& source);

}  // namespace meshorder
