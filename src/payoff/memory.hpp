// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace meshorder {

/// Bytes of physical memory, or what the control group leaves of it.
std::size_t memory_of_this_machine();

}  // namespace meshorder
