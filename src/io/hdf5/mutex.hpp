// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <utility>

namespace meshorder::hdf5 {

using LibraryLock = std::unique_lock<std::recursive_mutex>;

/// Function that is called once, just before a thread first enters the library. Set it earlier.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): as the library has its state
inline void (*at_first_entry)() = nullptr;

/// Returns the lock that a thread must hold while it is in libhdf5, or in libnetcdf, which calls libhdf5: two
/// threads must not be in them at the same time.
[[nodiscard]] inline LibraryLock enter_library() {
  static std::recursive_mutex mutex;
  LibraryLock lock(mutex);
  if (const auto prepare = std::exchange(at_first_entry, nullptr); prepare != nullptr) prepare();
  return lock;
}

/// Stops libhdf5 from closing files at the end of the process: libhdf5 would crash when it tries again to
/// close a file that it could not close. For programs, not libraries. Call it before any use of libhdf5.
void close_nothing_at_exit();

}  // namespace meshorder::hdf5
