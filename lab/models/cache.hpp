// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <filesystem>
#include <string_view>

namespace meshorder::models {

/// Returns `$MESHORDER_CACHE`, else `$XDG_CACHE_HOME/meshorder`, else `~/.cache/meshorder`. Throws Error if
/// neither these variables nor HOME are set.
std::filesystem::path cache_folder();

/// Makes a folder and its parents. Throws Error if that fails.
void make_folder(const std::filesystem::path& folder);

/// A lock for making one file in the cache: a second process waits in the constructor. The end of the process
/// releases the lock at the latest.
class MakingLock {
 public:
  /// Waits for the lock. `folder` must exist. Throws Error if the folder cannot be written.
  MakingLock(const std::filesystem::path& folder, std::string_view name);
  ~MakingLock();
  MakingLock(const MakingLock&) = delete;
  MakingLock(MakingLock&&) = delete;
  MakingLock& operator=(const MakingLock&) = delete;
  MakingLock& operator=(MakingLock&&) = delete;

 private:
  int file_;
};

/// An empty folder for unfinished files, `folder/.NAME.making`, to be used under the lock of that name. The
/// destructor removes the folder; the constructor removes files that an interrupted process left.
class ScratchFolder {
 public:
  ScratchFolder(const std::filesystem::path& folder, std::string_view name);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder(ScratchFolder&&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ScratchFolder& operator=(ScratchFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

/// Numbers of vertices and elements in the first lines of a mesh's TetGen files; 0 unless both files exist.
struct Counts {
  Index vertices = 0;
  Index elements = 0;
};
Counts counts_of(const std::filesystem::path& node_file);

/// Moves `from.node` and `from.ele` to `to.node` and `to.ele` in the same file system. Throws Error if that
/// fails.
void publish(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace meshorder::models
