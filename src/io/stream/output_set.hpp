// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/output_file.hpp"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Output files that belong together: those written to a `FilePath` of this set. `commit` puts all in place.
class OutputSet {
 public:
  OutputSet() = default;
  ~OutputSet() = default;
  OutputSet(const OutputSet&) = delete;
  OutputSet(OutputSet&&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;
  OutputSet& operator=(OutputSet&&) = delete;

  /// Adds a file that is written to its end; `OutputFile::commit` calls this. Throws InputError if it cannot
  /// be closed.
  void add(OutputFile&& file);

  /// Has `commit` remove a file, if it exists, that an earlier run left and that is not part of these.
  void remove(FilePath path) { removals_.push_back(std::move(path)); }

  /// Has `commit` take away the old file that names the others, or one that no reader does without, before it
  /// puts the others in place: a process that is killed in between leaves a set that cannot be read. For
  /// outputs without a mark (see `put_in_place`). The new one is to be added last.
  void remove_first(FilePath path) { removals_first_.push_back(std::move(path)); }

  /// Puts all files in place. Throws InputError as `put_in_place`.
  void commit();

  /// Returns notes on files that were replaced: those with further hard links, which keep the old content.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  std::vector<OutputFile> files_;
  std::vector<FilePath> removals_first_;
  std::vector<FilePath> removals_;
  std::vector<std::string> notes_;
};

/// An output that is written to its end.
struct FinishedFile {
  std::filesystem::path scratch;  ///< scratch folder beside the target, with the output as `new`
  FilePath target;
};

/// Puts files in place of their targets, and takes others away. Every output of the program goes through
/// here:
///
/// 1. each file gets the attributes of the one that it replaces, and is synced;
/// 2. the folders are locked (`flock`), so that sets of two processes do not mix;
/// 3. `removed_first` are moved into scratch folders; each file is renamed over its target, in this order;
///    `removed` are moved away;
/// 4. the folders are synced and unlocked.
///
/// Until 3 the old files are there. An error in 3 or 4 puts them back. A process that is killed in 3 leaves
/// some files new and others old, each whole. The readers of TetGen, XDMF and maps refuse such a mixture by a
/// mark in each file; sets without marks name a file as `removed_first`. Nobody can hold up an output by
/// holding the lock: after some seconds it is done without.
///
/// @return notes on files with further hard links, which keep the old content
/// @throws InputError if a file cannot be completed or replaced, two have one target, or a target is no
///         longer beside its scratch folder; names the files that could not be put back
std::vector<std::string> put_in_place(std::span<const FinishedFile> files,
                                      std::span<const FilePath> removed_first = {},
                                      std::span<const FilePath> removed = {});

/// As `put_in_place`.
using PutInPlace = std::function<std::vector<std::string>(std::span<const FinishedFile> files,
                                                          std::span<const FilePath> removed_first,
                                                          std::span<const FilePath> removed)>;

/// Has outputs whose scratch folders are not beside them (`keep_scratches_in`) put in place by another
/// process, which this one asks by that function. To be called while there is one thread.
void put_in_place_by(PutInPlace other);

}  // namespace meshorder
