// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/output_file.hpp"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Output files that belong together: the files written to a `FilePath` of this set. `commit` puts all files
/// in place.
class OutputSet {
 public:
  OutputSet() = default;
  ~OutputSet() = default;
  OutputSet(const OutputSet&) = delete;
  OutputSet(OutputSet&&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;
  OutputSet& operator=(OutputSet&&) = delete;

  /// Adds a file to which nothing more is written; `OutputFile::commit` calls this. Throws InputError if the
  /// file cannot be closed.
  void add(OutputFile&& file);

  /// Makes `commit` remove a file of an earlier run if it exists and is not part of this set.
  void remove(FilePath path) { removals_.push_back(std::move(path)); }

  /// Makes `commit` first remove an old file without which nobody can read the other old files, for example a
  /// file that names them. If the process is then killed, nobody reads a mixture of old and new files. For
  /// outputs without a mark (see `put_in_place`). Add the new version of that file last.
  void remove_first(FilePath path) { removals_first_.push_back(std::move(path)); }

  /// Puts all files in place. Throws InputError as `put_in_place`.
  void commit();

  /// Returns the paths of the files added since the last `commit`.
  [[nodiscard]] std::vector<std::string> files() const;

  /// Returns notes on replaced files with further hard links, which keep the old content.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  std::vector<OutputFile> files_;
  std::vector<FilePath> removals_first_;
  std::vector<FilePath> removals_;
  std::vector<std::string> notes_;
};

/// An output to which nothing more is written.
struct FinishedFile {
  std::filesystem::path scratch;  ///< scratch folder beside the target, with the output as `new`
  FilePath target;
};

/// Replaces targets by new files, and removes other files. Every output that is an ordinary file goes through
/// this function:
///
/// 1. each file gets the attributes of the file that it replaces, and is synced;
/// 2. the folders are locked (`flock`): sets of two processes do not mix;
/// 3. in this order: `removed_first` are moved into scratch folders, each new file is renamed over its
///    target, and `removed` are moved into scratch folders;
/// 4. the folders are synced and unlocked.
///
/// Until step 3 the old files are in place. An error in step 3 or 4 puts them back. A process that is killed
/// in step 3 leaves some files new and others old, each complete. The readers of TetGen, XDMF and maps refuse
/// such a mixture by a mark in each file; sets without marks name a file as `removed_first`. Nobody can hold
/// up an output by holding a lock: after ten seconds the files are put in place without the lock.
///
/// @return notes on files with further hard links, which keep the old content
/// @throws InputError if a file cannot be completed or replaced, two files have the same target, or a target
///         is no longer beside its scratch folder; names the files that could not be put back
std::vector<std::string> put_in_place(std::span<const FinishedFile> files,
                                      std::span<const FilePath> removed_first = {},
                                      std::span<const FilePath> removed = {});

/// A function with the parameters, result and errors of `put_in_place`.
using PutInPlace = std::function<std::vector<std::string>(std::span<const FinishedFile> files,
                                                          std::span<const FilePath> removed_first,
                                                          std::span<const FilePath> removed)>;

/// Makes `put_in_place` call `other`, which asks another process, for outputs whose scratch folders are
/// elsewhere (`keep_scratches_in`). Call it while there is one thread.
void put_in_place_by(PutInPlace other);

}  // namespace meshorder
