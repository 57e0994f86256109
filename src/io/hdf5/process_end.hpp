// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::hdf5 {

/// Stops libhdf5 from closing files at the end of the process: there it crashes if it again tries to close a
/// file that it could not close. For programs, not libraries. Call it before any use of libhdf5.
void close_nothing_at_exit();

}  // namespace meshorder::hdf5
