// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace meshorder {

/// Processors to bind `threads` threads to: of those that this process may use the last ones, each of a core
/// of its own as long as there are such, since systems like to serve interrupts on the first. Empty where the
/// system does not tell, or has fewer.
std::vector<int> choose_processors(int threads);

/// Binds this process, and what it starts from now on, to them; false where the system refuses.
bool bind_to(const std::vector<int>& processors);

}  // namespace meshorder
