// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/kernel_bench.hpp"
#include <meshorder/payoff.hpp>

#include <string_view>

namespace meshorder {
inline namespace v0_3 {

std::string_view to_string(Kernel kernel) { return to_string<Kernel>(kernel); }
std::string_view to_string(KernelSet kernels) { return to_string<KernelSet>(kernels); }
KernelSet parse_kernels(std::string_view name) { return parse<KernelSet>(name); }

}  // namespace v0_3
}  // namespace meshorder
