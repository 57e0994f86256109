// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/descriptor.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace meshorder {

Descriptor::Descriptor(const std::filesystem::path& path, int flags, unsigned mode) {
  do descriptor_ = ::open(path.c_str(), flags | O_CLOEXEC, mode);
  while (descriptor_ < 0 && errno == EINTR);
}

int Descriptor::write(std::string_view bytes) const noexcept {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

int Descriptor::sync() const noexcept {
  int failed = 0;
  do failed = ::fsync(descriptor_);
  while (failed != 0 && errno == EINTR);
  if (failed == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return 0;
  return errno;
}

int Descriptor::close() noexcept {
  const int descriptor = std::exchange(descriptor_, -1);
  // the descriptor is closed even after EINTR
  return descriptor < 0 || ::close(descriptor) == 0 || errno == EINTR ? 0 : errno;
}

std::size_t descriptors_for_locks() noexcept {
  constexpr rlim_t kMost = 128;
  struct rlimit files {};
  return ::getrlimit(RLIMIT_NOFILE, &files) == 0 ? std::min(files.rlim_cur / 4, kMost) : kMost;
}

int sync_folder(const std::filesystem::path& folder) noexcept {
  const Descriptor opened(folder, O_RDONLY | O_DIRECTORY);
  // a folder that may be written but not listed cannot be opened
  if (!opened.is_open()) return errno == EACCES ? 0 : errno;
  return opened.sync();
}

}  // namespace meshorder
