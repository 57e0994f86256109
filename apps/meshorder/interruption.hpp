// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::command {

/// Has signals that end the process remove unfinished outputs before: SIGINT, SIGTERM, SIGHUP and SIGXFSZ
/// with a line on stderr, SIGPIPE silently. Those that are ignored stay so.
void clean_up_at_signals();

/// The same without lines, for one of several processes, whose launcher says why it ends them. A file that
/// exceeds the limit on the size of files ends none: writing it fails.
void clean_up_quietly_at_signals();

/// While alive, the first Ctrl-C (SIGINT) or SIGTERM sets a flag; a second one does what it did before. Only
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
