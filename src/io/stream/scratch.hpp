// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/descriptor.hpp"

#include <filesystem>
#include <string_view>

namespace meshorder {

/// A folder beside an output for unfinished files: `.meshorder-DIGITS.new`, of mode 700, with a name that
/// nobody can guess. Its file `lock` is locked (`flock`) while the process lives; other machines that share
/// the disk see the lock. The folder holds the new file, and the old one while files are put in place
/// (`put_in_place`). Unfinished outputs are kept nowhere else.
class Scratch {
 public:
  /// Makes the folder in `place_of_scratches` of the folder of `target`. Throws InputError if the system
  /// refuses.
  explicit Scratch(const std::filesystem::path& target);
  /// Removes the folder with its content, including files that dead processes left in it.
  ~Scratch();
  Scratch(Scratch&& other) noexcept;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  Scratch& operator=(Scratch&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Returns the path of a file in the folder.
  [[nodiscard]] std::filesystem::path file(std::string_view name = kNew) const { return path_ / name; }

  // contents besides the lock
  static constexpr std::string_view kNew = "new";
  static constexpr std::string_view kOld = "old";

 private:
  std::filesystem::path path_;
  Descriptor lock_;
  int slot_ = -1;
};

/// Makes `place` the parent of new scratch folders for outputs in `folder`; both must be in the same file
/// system. For a process that may write only to `place`. Call it while there is one thread.
void keep_scratches_in(const std::filesystem::path& place, const std::filesystem::path& folder);

/// Returns the parent of scratch folders for outputs in `folder`: `folder` itself, unless `keep_scratches_in`
/// set another.
std::filesystem::path place_of_scratches(const std::filesystem::path& folder);

/// Removes the scratch folders that dead processes of this user left in a folder; for commands that write
/// there. Only the first call for a folder in a process does this. Removes only folders that have the name of
/// a scratch folder and either are empty or have a free `lock`; in these, removes only `new`, `old`, `lock`
/// and scratch folders. Follows no links. Files that cannot be removed stay.
void remove_dead_scratches(const std::filesystem::path& folder);

/// Removes the scratch folders of this process, up to 1,024. For a signal handler that ends the process:
/// calls only system functions that are safe there.
void remove_unfinished_outputs() noexcept;

/// A folder for temporary files that only this user can read; the destructor removes it and its content.
class PrivateFolder {
 public:
  /// Throws InputError if the folder cannot be made.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder(PrivateFolder&&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  PrivateFolder& operator=(PrivateFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace meshorder
