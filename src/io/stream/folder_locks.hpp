// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/descriptor.hpp"

#include <filesystem>
#include <set>
#include <vector>

namespace meshorder {

/// Locks on folders (`flock`), by which only one process at a time renames files there. Whoever may read a
/// folder can lock it, so nobody waits for long: after ten seconds the locks are done without, and so they
/// are where a folder cannot be opened or the file system has none.
class FolderLocks {
 public:
  /// Locks the folders, always in the same order, so that no two processes wait for each other; of many
  /// folders the first ones, which suffices for sets of the same folders.
  explicit FolderLocks(const std::set<std::filesystem::path>& folders);

 private:
  std::vector<Descriptor> locked_;
};

}  // namespace meshorder
