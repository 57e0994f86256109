// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/scratch.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace meshorder {

/// What is done to a file of a set.
enum class Step : char { create = 'c', replace = 'w', remove = 'r' };

/// A file of a set that is being put in place.
struct JournalEntry {
  Step step;
  std::filesystem::path scratch;  ///< the folder with the new file, and the old one as `old`
  std::filesystem::path target;
};

inline constexpr const char* kOldFile = "old";
inline constexpr const char* kJournal = "journal";
inline constexpr const char* kUndo = "undo";
inline constexpr const char* kSetFile = "set";

/// Returns the path of the scratch folder while the file is put in place with others.
std::filesystem::path scratch_in_set(const std::filesystem::path& target);

/// Puts the new file in the place of the old one, or removes that; nothing where this is done already.
/// Returns 0 or an `errno`.
[[nodiscard]] int apply(const JournalEntry& entry);

/// Puts the old file back, or removes the one that is new; likewise.
[[nodiscard]] int take_back(const JournalEntry& entry);

/// Syncs each of the folders with targets once. Returns 0 or an `errno`.
[[nodiscard]] int sync_targets(const std::vector<JournalEntry>& entries);

/// Returns a journal as the bytes of a file in `folder`: paths below it are written without it, so that the
/// folder may be moved.
std::string journal_text(const std::vector<JournalEntry>& entries, const std::filesystem::path& folder);
std::vector<JournalEntry> journal_from(std::string_view text, const std::filesystem::path& folder);

/// Returns a path as it is written into files of a set in `folder`, and back.
std::string stored_path(const std::filesystem::path& path, const std::filesystem::path& folder);
std::filesystem::path path_from(std::string_view stored, const std::filesystem::path& folder);

}  // namespace meshorder
