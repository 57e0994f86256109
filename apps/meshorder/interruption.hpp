// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::command {

/// While alive, the first Ctrl-C (SIGINT) or SIGTERM sets a flag; a second one terminates the process. Only
/// one object at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption(Interruption&&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  Interruption& operator=(Interruption&&) = delete;

  /// Returns the signal that was received, or 0.
  [[nodiscard]] static int signal() noexcept;
};

}  // namespace meshorder::command
