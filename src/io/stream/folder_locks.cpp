// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/folder_locks.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <thread>

namespace meshorder {
namespace {

using Clock = std::chrono::steady_clock;
using Identity = std::pair<dev_t, ino_t>;
constexpr std::chrono::seconds kLongestWait{10};
constexpr std::chrono::milliseconds kPause{2};

void wait_for_lock(const Descriptor& folder, Clock::time_point last) {
  while (folder.try_lock() == EWOULDBLOCK && Clock::now() <= last) std::this_thread::sleep_for(kPause);
}

/// The folders that `HeldFolder` objects mark.
struct Held {
  std::mutex mutex;
  std::set<Identity> folders;

  static Held& of_process() {
    static Held held;
    return held;
  }
};

}  // namespace

HeldFolder::HeldFolder(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) == 0) identity_ = {status.st_dev, status.st_ino};
  Held& held = Held::of_process();
  const std::lock_guard lock(held.mutex);
  held.folders.insert(identity_);
}

HeldFolder::~HeldFolder() {
  Held& held = Held::of_process();
  const std::lock_guard lock(held.mutex);
  held.folders.erase(identity_);
}

FolderLocks::FolderLocks(const std::set<std::filesystem::path>& folders) {
  std::map<Identity, std::filesystem::path> by_identity;
  for (const std::filesystem::path& folder : folders) {
    struct stat status {};
    if (::stat(folder.c_str(), &status) == 0) by_identity.try_emplace({status.st_dev, status.st_ino}, folder);
  }
  {
    Held& held = Held::of_process();
    const std::lock_guard lock(held.mutex);
    for (const Identity& identity : held.folders) by_identity.erase(identity);
  }
  const Clock::time_point last = Clock::now() + kLongestWait;
  for (const auto& [identity, folder] : by_identity) {
    if (locked_.size() >= descriptors_for_locks()) return;
    Descriptor opened(folder, O_RDONLY | O_DIRECTORY);
    if (!opened.is_open()) continue;
    wait_for_lock(opened, last);
    locked_.push_back(std::move(opened));
  }
}

}  // namespace meshorder
