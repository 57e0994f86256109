// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/scratch.hpp"

#include "io/stream/descriptor.hpp"
#include "io/stream/output_place.hpp"
#include <meshorder/error.hpp>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkdtemp is POSIX's
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <random>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

constexpr const char* kLock = "lock";
constexpr std::size_t kDigits = 16;

/// Number of locked scratch folders. Folders beyond `descriptors_for_locks` are not locked; other processes
/// remove these only if empty.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): descriptors are the process's
std::atomic<std::size_t> locks_held = 0;

// ---- folders that a signal handler removes

/// Paths of scratch folders, allocated one by one. A function that takes a path out of its slot owns the
/// path.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler reaches nothing else
std::array<std::atomic<char*>, 1024> unfinished{};

/// Stores a path and returns its slot. Returns −1 if no slot is free; a later run of the program then removes
/// the folder.
int remember(const std::string& path) {
  auto* const text = new char[path.size() + 1];
  std::memcpy(text, path.c_str(), path.size() + 1);
  for (std::size_t k = 0; k < unfinished.size(); ++k) {
    char* none = nullptr;
    if (unfinished[k].load() == nullptr && unfinished[k].compare_exchange_strong(none, text))
      return static_cast<int>(k);
  }
  delete[] text;
  return -1;
}

void forget(int slot) noexcept {
  if (slot >= 0) delete[] unfinished[static_cast<std::size_t>(slot)].exchange(nullptr);
}

// ---- folders

/// Maps a folder of outputs to the parent of its scratch folders, if `keep_scratches_in` set one.
std::map<fs::path, fs::path>& other_places() {
  static std::map<fs::path, fs::path> places;
  return places;
}

constexpr std::string_view kPrefix = ".meshorder-";
constexpr std::string_view kSuffix = ".new";

std::string random_name() {
  std::random_device device;
  const std::uint64_t number = (std::uint64_t{device()} << 32U) | device();
  return fmt::format("{}{:0{}x}{}", kPrefix, number, kDigits, kSuffix);
}

