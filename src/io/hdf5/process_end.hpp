// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::hdf5 {

/// Stops libhdf5 from closing files at the end of the process: it crashes there if it tries again to close a
/// file that could not be closed. For programs, not libraries; to be called before any use of libhdf5.
void close_nothing_at_exit();

}  // namespace meshorder::hdf5
