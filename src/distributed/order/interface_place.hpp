// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace meshorder::distributed {

/// Where a part's interface is in its order: the vertices that share an element with vertices of other parts.
enum class InterfacePlace : std::uint8_t {
  mixed,  ///< anywhere, as the method orders them
  last,   ///< after the other vertices of the part; both keep the order that the method gives them
};

}  // namespace meshorder::distributed

namespace meshorder {

template <>
struct EnumNames<distributed::InterfacePlace> {
  static constexpr std::string_view kind = "place of the interface";
  static constexpr std::array names{std::pair{distributed::InterfacePlace::mixed, "mixed"},
                                    std::pair{distributed::InterfacePlace::last, "last"}};
};

}  // namespace meshorder
