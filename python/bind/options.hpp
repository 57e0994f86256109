// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "arrays.hpp"
#include <meshorder/options.hpp>

#include <vector>

namespace meshorder::python {

/// Options as Python gives them: a dict with the names of `OrderOptions` and `Run`; what is not there has its
/// default. Keeps the arrays that the options view.
class Options {
 public:
  explicit Options(const nb::dict& given);
  [[nodiscard]] const OrderOptions& order() const { return order_; }
  [[nodiscard]] const Run& run() const { return order_.run; }

 private:
  OrderOptions order_;
  std::vector<Array> arrays_;
};

/// Calls `work()` without Python's lock and returns its result. Other Python threads go on meanwhile.
template <class Work>
auto unlocked(const Work& work) {
  const nb::gil_scoped_release release;
  return work();
}

}  // namespace meshorder::python
