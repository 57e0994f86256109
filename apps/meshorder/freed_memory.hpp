// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::command {

/// Has the process keep the memory that it frees for what any of its threads allocates next, where the C
/// library is glibc. By default blocks of 32 MiB and more go back to the system, which clears every page of
/// the next one anew: for a mesh of 1.8 million vertices a sixth of the time of `meshorder order`. The peak
/// of the memory in use grows by up to a fifth.
void keep_freed_memory() noexcept;

}  // namespace meshorder::command
