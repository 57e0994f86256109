// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <malloc.h>

#include <cstddef>
#include <fstream>
#include <string>

namespace meshorder {

/// A meter of the rise of the process's memory since construction. Needs Linux with glibc.
class PeakMemory {
 public:
  PeakMemory() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5;  // the peak starts anew
    before_ = status("VmRSS:");
  }

  /// Returns the peak rise in bytes.
  [[nodiscard]] std::size_t bytes() const { return status("VmHWM:") - before_; }

 private:
  static std::size_t status(const std::string& key) {
    std::ifstream file("/proc/self/status");
    for (std::string word; file >> word;) {
      std::size_t kilobytes = 0;
      if (word == key && file >> kilobytes) return kilobytes << 10;
    }
    return 0;
  }

  std::size_t before_ = 0;
};

}  // namespace meshorder
