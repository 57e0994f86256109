// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Replaces operator new. If the system has no memory, small blocks come from a reserve, and the command ends
// with a message. Without the reserve, destructors that allocate memory would terminate the command:
// nlohmann::json moves its values into a vector before it destroys them.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <new>

namespace meshorder::command {
namespace {

/// An array from which blocks are cut one by one. Its memory is used again only after all blocks are given
/// back.
class MemoryReserve {
 public:
  /// Returns a block aligned for any type, or nullptr if `size` is too large or there is no room. Blocks take
  /// at most three quarters of the array; while the stack is being unwound, destructors may use the rest.
  void* take(std::size_t size) noexcept {
    const bool unwinding = std::uncaught_exceptions() > 0;
    const std::size_t limit = unwinding ? bytes_.size() : bytes_.size() / 4 * 3;
    if (size > (unwinding ? bytes_.size() : kLargest)) return nullptr;
    constexpr std::size_t kAlignment = alignof(std::max_align_t);
    const std::size_t rounded = (std::max<std::size_t>(size, 1) + kAlignment - 1) / kAlignment * kAlignment;
    const std::lock_guard lock(mutex_);
    if (rounded > limit - std::min(limit, used_)) return nullptr;
    ++blocks_;
    used_ += rounded;
    return bytes_.data() + (used_ - rounded);
  }

  /// Takes a block back. Returns false if it is not from the reserve.
  bool give_back(void* block) noexcept {
    auto* const byte = static_cast<std::byte*>(block);
    const std::less<> before;  // compares any two addresses
    if (before(byte, bytes_.data()) || !before(byte, bytes_.data() + bytes_.size())) return false;
    const std::lock_guard lock(mutex_);
    if (--blocks_ == 0) used_ = 0;
    return true;
  }

 private:
  static constexpr std::size_t kLargest =
      1024;  // largest block, except while unwinding: a mesh's arrays are larger

  std::mutex mutex_;
  std::size_t used_ = 0;
  std::size_t blocks_ = 0;
  alignas(std::max_align_t) std::array<std::byte, std::size_t{1} << 20> bytes_{};
};

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): operator new has no other state
constinit MemoryReserve reserve;

}  // namespace
}  // namespace meshorder::command

// NOLINTBEGIN(cppcoreguidelines-no-malloc): operator new is built on malloc
void* operator new(std::size_t size) {
  if (void* const block = std::malloc(std::max<std::size_t>(size, 1))) return block;
  if (void* const block = meshorder::command::reserve.take(size)) return block;
  throw std::bad_alloc();
}

void operator delete(void* block) noexcept {
  if (!meshorder::command::reserve.give_back(block)) std::free(block);
}

void operator delete(void* block, std::size_t /*size*/) noexcept { operator delete(block); }
// NOLINTEND(cppcoreguidelines-no-malloc)
