// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace meshorder {

/// A file descriptor, which the destructor closes. `write`, `sync`, `try_lock` and `close` return 0 or an
/// `errno`.
class Descriptor {
 public:
  Descriptor() = default;
  /// Opens a file as `open` does, with O_CLOEXEC. On failure sets `errno`, and `is_open` is false.
  Descriptor(const std::filesystem::path& path, int flags, unsigned mode = 0);
  explicit Descriptor(int descriptor) noexcept : descriptor_(descriptor) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool is_open() const noexcept { return descriptor_ >= 0; }
  [[nodiscard]] int get() const noexcept { return descriptor_; }

  /// Writes all bytes, even if the system takes them in parts or is interrupted.
  [[nodiscard]] int write(std::string_view bytes) const noexcept;
  /// Waits until all bytes written so far are on the disk; does nothing if the file system has no `fsync`.
  [[nodiscard]] int sync() const noexcept;
  /// Makes the system begin to put the bytes written so far on the disk; does not wait. Speeds up `sync`.
  void begin_sync() const noexcept;
  /// Locks the file (`flock`) so that no other process can lock it. Does not wait: returns EWOULDBLOCK if
  /// another process holds the lock.
  [[nodiscard]] int try_lock() const noexcept;
  int close() noexcept;

 private:
  int descriptor_ = -1;
};

/// Returns how many descriptors may be held for locks of folders, and as many for locks of scratch folders:
/// an eighth of the process's limit, at most 64.
[[nodiscard]] std::size_t descriptors_for_locks() noexcept;

/// Waits until the names in a folder are on the disk. Returns 0 or an `errno`.
[[nodiscard]] int sync_folder(const std::filesystem::path& folder) noexcept;

/// The reason why a system call failed, as a clause, and a remedy.
struct SystemFault {
  std::string reason;
  std::string remedy;
};

/// Returns reason and remedy for the `errno` of a call that writes or replaces a file.
SystemFault system_fault(int error);

/// Throws InputError "FILE: WHAT: REASON; REMEDY" for an `errno`.
[[noreturn]] void throw_system_fault(const std::string& file, const std::string& what, int error);

}  // namespace meshorder
