// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_set.hpp"

#include "io/stream/output_journal.hpp"
#include "io/stream/output_place.hpp"
#include "io/stream/system_fault.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

constexpr const char* kCannotReplace = "cannot be replaced";

void require(int error, const fs::path& target) {
  if (error != 0) throw_system_fault(target.string(), kCannotReplace, error);
}

/// Writes a small file of a scratch folder.
void write_small(const fs::path& path, const std::string& text, const fs::path& target) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  require(file.is_open() ? 0 : errno, target);
  require(file.write(text), target);
  require(file.sync(), target);
  require(file.close(), target);
}

std::optional<std::string> content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

int rename_path(const fs::path& from, const fs::path& to) {
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

/// Several files whose scratch folders are complete.
class Commit {
 public:
  Commit(std::vector<JournalEntry> entries, std::vector<Scratch*> scratches)
      : entries_(std::move(entries)), scratches_(std::move(scratches)) {}

  void run() {
    for (std::size_t k = 0; k < entries_.size(); ++k) prepare(k);
    require(sync_targets(entries_), entries_.front().target);
    for (Scratch* const scratch : scratches_) scratch->keep();
    write_journal();
    for (const JournalEntry& entry : entries_) {
      if (const int error = apply(entry); error != 0) roll_back(entry.target, error);
    }
    if (const int error = sync_targets(entries_); error != 0) roll_back(entries_.front().target, error);
    finish(kJournal);
  }

 private:
  void prepare(std::size_t k) {
    JournalEntry& entry = entries_[k];
    Scratch& scratch = *scratches_[k];
    const fs::path folder = folder_of(entry.target);
    // without hard links, `apply` renames the old file
    if (entry.step != Step::create)
      std::ignore = ::link(entry.target.c_str(), scratch.file(kOldFile).c_str());
    write_small(scratch.file(kSetFile), stored_path(scratch_in_set(entries_.front().target), folder),
                entry.target);
    require(sync_folder(scratch.path()), entry.target);
    const fs::path name = scratch_in_set(entry.target);
    int error = scratch.rename(name);
    if (error == EEXIST || error == ENOTEMPTY) {
      finish_interrupted(entry.target);
      error = scratch.rename(name);
    }
    require(error, entry.target);
    entry.scratch = name;
  }

  void write_journal() {
    const JournalEntry& first = entries_.front();
    const fs::path part = first.scratch / "journal.part";
    try {
      write_small(part, journal_text(entries_, folder_of(first.target)), first.target);
      require(rename_path(part, first.scratch / kJournal), first.target);
      require(sync_folder(first.scratch), first.target);
    } catch (...) {
      finish(kJournal);
      throw;
    }
  }

  [[noreturn]] void roll_back(const fs::path& target, int error) {
    const fs::path& first = entries_.front().scratch;
    int failed = rename_path(first / kJournal, first / kUndo);
    if (failed == 0) failed = sync_folder(first);
    for (const JournalEntry& entry : entries_) {
      if (failed == 0) failed = take_back(entry);
    }
    if (failed == 0) failed = sync_targets(entries_);
    if (failed != 0) {
      throw InputError(target.string(),
                       fmt::format("{}: {}; nor could the other files be put back: {}", kCannotReplace,
                                   system_fault(error).reason, system_fault(failed).reason),
                       "mend that, then run meshorder on it, which goes on");
    }
    finish(kUndo);
    throw_system_fault(target.string(), kCannotReplace, error);
  }

  /// Removes what says that there is something left to do, then all else.
  void finish(const char* journal) {
    ::unlink((entries_.front().scratch / journal).c_str());
    for (Scratch* const scratch : scratches_) scratch->remove();
  }

  std::vector<JournalEntry> entries_;
  std::vector<Scratch*> scratches_;
};

// ---- what another process left

[[noreturn]] void throw_unfinished(const fs::path& path, const std::string& remedy) {
  throw InputError(
      path.string(),
      "was being replaced together with other files when meshorder was stopped, and may not fit them",
      remedy);
}

/// Does all that the journal of a set in its first scratch folder says, and removes the folders.
void finish_set(const fs::path& first, const DeadScratch& dead) {
  const fs::path folder = folder_of(first);
  std::vector<JournalEntry> entries;
  for (const char* const journal : {kJournal, kUndo}) {
    const std::optional<std::string> text = content_of(first / journal);
    if (!text) continue;
    entries = journal_from(*text, folder);
    for (const JournalEntry& entry : entries) {
      if (const int error = journal == kJournal ? apply(entry) : take_back(entry); error != 0) {
        const SystemFault fault = system_fault(error);
        throw_unfinished(entry.target, fault.remedy + ": the rest cannot be done, as " + fault.reason);
      }
    }
    if (const int error = sync_targets(entries); error != 0) require(error, entries.front().target);
    ::unlink((first / journal).c_str());
    break;
  }
  for (const JournalEntry& entry : entries) {
    const DeadScratch other(entry.scratch);
    if (other.state() == DeadScratch::State::dead) other.remove();
  }
  dead.remove();
}

/// Finishes the set that a scratch folder belongs to. Returns false while another process does so.
bool finish_set_of(const fs::path& scratch, const DeadScratch& dead) {
  const std::string first_name = content_of(scratch / kSetFile).value_or("");
  const fs::path first = path_from(first_name, folder_of(scratch));
  if (first == scratch) {
    finish_set(scratch, dead);
    return true;
  }
  if (!first_name.empty()) {
    const DeadScratch of_first(first);
    if (of_first.state() == DeadScratch::State::alive || of_first.state() == DeadScratch::State::foreign)
      return false;
    if (of_first.state() == DeadScratch::State::dead) finish_set(first, of_first);
  }
  dead.remove();  // the set is in place, or was given up
  return true;
}

/// Returns whether a scratch folder was made by the owner of the file that it is for, rather than by somebody
/// who wants others to trip over it.
bool is_of_owner(const fs::path& scratch, const fs::path& target) {
  struct stat folder {};
  struct stat file {};
  if (::lstat(scratch.c_str(), &folder) != 0) return false;
  return folder.st_uid == ::geteuid() || ::stat(target.c_str(), &file) != 0 || file.st_uid == folder.st_uid;
}

}  // namespace

