// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/scratch.hpp"

#include "io/stream/output_place.hpp"
#include "io/stream/system_fault.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <random>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kLock = "lock";
constexpr std::size_t kDigits = 16;

/// Returns how many folders are locked at a time, each of which takes a descriptor. Further ones are not
/// locked, and no other process cleans these up.
int most_locks() {
  constexpr rlim_t kMost = 128;
  struct rlimit files {};
  return static_cast<int>(::getrlimit(RLIMIT_NOFILE, &files) == 0 ? std::min(files.rlim_cur / 4, kMost)
                                                                  : kMost);
}

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): descriptors are the process's
std::atomic<int> locks_held = 0;

// ---- what a signal handler removes

/// Paths of scratch folders, each in memory of its own. Whoever takes a path out of its slot owns it.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler reaches nothing else
std::array<std::atomic<char*>, 1024> unfinished{};

/// Returns the slot of the path, −1 if none is free: such a folder waits for the next run.
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

std::string random_name() {
  std::random_device device;
  const std::uint64_t number = (std::uint64_t{device()} << 32U) | device();
  return fmt::format("{}{:0{}x}{}", Scratch::kPrefix, number, kDigits, Scratch::kSuffix);
}

bool is_scratch_name(std::string_view name) {
  return name.size() == Scratch::kPrefix.size() + kDigits + Scratch::kSuffix.size() &&
         name.starts_with(Scratch::kPrefix) &&
         (name.ends_with(Scratch::kSuffix) || name.ends_with(Scratch::kSuffixInSet));
}

/// Makes `lock` in a folder and locks it. Returns false if a run that cleans up has taken the folder away.
bool lock_new(const fs::path& folder, Descriptor& lock) {
  lock = Descriptor(folder / kLock, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
  if (!lock.is_open()) return errno != ENOENT;
  return ::flock(lock.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

/// Returns whether the folder is gone: without memory it may not be.
bool remove_all_in(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored))
    files.push_back(entry->path());
  // the lock last: until then the folder is not taken for that of a process that has just begun
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return (a.filename() == kLock) < (b.filename() == kLock);
  });
  for (const fs::path& file : files) fs::remove(file, ignored);
  return fs::remove(folder, ignored);
}

/// Removes what this program puts into a scratch folder, and the folder, by system functions alone, which a
/// signal handler may call.
void remove_known_in(const char* folder) noexcept {
  std::array<char, 4096 + 16> file{};
  const std::size_t length = std::strlen(folder);
  for (const char* const name : {"/new", "/old", "/set", "/journal.part", "/lock"}) {
    if (length + std::strlen(name) >= file.size()) continue;
    std::memcpy(file.data(), folder, length);
    std::strcpy(file.data() + length, name);
    ::unlink(file.data());
  }
  ::rmdir(folder);
}

}  // namespace

Scratch::Scratch(const fs::path& target) {
  for (int attempts = 0; attempts < 100; ++attempts) {
    path_ = folder_of(target) / random_name();
    if (::mkdir(path_.c_str(), S_IRWXU) != 0) {
      if (errno == EEXIST) continue;
      throw_system_fault(target.string(), "cannot be written", errno);
    }
    slot_ = remember(path_.string());
    if (locks_held >= most_locks()) return;
    if (lock_new(path_, lock_)) {
      if (lock_.is_open()) ++locks_held;
      return;
    }
    forget(std::exchange(slot_, -1));
    remove_all_in(path_);
  }
  throw_system_fault(target.string(), "cannot be written", EEXIST);
}

Scratch::Scratch(Scratch&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      lock_(std::move(other.lock_)),
      slot_(std::exchange(other.slot_, -1)),
      is_kept_(other.is_kept_) {}

Scratch::~Scratch() {
  if (lock_.is_open()) --locks_held;
  if (path_.empty()) return;
  if (!is_kept_ && !remove_all_in(path_)) remove_known_in(path_.c_str());
  forget(slot_);
}

void Scratch::keep() noexcept {
  is_kept_ = true;
  forget(std::exchange(slot_, -1));
}

void Scratch::remove() {
  remove_all_in(path_);
  path_.clear();
}

int Scratch::rename(const fs::path& path) {
  fs::path renamed = path;
  const int slot = remember(path.string());
  if (::rename(path_.c_str(), path.c_str()) != 0) {
    const int error = errno;
    forget(slot);
    return error;
  }
  forget(std::exchange(slot_, slot));
  path_.swap(renamed);
  return 0;
}

DeadScratch::DeadScratch(fs::path path) : path_(std::move(path)) {
  struct stat status {};
  if (::lstat(path_.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) return;
  state_ = State::foreign;
  if (status.st_uid != ::geteuid()) return;
  lock_ = Descriptor(path_ / kLock, O_RDWR | O_NOFOLLOW);
  if (!lock_.is_open()) {
    // a process has just begun, or died then; only an empty folder can be removed
    state_ = errno == ENOENT ? State::alive : State::foreign;
    (void)::rmdir(path_.c_str());
  } else if (::flock(lock_.get(), LOCK_EX | LOCK_NB) == 0) {
    state_ = State::dead;
  } else if (errno == EWOULDBLOCK) {
    state_ = State::alive;
  }
}

void DeadScratch::remove() const { remove_all_in(path_); }

std::vector<fs::path> scratches_not_seen(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  std::vector<fs::path> found;
  std::error_code code;
  {
    const std::lock_guard lock(mutex);
    const fs::path full = fs::absolute(folder, code);
    if (code || !seen.insert(full).second) return found;
  }
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    if (is_scratch_name(entry->path().filename().string())) found.push_back(entry->path());
  }
  return found;
}

void remove_unfinished_outputs() noexcept {
  for (std::atomic<char*>& slot : unfinished) {
    if (const char* const folder = slot.exchange(nullptr); folder != nullptr) remove_known_in(folder);
  }
}

}  // namespace meshorder
