// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/descriptor.hpp"
#include "io/stream/folder_locks.hpp"

#include <filesystem>
#include <optional>

namespace meshorder {

/// Keeps other processes from working on a study's folder, until the lock is destroyed or the process ends.
class FolderLock {
 public:
  /// Throws InputError if another process holds the lock; the error names that process if it is found. If
  /// locking fails for another reason, the folder is not locked.
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  Descriptor descriptor_;
  std::optional<HeldFolder> held_;
};

}  // namespace meshorder
