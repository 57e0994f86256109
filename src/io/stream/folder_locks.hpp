// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/descriptor.hpp"

#include <sys/types.h>

#include <filesystem>
#include <set>
#include <utility>
#include <vector>

namespace meshorder {

/// Marks a folder that this process has locked by other means, until the destructor. `FolderLocks` skips such
/// folders; otherwise the process would wait for itself.
class HeldFolder {
 public:
  /// @param descriptor  a descriptor of the open folder
  explicit HeldFolder(int descriptor);
  ~HeldFolder();
  HeldFolder(const HeldFolder&) = delete;
  HeldFolder(HeldFolder&&) = delete;
  HeldFolder& operator=(const HeldFolder&) = delete;
  HeldFolder& operator=(HeldFolder&&) = delete;

 private:
  std::pair<dev_t, ino_t> identity_{};
};

/// Locks on folders (`flock`): only one process at a time renames files there. Anyone who may read a folder
/// can lock it. Therefore the wait is limited: after ten seconds the process goes on without the remaining
/// locks. The process also goes on if a folder cannot be opened or the file system has no locks.
class FolderLocks {
 public:
  /// Locks the folders, always in the same order: two processes then never wait for each other. If there are
  /// many folders, locks only the first ones, which suffices if all processes name the same folders.
  explicit FolderLocks(const std::set<std::filesystem::path>& folders);

 private:
  std::vector<Descriptor> locked_;
};

}  // namespace meshorder
