// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/registry.hpp>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

namespace meshorder {

/// Returns the method of that name in a list, which is `vertex_methods()` or `element_methods()`; nothing if
/// there is none.
inline std::optional<MethodInfo> method_named(const std::vector<MethodInfo>& methods, std::string_view name) {
  const auto found =
      std::ranges::find_if(methods, [&](const MethodInfo& method) { return method.name == name; });
  return found == methods.end() ? std::nullopt : std::optional(*found);
}

/// Returns whether the method of that name in the list needs coordinates.
inline bool needs_points(const std::vector<MethodInfo>& methods, std::string_view name) {
  const std::optional<MethodInfo> method = method_named(methods, name);
  return method && method->needs_points;
}

}  // namespace meshorder
