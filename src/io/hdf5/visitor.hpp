// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdf5/library.hpp"

#include <exception>
#include <functional>
#include <utility>

namespace meshorder::hdf5 {

/// Calls `work` for each entry that an iteration of libhdf5 visits. Exceptions must not pass through the
/// library: an exception ends the iteration, and `rethrow` throws it again. `Info` is the library's
/// description of an entry: H5A_info_t, H5L_info_t or H5O_info_t.
template <class Info>
class Visitor {
 public:
  using Work = std::function<void(hid_t place, const char* name, const Info& info)>;

  explicit Visitor(Work work) : work_(std::move(work)) {}

  /// The callback for the library; `visitor` is the Visitor.
  static herr_t visit(hid_t place, const char* name, const Info* info, void* visitor) noexcept {
    auto& self = *static_cast<Visitor*>(visitor);
    try {
      self.work_(place, name, *info);
      return 0;
    } catch (...) {
      self.thrown_ = std::current_exception();
      return -1;
    }
  }

  /// Throws the exception of `work`, if there was one. Call it after the iteration.
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  Work work_;
  std::exception_ptr thrown_;
};

}  // namespace meshorder::hdf5
