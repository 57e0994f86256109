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

/// Gives up all other rights of this process and of the threads that it starts, for good: to open other files
/// (Landlock, from Linux 5.13 on), to use the network, to start programs and processes, to reach other
/// processes, to change modes and owners of files by their paths, and to type into the terminal (seccomp). It
/// disables core files. Rights that the system cannot restrict remain. Call it while there is one thread.
void give_up_rights(const Reach& reach) noexcept;

}  // namespace meshorder::command
