// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::command {

/// Makes the process keep freed memory for later allocations of any thread, if the C library is glibc. By
/// default, blocks of 32 MiB and more go back to the system, which clears every page again for the next
/// block. This takes a sixth of the time of `meshorder order` for a mesh of 1.8 million vertices. The peak of
/// the memory in use grows by up to a fifth.
void keep_freed_memory() noexcept;

}  // namespace meshorder::command
