// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <mutex>

namespace meshorder::hdf5 {

/// Returns what a thread holds while it is in libhdf5, or in libnetcdf, which calls it: neither may be
/// entered by two threads.
inline std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

}  // namespace meshorder::hdf5
