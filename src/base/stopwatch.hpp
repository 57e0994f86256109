// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace meshorder {

/// Measures wall-clock time from its construction on.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace meshorder