void OutputSet::add(OutputFile&& file) {
  file.complete();
  if (file.other_names() > 0) {
    notes_.push_back(fmt::format("{} has {} further name{} (hard links), which keep{} the old content",
                                 file.target().string(), file.other_names(),
                                 file.other_names() == 1 ? "" : "s", file.other_names() == 1 ? "s" : ""));
  }
  files_.push_back(std::move(file));
}

void OutputSet::commit() {
  std::vector<OutputFile> files = std::exchange(files_, {});
  std::vector<JournalEntry> entries;
  std::vector<Scratch*> scratches;
  std::set<fs::path> targets;
  for (OutputFile& file : files) {
    Scratch* const scratch = file.scratch();
    if (scratch == nullptr) continue;
    const OutputPlace& place = file.place();
    if (!targets.insert(place.path).second)
      throw InputError(file.target().string(), "is the name of two outputs", "give each its own name");
    entries.push_back({place.exists ? Step::replace : Step::create, scratch->path(), place.path});
    scratches.push_back(scratch);
  }
  std::vector<Scratch> of_removed;
  of_removed.reserve(removals_.size());
  for (const fs::path& removed : std::exchange(removals_, {})) {
    std::error_code ignored;
    if (!fs::is_symlink(removed, ignored) && !fs::is_regular_file(removed, ignored)) continue;
    if (!targets.insert(removed).second) continue;
    scratches.push_back(&of_removed.emplace_back(removed));
    entries.push_back({Step::remove, scratches.back()->path(), removed});
  }
  for (OutputFile& file : files) file.write_directly();
  if (entries.size() == 1 && entries.front().step != Step::remove) {
    move_into_place(scratches.front()->file(), entries.front().target);
  } else if (!entries.empty()) {
    Commit(std::move(entries), std::move(scratches)).run();
  }
}

void move_into_place(const fs::path& from, const fs::path& to) {
  require(rename_path(from, to), to);
  if (const int error = sync_folder(folder_of(to)); error != 0)
    throw_system_fault(to.string(), "is written, but its folder cannot be synced", error);
}

void clean_up_outputs(const fs::path& folder) {
  for (const fs::path& scratch : scratches_not_seen(folder)) {
    const DeadScratch found(scratch);
    if (found.state() != DeadScratch::State::dead) continue;
    try {
      if (scratch.extension() == Scratch::kSuffix) {
        found.remove();
      } else {
        (void)finish_set_of(scratch, found);
      }
    } catch (const InputError&) {  // who reads or writes these files learns of it
      continue;
    }
  }
}

void finish_interrupted(const fs::path& path) {
  const fs::path target = behind_links(path);
  const fs::path scratch = scratch_in_set(target);
  struct stat status {};
  if (::lstat(scratch.c_str(), &status) != 0) return;
  constexpr int kAttempts = 200;
  constexpr std::chrono::milliseconds kPause{10};
  for (int k = 0; k < kAttempts; ++k) {
    const DeadScratch dead(scratch);
    switch (dead.state()) {
      case DeadScratch::State::none:
        return;
      case DeadScratch::State::foreign:
        if (!is_of_owner(scratch, target)) return;
        throw_unfinished(path, "let its owner run meshorder on it, or remove " + scratch.string());
      case DeadScratch::State::dead:
        if (finish_set_of(scratch, dead)) return;
        break;
      case DeadScratch::State::alive:
        break;
    }
    std::this_thread::sleep_for(kPause);
  }
  throw InputError(path.string(), "is being replaced by another process", "try again when that has ended");
}

}  // namespace meshorder
