// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/output_file.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder {

/// Output files that belong together: those written to a `FilePath` of this set. All take their places at
/// `commit` or none does, whenever the process or the machine stops.
///
/// A file alone: written to a scratch folder beside its target, synced, renamed over the target; then the
/// folder is synced. Several files:
///
/// 1. each is complete and synced in its scratch folder, with a hard link to the old file as `old`;
/// 2. each scratch folder gets the name `.meshorder-HASH.set`, by which a reader of the target finds it, and
///    the file `set` names that of the first target;
/// 3. that one gets the file `journal`, which lists all targets: from here on the new files count;
/// 4. each file is renamed over its target, the folders are synced, and the scratch folders removed.
///
/// What stops before 3 leaves the old files; `finish_interrupted`, which readers and writers call, removes
/// the scratch folders or, after 3, does the rest of 4. An error in 4 makes `journal` into `undo`, and puts
/// the old files back.
class OutputSet {
 public:
  OutputSet() = default;
  ~OutputSet() = default;
  OutputSet(const OutputSet&) = delete;
  OutputSet(OutputSet&&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;
  OutputSet& operator=(OutputSet&&) = delete;

  /// Adds a file that is written to its end; `OutputFile::commit` calls this. Throws InputError if it cannot
  /// be completed.
  void add(OutputFile&& file);

  /// Has `commit` remove a file, if it exists, that an earlier run left and that is not part of these.
  void remove(const std::filesystem::path& path) { removals_.push_back(path); }

  /// Puts all files in place. Throws InputError, with the old files as they were, if one cannot be.
  void commit();

  /// Returns notes on files that were replaced: those with further hard links, which keep the old content.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  std::vector<OutputFile> files_;
  std::vector<std::filesystem::path> removals_;
  std::vector<std::string> notes_;
};

/// Completes or undoes what a process that was stopped left of a set of files, if the file was one of them.
/// Two system calls where there is nothing to do. Throws InputError while another process puts the files in
/// place, and if the rest is another user's or cannot be done: the file may not fit the others.
void finish_interrupted(const std::filesystem::path& path);

/// Removes what stopped processes of this user left in a folder, and completes sets of files: at the first
/// call for the folder in a process. What cannot be done stays.
void clean_up_outputs(const std::filesystem::path& folder);

/// Renames a complete file and syncs the folder. Throws InputError.
void move_into_place(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace meshorder
