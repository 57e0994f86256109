// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_journal.hpp"

#include "base/checksum.hpp"
#include "io/stream/output_place.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <set>
#include <system_error>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

bool is_there(const fs::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

int rename_file(const fs::path& from, const fs::path& to) {
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

int unlink_file(const fs::path& path) { return ::unlink(path.c_str()) == 0 || errno == ENOENT ? 0 : errno; }

}  // namespace

fs::path scratch_in_set(const fs::path& target) {
  Checksum hash;
  hash.add_all(target.filename().string());
  return folder_of(target) /
         fmt::format("{}{:016x}{}", Scratch::kPrefix, hash.value(), Scratch::kSuffixInSet);
}

int apply(const JournalEntry& entry) {
  const fs::path old = entry.scratch / kOldFile;
  const fs::path fresh = entry.scratch / Scratch::kNew;
  if (entry.step == Step::remove) {
    // where the file system has no hard links, the old file itself is kept
    return is_there(old) || !is_there(entry.target) ? unlink_file(entry.target)
                                                    : rename_file(entry.target, old);
  }
  if (!is_there(fresh)) return 0;
  if (entry.step == Step::replace && !is_there(old) && is_there(entry.target)) {
    if (const int error = rename_file(entry.target, old); error != 0) return error;
  }
  return rename_file(fresh, entry.target);
}

int take_back(const JournalEntry& entry) {
  const fs::path old = entry.scratch / kOldFile;
  if (entry.step == Step::create)
    return is_there(entry.scratch / Scratch::kNew) ? 0 : unlink_file(entry.target);
  return is_there(old) ? rename_file(old, entry.target) : 0;
}

int sync_targets(const std::vector<JournalEntry>& entries) {
  std::set<fs::path> folders;
  for (const JournalEntry& entry : entries) folders.insert(folder_of(entry.target));
  for (const fs::path& folder : folders) {
    if (const int error = sync_folder(folder); error != 0) return error;
  }
  return 0;
}

std::string stored_path(const fs::path& path, const fs::path& folder) {
  if (folder_of(path) == folder) return path.filename().string();
  std::error_code ignored;
  return fs::absolute(path, ignored).string();
}

fs::path path_from(std::string_view stored, const fs::path& folder) { return folder / fs::path(stored); }

std::string journal_text(const std::vector<JournalEntry>& entries, const fs::path& folder) {
  std::string text;
  for (const JournalEntry& entry : entries) {
    text += static_cast<char>(entry.step);
    text += stored_path(entry.scratch, folder) + '\0';
    text += stored_path(entry.target, folder) + '\0';
  }
  return text;
}

std::vector<JournalEntry> journal_from(std::string_view text, const fs::path& folder) {
  std::vector<JournalEntry> entries;
  const auto next = [&] {
    const std::string_view field = text.substr(0, text.find('\0'));
    text.remove_prefix(std::min(field.size() + 1, text.size()));
    return path_from(field, folder);
  };
  while (!text.empty()) {
    const auto step = static_cast<Step>(text.front());
    text.remove_prefix(1);
    fs::path scratch = next();
    entries.push_back({step, std::move(scratch), next()});
  }
  return entries;
}

}  // namespace meshorder
