// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/input_file.hpp"

#include "base/lfs_pointer.hpp"
#include "base/memory.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace meshorder {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRemedy =
    "put the file itself there, or allow its own folder with --allow-includes-from";

// O_NONBLOCK: opening does not wait for the writer of a pipe; the flag has no effect on files
constexpr int kReading = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
#ifdef O_PATH
constexpr int kPassing = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
#else
constexpr int kPassing = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
#endif

int opened_at(int folder, const char* name, int flags) {
  int result = -1;
  do result = ::openat(folder, name, flags);
  while (result < 0 && errno == EINTR);
  return result;
}

/// Opens an absolute path for reading. Returns −1 with errno for a link in the path, a device or a socket, or
/// another failure.
int opened_without_links(const fs::path& path) {
  int folder = opened_at(AT_FDCWD, "/", kPassing);
  const fs::path below = path.relative_path();
  for (auto part = below.begin(); part != below.end() && folder >= 0; ++part) {
    const bool is_last = std::next(part) == below.end();
    struct stat status {};
    int next = -1;
    // opening a device may have side effects: do not open it
    if (::fstatat(folder, part->c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0) {
      const bool may_open = is_last ? S_ISREG(status.st_mode) || S_ISFIFO(status.st_mode) : true;
      errno = S_ISLNK(status.st_mode) ? ELOOP : ENXIO;
      if (may_open) next = opened_at(folder, part->c_str(), is_last ? kReading | O_NOFOLLOW : kPassing);
    }
    const int error = errno;
    ::close(folder);
    errno = error;
    folder = next;
  }
  return folder;
}

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

/// Returns why a file of this mode cannot be read, such as "is a folder"; nullptr for a regular file or an
/// allowed pipe.
const char* kind_of_unreadable(mode_t mode, bool may_be_pipe) {
  if (S_ISDIR(mode)) return "is a folder";
  if (S_ISSOCK(mode)) return "is a socket";
  if (S_ISBLK(mode) || S_ISCHR(mode)) return "is a device";
  return S_ISREG(mode) || (S_ISFIFO(mode) && may_be_pipe) ? nullptr : "is a pipe";
}

}  // namespace

std::optional<fs::path> real_path_below(const fs::path& path, std::span<const fs::path> folders) {
  std::error_code code;
  const fs::path whole = fs::absolute(path, code);
  if (code) return std::nullopt;
  fs::path real = fs::weakly_canonical(whole, code);
  if (code) return std::nullopt;
  for (const fs::path& folder : folders) {
    const fs::path real_folder = fs::canonical(folder.empty() ? fs::path(".") : folder, code);
    if (!code && is_below(real, real_folder)) return real;
  }
  return std::nullopt;
}

InputFile::InputFile(const fs::path& path) : path_(path), may_be_pipe_(true) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) fail(errno);
  if (const char* const kind = kind_of_unreadable(status.st_mode, true); kind != nullptr)
    throw InputError(path.string(), kind, "give a file");
  descriptor_ = opened_at(AT_FDCWD, path.c_str(), kReading);
  require_readable();
}

InputFile::InputFile(const fs::path& path, std::span<const fs::path> folders) : path_(path) {
  const std::optional<fs::path> real = real_path_below(path, folders);
  if (!real) throw InputError(path.string(), "is outside the folder where it should be", kRemedy);
  struct stat status {};
  if (::lstat(real->c_str(), &status) == 0 && !S_ISLNK(status.st_mode)) {
    if (const char* const kind = kind_of_unreadable(status.st_mode, false); kind != nullptr)
      throw InputError(path.string(), kind, "give a file");
  }
  descriptor_ = opened_without_links(*real);
  require_readable();
}

InputFile::~InputFile() { close(); }

void InputFile::close() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      ahead_(other.ahead_),
      may_be_pipe_(other.may_be_pipe_) {}

void InputFile::fail(int error) const {
  if (error == ENOENT || error == ENOTDIR) throw InputError(path_.string(), "no such file", "check the path");
  if (error == EACCES || error == EPERM)
    throw InputError(path_.string(), "cannot be read", "check its permissions");
  if (error == ELOOP) throw InputError(path_.string(), "is a link that cannot be followed", kRemedy);
  throw InputError(path_.string(), "cannot be read: " + std::generic_category().message(error),
                   "check the path and the disk");
}

