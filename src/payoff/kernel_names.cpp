// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/kernel_bench.hpp"
#include <meshorder/payoff.hpp>

#include <string_view>

namespace meshorder {
inline namespace v0_2 {

std::string_view to_string(Kernel kernel) { return to_string<Kernel>(kernel); }

}  // namespace v0_2
}  // namespace meshorder
