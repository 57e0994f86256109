// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::hdf5 {

/// Has libhdf5 close nothing at the end of the process: where a file could not be closed it crashes when it
/// tries again. For programs, not for libraries, and before any other call of libhdf5.
void close_nothing_at_exit();

}  // namespace meshorder::hdf5