/// Checks the type of the opened file, because another file may have replaced the one checked before.
/// Stores the size of a regular file; waits for the writer of a pipe.
void InputFile::require_readable() {
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) fail(errno);
  const char* const kind = kind_of_unreadable(status.st_mode, may_be_pipe_);
  if (kind != nullptr) {
    close();
    throw InputError(path_.string(), kind, "give a file");
  }
  if (S_ISREG(status.st_mode)) size_ = static_cast<std::uint64_t>(status.st_size);
  if (size_ > kLfsPointer.size() && size_ <= kLongestLfsPointer) {
    std::string beginning(kLfsPointer.size(), '\0');
    if (::pread(descriptor_, beginning.data(), beginning.size(), 0) == std::ssize(beginning) &&
        beginning == kLfsPointer) {
      close();
      refuse_lfs_pointer(beginning, path_.string());
    }
  }
  if (S_ISFIFO(status.st_mode)) wait_for_writer();
}

/// Waits up to three seconds for a writer of the pipe: a byte, a hang-up or EAGAIN shows that the pipe has or
/// had a writer. Later reads block. Throws InputError if no writer comes.
void InputFile::wait_for_writer() {
  constexpr int kTurns = 300;
  constexpr int kMilliseconds = 10;
  for (int k = 0; k < kTurns; ++k) {
    char byte = 0;
    const ssize_t got = ::read(descriptor_, &byte, 1);
    pollfd of_pipe{.fd = descriptor_, .events = POLLIN, .revents = 0};
    const bool has_ended = ::poll(&of_pipe, 1, 0) > 0 && (of_pipe.revents & POLLHUP) != 0;
    if (got == 1) ahead_ = byte;
    if (got == 1 || has_ended || (got < 0 && errno == EAGAIN)) {
      ::fcntl(descriptor_, F_SETFL, ::fcntl(descriptor_, F_GETFL) & ~O_NONBLOCK);
      return;
    }
    (void)::poll(nullptr, 0, kMilliseconds);
  }
  close();
  throw InputError(path_.string(), "is a pipe that nobody writes to", "start its writer first");
}

namespace {

/// Calls `read` until `into` is full or no byte is left. Returns the number of bytes read, or −1 with errno.
template <class Read>
ssize_t transferred(std::span<char> into, const Read& read) {
  std::size_t done = 0;
  while (done < into.size()) {
    const ssize_t got = read(into.data() + done, into.size() - done, done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return static_cast<ssize_t>(done);
}

}  // namespace

std::size_t InputFile::read(std::span<char> into) {
  std::size_t begun = 0;
  if (ahead_ && !into.empty()) {
    into.front() = *std::exchange(ahead_, std::nullopt);
    begun = 1;
  }
  const ssize_t got = transferred(into.subspan(begun), [&](char* to, std::size_t size, std::size_t) {
    return ::read(descriptor_, to, size);
  });
  if (got < 0) fail(errno);
  return begun + static_cast<std::size_t>(got);
}

std::size_t InputFile::read_at(std::uint64_t at, std::span<char> into) const {
  const ssize_t got = transferred(into, [&](char* to, std::size_t size, std::size_t done) {
    return ::pread(descriptor_, to, size, static_cast<off_t>(at + done));
  });
  if (got < 0) fail(errno);
  return static_cast<std::size_t>(got);
}

std::string InputFile::text(std::size_t most) {
  std::string result(std::min<std::uint64_t>(size_, most) + 1, '\0');
  std::size_t got = 0;
  while ((got += read(std::span(result).subspan(got))) == result.size() && got <= most)
    result.resize(std::min(2 * result.size(), most + 1));
  if (got > most) throw InputError(path_.string(), "has more than " + size_text(most), "give another file");
  result.resize(got);
  return result;
}

std::string InputFile::path_for_libraries() const {
  std::string path = "/proc/self/fd/" + std::to_string(descriptor_);
  return ::access(path.c_str(), F_OK) == 0 ? path : path_.string();
}

}  // namespace meshorder
