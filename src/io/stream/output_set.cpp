// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_set.hpp"

#include "io/stream/descriptor.hpp"
#include "io/stream/folder_locks.hpp"
#include "io/stream/output_place.hpp"
#include "io/stream/scratch.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

constexpr const char* kCannotReplace = "cannot be replaced";

bool is_there(const fs::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

int renamed(const fs::path& from, const fs::path& to) {
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

/// The replacement of one target by a new file, or the removal of one target.
class Move {
 public:
  /// @param fresh  the new file; empty: the target is removed
  /// @param old    place of the old file until the move is complete
  Move(fs::path fresh, fs::path target, fs::path old)
      : fresh_(std::move(fresh)), target_(std::move(target)), old_(std::move(old)) {}

  /// Returns 0 or an `errno`.
  [[nodiscard]] int apply() {
    existed_ = is_there(target_);
    if (fresh_.empty()) return existed_ ? renamed(target_, old_) : 0;
    // if the file system has no hard links, the old file cannot be put back
    if (existed_) std::ignore = ::link(target_.c_str(), old_.c_str());
    return renamed(fresh_, target_);
  }

  /// Puts the old file back or removes the new one, also if `apply` failed. Returns 0 or an `errno`.
  [[nodiscard]] int take_back() const {
    if (existed_ && is_there(old_)) return renamed(old_, target_);
    if (fresh_.empty() || is_there(fresh_)) return 0;  // nothing was done
    if (existed_) return ENOTSUP;
    return ::unlink(target_.c_str()) == 0 ? 0 : errno;
  }

  [[nodiscard]] const fs::path& target() const noexcept { return target_; }

 private:
  fs::path fresh_;
  fs::path target_;
  fs::path old_;
  bool existed_ = false;
};

/// Returns the function that asks another process to put files in place; empty if there is none.
PutInPlace& other_process() {
  static PutInPlace ask;
  return ask;
}

bool is_beside_target(const FinishedFile& file) {
  return folder_of(output_place(file.target).path) == file.scratch.parent_path();
}

/// Gives a new file the attributes of the old one, then syncs the new file.
void complete(const FinishedFile& file, const OutputPlace& place) {
  if (place.is_through || folder_of(place.path) != file.scratch.parent_path())
    throw InputError(file.target.string(), "was replaced by something else meanwhile",
                     "run the command again");
  Descriptor opened(file.scratch / Scratch::kNew, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
  int error = opened.is_open() ? 0 : errno;
  if (error == 0 && place.exists) error = copy_attributes(place.path, opened);
  if (error == 0) error = opened.sync();
  if (const int closing = opened.close(); error == 0) error = closing;
  if (error != 0) throw_system_fault(file.target.string(), "cannot be written to the end", error);
}

/// Applies all moves. If a move or a folder's sync fails, puts the old files back and throws InputError.
void apply_all(std::vector<Move>& moves) {
  std::set<fs::path> folders;
  for (const Move& move : moves) folders.insert(folder_of(move.target()));
  const FolderLocks locked(folders);
  std::vector<bool> is_back(moves.size(), true);  // allocated before any move: undoing needs no memory
  int error = 0;
  std::size_t begun = 0;
  while (error == 0 && begun < moves.size()) error = moves[begun++].apply();
  const std::size_t failed = begun - 1;
  for (const fs::path& folder : folders) {
    if (error == 0) error = sync_folder(folder);
  }
  if (error == 0) return;
  while (begun-- > 0) is_back[begun] = moves[begun].take_back() == 0;
  std::string fresh;
  for (std::size_t k = 0; k < is_back.size(); ++k) {
    if (!is_back[k]) fresh += (fresh.empty() ? "" : ", ") + moves[k].target().string();
  }
  const SystemFault fault = system_fault(error);
  const std::string rest = fresh.empty() ? "" : "; the old contents of " + fresh + " could not be restored";
  throw InputError(moves[failed].target().string(),
                   fmt::format("{}: {}{}", kCannotReplace, fault.reason, rest), fault.remedy);
}

}  // namespace

void OutputSet::add(OutputFile&& file) {
  file.close();
  files_.push_back(std::move(file));
}

std::vector<std::string> OutputSet::files() const {
  std::vector<std::string> paths;
  for (const OutputFile& file : files_) paths.push_back(file.target().string());
  return paths;
}

void OutputSet::commit() {
  std::vector<OutputFile> files = std::exchange(files_, {});
  std::vector<FinishedFile> finished;
  for (OutputFile& file : files) {
    if (file.scratch() != nullptr) finished.push_back({file.scratch()->path(), file.target_});
  }
  for (OutputFile& file : files) file.write_directly();
  std::vector<std::string> notes =
      put_in_place(finished, std::exchange(removals_first_, {}), std::exchange(removals_, {}));
  notes_.insert(notes_.end(), std::make_move_iterator(notes.begin()), std::make_move_iterator(notes.end()));
}

void put_in_place_by(PutInPlace other) { other_process() = std::move(other); }

std::vector<std::string> put_in_place(std::span<const FinishedFile> files,
                                      std::span<const FilePath> removed_first,
                                      std::span<const FilePath> removed) {
  if (other_process() && !files.empty() && !is_beside_target(files.front()))
    return other_process()(files, removed_first, removed);
  std::vector<std::string> notes;
  std::set<fs::path> targets;
  std::vector<Move> fresh;
  for (const FinishedFile& file : files) {
    const OutputPlace place = output_place(file.target);
    complete(file, place);
    if (!targets.insert(place.path).second)
      throw InputError(file.target.string(), "is the name of two outputs", "give each its own name");
    if (place.other_names > 0) {
      notes.push_back(fmt::format("{} has {} further name{} (hard links), which keep{} the old content",
                                  file.target.string(), place.other_names, place.other_names == 1 ? "" : "s",
                                  place.other_names == 1 ? "s" : ""));
    }
    fresh.emplace_back(file.scratch / Scratch::kNew, place.path, file.scratch / Scratch::kOld);
  }
  std::vector<Scratch> scratches;  // scratch folders of the removed files
  std::vector<Move> moves;
  const auto take_away = [&](const FilePath& file) {
    if (!is_there(file.path())) return;
    const OutputPlace place = output_place(file);
    scratches.emplace_back(place.path);
    moves.emplace_back(fs::path(), place.path, scratches.back().file(Scratch::kOld));
  };
  for (const FilePath& file : removed_first) take_away(file);
  moves.insert(moves.end(), std::make_move_iterator(fresh.begin()), std::make_move_iterator(fresh.end()));
  for (const FilePath& file : removed) {
    if (!targets.contains(file.path())) take_away(file);
  }
  if (!moves.empty()) apply_all(moves);
  return notes;
}

}  // namespace meshorder
