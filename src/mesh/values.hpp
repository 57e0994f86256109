// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace meshorder {

/// Returns the number of values, whatever their type.
inline std::size_t size_of(const Values& values) {
  return std::visit([](const auto& numbers) { return numbers.size(); }, values);
}

/// Returns whether values are texts, not numbers.
inline bool are_texts(const Values& values) {
  return std::holds_alternative<std::vector<std::string>>(values);
}

}  // namespace meshorder
