// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/folder_lock.hpp"

#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>

namespace meshorder {
namespace {

/// Returns the id of the process that holds a lock on an open file, per /proc/locks; 0 if none is found.
long holder_of(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return 0;
  const std::string inode = fmt::format(":{}", status.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    // 1: FLOCK  ADVISORY  WRITE 1234 08:01:5678 0 EOF
    std::istringstream words(line);
    std::string number, kind, force, access, place;
    long process = 0;
    if (words >> number >> kind >> force >> access >> process >> place && kind == "FLOCK" &&
        place.ends_with(inode))
      return process;
  }
  return 0;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : descriptor_(folder, O_RDONLY | O_DIRECTORY) {
  if (!descriptor_.is_open()) return;
  const int error = descriptor_.try_lock();
  if (error == 0) held_.emplace(descriptor_.get());
  if (error != EWOULDBLOCK) return;
  const long process = holder_of(descriptor_.get());
  throw InputError(folder.string(),
                   process > 0 ? fmt::format("process {} is using the study in this folder", process)
                               : "another process is using the study in this folder",
                   "wait until it has ended, or name another folder");
}

}  // namespace meshorder
