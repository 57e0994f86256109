// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace meshorder::command {

/// Paths that a process may still use, besides system libraries and files about itself and the machine.
struct Reach {
  std::vector<std::filesystem::path> read;     ///< files, and folders with everything below them
  std::vector<std::filesystem::path> write;    ///< folders below which everything is allowed
  std::vector<std::filesystem::path> through;  ///< devices and pipes that may be written to
};

/// Takes these rights from this process and from the threads that it starts, for good:
/// - to open files other than those in `reach` (Landlock, from Linux 5.13 on);
/// - to use the network (seccomp denies this and the following);
/// - to start programs and processes;
/// - to reach other processes;
/// - to change modes and owners of files by their paths;
/// - to type into the terminal.
///
/// Also disables core files. Rights that the system cannot restrict remain. Call it while there is one
/// thread.
void give_up_rights(const Reach& reach) noexcept;

}  // namespace meshorder::command
