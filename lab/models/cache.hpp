// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <filesystem>
#include <string_view>

namespace meshorder::models {

/// `$MESHORDER_CACHE`, or else `$XDG_CACHE_HOME/meshorder`, or else `~/.cache/meshorder`. Throws Error when
/// none of the variables is set.
std::filesystem::path cache_folder();

/// Makes a folder and those above it. Throws Error when it cannot be made.
void make_folder(const std::filesystem::path& folder);

/// The right to make one thing in the cache: a second process that wants it waits in the constructor. It ends
/// with the process at the latest.
class MakingLock {
 public:
  /// `folder` must exist. Throws Error when it cannot be written.
  MakingLock(const std::filesystem::path& folder, std::string_view name);
  ~MakingLock();
  MakingLock(const MakingLock&) = delete;
  MakingLock(MakingLock&&) = delete;
  MakingLock& operator=(const MakingLock&) = delete;
  MakingLock& operator=(MakingLock&&) = delete;

 private:
  int file_;
};

/// An empty folder for what is being made, `folder/.NAME.making`; to be used under the lock of that name.
/// It is removed in the end, and what an interrupted process left in it is removed at the start.
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

/// Numbers of a mesh in TetGen's format from the first lines of its two files; both are 0 unless both files
/// are there.
struct Counts {
  Index vertices = 0;
  Index elements = 0;
};
Counts counts_of(const std::filesystem::path& node_file);

/// Moves `from.node` and `from.ele` to `to.node` and `to.ele`, for paths without extension in one file
/// system. Throws Error when it cannot.
void publish(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace meshorder::models