bool is_scratch_name(std::string_view name) {
  if (name.size() != kPrefix.size() + kDigits + kSuffix.size()) return false;
  return name.starts_with(kPrefix) && name.ends_with(kSuffix) &&
         name.substr(kPrefix.size(), kDigits).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Makes the file `lock` in a folder and locks it. Returns false if another process is removing the folder.
bool lock_new(const fs::path& folder, Descriptor& lock) {
  lock = Descriptor(folder / kLock, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
  if (!lock.is_open()) return errno != ENOENT;
  if (lock.try_lock() == EWOULDBLOCK) return false;
  struct stat status {};
  return ::fstat(lock.get(), &status) != 0 || status.st_nlink > 0;
}

/// Removes the files that this program puts into a scratch folder; safe in a signal handler. Removes the lock
/// last: a folder without a lock looks like the folder of a process that has just begun.
void remove_files_of(const Descriptor& folder) noexcept {
  for (const char* const name : {"new", "old", "lock"}) ::unlinkat(folder.get(), name, 0);
}

Descriptor opened_folder(const Descriptor& parent, const char* name) noexcept {
  return Descriptor(::openat(parent.get(), name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

std::vector<std::string> scratches_in(const Descriptor& folder) {
  std::vector<std::string> names;
  // opened again: a descriptor remembers how far its folder was read
  const int again = ::openat(folder.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const std::unique_ptr<DIR, int (*)(DIR*)> list(again < 0 ? nullptr : ::fdopendir(again), ::closedir);
  if (!list) return names;
  while (const dirent* const entry = ::readdir(list.get())) {
    if (is_scratch_name(entry->d_name)) names.emplace_back(entry->d_name);
  }
  return names;
}

/// Removes a scratch folder if it belongs to this user and the process that made it is dead. Also removes the
/// scratch folders of dead processes in it.
void remove_if_dead(const Descriptor& parent, const std::string& name, bool is_inner = false) {
  const Descriptor folder = opened_folder(parent, name.c_str());
  struct stat status {};
  if (!folder.is_open() || ::fstat(folder.get(), &status) != 0 || status.st_uid != ::geteuid()) return;
  const Descriptor lock(::openat(folder.get(), kLock, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (lock.is_open()) {
    if (lock.try_lock() != 0) return;
    for (const std::string& inner : is_inner ? std::vector<std::string>() : scratches_in(folder))
      remove_if_dead(folder, inner, true);
    remove_files_of(folder);
  } else if (errno != ENOENT) {
    return;
  }
  // a folder without a lock belongs to a process that has just begun, or that died at that moment; the folder
  // is removed only if it is empty
  ::unlinkat(parent.get(), name.c_str(), AT_REMOVEDIR);
}

/// Removes a scratch folder of this process; safe in a signal handler. Returns whether the folder was
/// removed.
bool remove_own(const char* path) noexcept {
  remove_files_of(Descriptor(::open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)));
  return ::rmdir(path) == 0;
}

/// Removes the files that dead processes left in a scratch folder of this process, and then the folder. The
/// folder stays if there is no memory.
void remove_inner(const fs::path& path) noexcept {
  try {
    const Descriptor folder(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW);
    for (const std::string& inner : scratches_in(folder)) remove_if_dead(folder, inner, true);
    remove_files_of(folder);
    ::rmdir(path.c_str());
  } catch (const std::bad_alloc&) {
    return;
  }
}

}  // namespace

void keep_scratches_in(const fs::path& place, const fs::path& folder) { other_places()[folder] = place; }

fs::path place_of_scratches(const fs::path& folder) {
  const auto other = other_places().find(folder);
  return other != other_places().end() ? other->second : folder;
}

Scratch::Scratch(const fs::path& target) {
  for (int attempts = 0; attempts < 100; ++attempts) {
    path_ = place_of_scratches(folder_of(target)) / random_name();
    if (::mkdir(path_.c_str(), S_IRWXU) != 0) {
      if (errno == EEXIST) continue;
      throw_system_fault(target.string(), "cannot be written", errno);
    }
    slot_ = remember(path_.string());
    if (locks_held >= descriptors_for_locks()) return;
    if (lock_new(path_, lock_)) {
      if (lock_.is_open()) ++locks_held;
      return;
    }
    forget(std::exchange(slot_, -1));
    remove_own(path_.c_str());
  }
  throw_system_fault(target.string(), "cannot be written", EEXIST);
}

Scratch::Scratch(Scratch&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      lock_(std::move(other.lock_)),
      slot_(std::exchange(other.slot_, -1)) {}

Scratch::~Scratch() {
  if (lock_.is_open()) --locks_held;
  if (path_.empty()) return;
  if (!remove_own(path_.c_str())) remove_inner(path_);
  forget(slot_);
}

void remove_dead_scratches(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  std::error_code code;
  {
    const std::lock_guard lock(mutex);
    const fs::path full = fs::absolute(folder, code);
    if (code || !seen.insert(full).second) return;
  }
  const Descriptor opened(folder, O_RDONLY | O_DIRECTORY);
  if (!opened.is_open()) return;
  for (const std::string& name : scratches_in(opened)) remove_if_dead(opened, name);
}

void remove_unfinished_outputs() noexcept {
  for (std::atomic<char*>& slot : unfinished) {
    if (const char* const folder = slot.exchange(nullptr); folder != nullptr) remove_own(folder);
  }
}

PrivateFolder::PrivateFolder() {
  std::error_code code;
  const fs::path parent = fs::temp_directory_path(code);
  if (code) {
    const char* const given = std::getenv("TMPDIR");
    throw InputError(given == nullptr ? "/tmp" : given, "there is no such folder for temporary files",
                     "set TMPDIR to a folder that exists");
  }
  std::string name = (fs::absolute(parent) / "meshorder-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw_system_fault(name, "the folder for temporary files cannot be made", errno);
  }
  path_ = name;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace meshorder
