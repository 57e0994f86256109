// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::command {

/// Makes signals that end the process remove unfinished outputs first: SIGINT, SIGTERM, SIGHUP and SIGXFSZ
/// with a line on stderr, SIGPIPE silently. Ignored signals stay ignored.
void clean_up_at_signals();

/// Does the same as `clean_up_at_signals`, but prints nothing: the launcher of several processes reports why
/// it ends them. Ignores SIGXFSZ: writing beyond the limit on file sizes then fails.
void clean_up_quietly_at_signals();

/// While alive, the first Ctrl-C (SIGINT) or SIGTERM sets a flag. A second signal of the same kind has the
/// effect that it had before the object was made. Only one object may exist at a time.
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
