// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::command {

/// While it lives, the first Ctrl-C (SIGINT) or SIGTERM only takes note, so that the work can end in good
/// order; a second one ends the process as usual. One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption(Interruption&&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  Interruption& operator=(Interruption&&) = delete;

  /// The signal that came, or 0.
  [[nodiscard]] static int signal() noexcept;
};

}  // namespace meshorder::command
