// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/descriptor.hpp"

#include <meshorder/error.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

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

void Descriptor::begin_sync() const noexcept {
#ifdef SYNC_FILE_RANGE_WRITE
  (void)::sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE);
#endif
}

int Descriptor::try_lock() const noexcept {
  int failed = 0;
  do failed = ::flock(descriptor_, LOCK_EX | LOCK_NB);
  while (failed != 0 && errno == EINTR);
  return failed == 0 ? 0 : errno;
}

int Descriptor::close() noexcept {
  const int descriptor = std::exchange(descriptor_, -1);
  // the descriptor is closed even after EINTR
  return descriptor < 0 || ::close(descriptor) == 0 || errno == EINTR ? 0 : errno;
}

std::size_t descriptors_for_locks() noexcept {
  constexpr rlim_t kMost = 64;
  struct rlimit files {};
  return ::getrlimit(RLIMIT_NOFILE, &files) == 0 ? std::min(files.rlim_cur / 8, kMost) : kMost;
}

int sync_folder(const std::filesystem::path& folder) noexcept {
  const Descriptor opened(folder, O_RDONLY | O_DIRECTORY);
  // a folder that may be written but not listed cannot be opened
  if (!opened.is_open()) return errno == EACCES ? 0 : errno;
  return opened.sync();
}

SystemFault system_fault(int error) {
  switch (error) {
    case ENOSPC:
      return {"the disk is full", "free some space or choose another folder"};
    case EDQUOT:
      return {"the quota of the disk is used up", "free some space or choose another folder"};
    case EFBIG:
      return {"it would exceed the limit on the size of files", "raise the limit (ulimit -f)"};
    case EIO:
      return {"the device reports an input/output error", "check the disk or choose another folder"};
    case EROFS:
      return {"the file system is read-only", "choose another folder"};
    case EACCES:
    case EPERM:
      return {"permission denied", "check the permissions of the file and its folder"};
    case ENAMETOOLONG:
      return {"its name is too long", "choose a shorter name"};
    case ELOOP:
      return {"its symbolic links lead in a circle", "remove the link"};
    case EPIPE:
      return {"the reader of the pipe has gone", "keep the reader open until all is written"};
    case EMFILE:
    case ENFILE:
      return {"too many files are open", "raise the limit (ulimit -n)"};
    default:
      return {std::generic_category().message(error), "check the file and its folder"};
  }
}

void throw_system_fault(const std::string& file, const std::string& what, int error) {
  const SystemFault fault = system_fault(error);
  throw InputError(file, what + ": " + fault.reason, fault.remedy);
}

}  // namespace meshorder
