// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdf5/session.hpp"

#include <utility>

namespace meshorder::hdf5 {

/// A handle of libhdf5; the destructor closes it. A negative id means no handle, for example after a failed
/// call.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  Handle(hid_t id, Close closing) : id_(id), close_(closing) {}
  ~Handle() { (void)close(); }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  [[nodiscard]] hid_t id() const noexcept { return id_; }
  [[nodiscard]] bool is_open() const noexcept { return id_ >= 0; }

  /// Closes the handle now. Returns a negative number if that fails; closing is not tried again.
  [[nodiscard]] herr_t close() {
    if (id_ < 0) return 0;
    const Session session;
    return close_(std::exchange(id_, -1));
  }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

}  // namespace meshorder::hdf5
