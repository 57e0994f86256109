// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdf5/library.hpp"

#include <exception>
#include <functional>
#include <utility>

namespace meshorder::hdf5 {

/// Work for each entry that an iteration of libhdf5 comes to. The library knows no exceptions: what the work
/// throws ends the iteration and is thrown by `rethrow`. `Info` is what the library says of an entry:
/// H5A_info_t, H5L_info_t or H5O_info_t.
template <class Info>
class Visitor {
 public:
  using Work = std::function<void(hid_t place, const char* name, const Info& info)>;

  explicit Visitor(Work work) : work_(std::move(work)) {}

  /// To be given to the library, with the visitor as its data.
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

  /// Throws what the work has thrown. To be called after the iteration.
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  Work work_;
  std::exception_ptr thrown_;
};

}  // namespace meshorder::hdf5
