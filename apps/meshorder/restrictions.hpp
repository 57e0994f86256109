// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
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

class Ruleset;

/// Rules by which a program can write to no file of some originals (Landlock, from Linux 6.2 on). The program
/// cannot write, cut, add, rename or remove anything below them; to change a mode or a time stays possible.
/// In the folders that contain an original, the program cannot add, rename or remove entries, either.
class WriteProtection {
 public:
  /// @param originals  files and folders
  /// @param allowed    a folder that may be written to even if it is below an original
  WriteProtection(const std::vector<std::filesystem::path>& originals, const std::filesystem::path& allowed);
  ~WriteProtection();
  WriteProtection(const WriteProtection&) = delete;
  WriteProtection(WriteProtection&&) = delete;
  WriteProtection& operator=(const WriteProtection&) = delete;
  WriteProtection& operator=(WriteProtection&&) = delete;

  /// Returns whether the system can enforce the rules.
  [[nodiscard]] bool is_possible() const noexcept;

  /// Enforces the rules on this process and on the programs that it starts, for good. They cannot get the
  /// rights of another user, either (sudo). Returns whether it succeeded; `errno` then says why not. Calls
  /// only functions that are safe after a fork.
  [[nodiscard]] bool enforce() const noexcept;

 private:
  std::unique_ptr<const Ruleset> rules_;
};

}  // namespace meshorder::command
