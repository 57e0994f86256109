// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <utility>

namespace meshorder::hdf5 {

using LibraryLock = std::unique_lock<std::recursive_mutex>;

/// Called once, by the first thread that enters the library, before it does; set before.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): of the process, as the library's state
inline void (*at_first_entry)() = nullptr;

/// Returns what a thread holds while it is in libhdf5, or in libnetcdf, which calls it: neither may be
/// entered by two threads.
[[nodiscard]] inline LibraryLock enter_library() {
  static std::recursive_mutex mutex;
  LibraryLock lock(mutex);
  if (const auto prepare = std::exchange(at_first_entry, nullptr); prepare != nullptr) prepare();
  return lock;
}

}  // namespace meshorder::hdf5
