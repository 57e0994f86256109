// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "progress.hpp"

#include "base/text.hpp"
#include "console.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <system_error>

namespace meshorder::command {
namespace {

constexpr double kSilentSeconds = 2.0;
constexpr std::chrono::milliseconds kRedraw{200};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Progress::Progress(bool enabled) : began_(now()) {
  if (!enabled || ::isatty(STDERR_FILENO) != 1) return;
  try {
    drawer_ = std::thread([this] { draw_until_done(); });
  } catch (const std::system_error&) {
    // no thread can be started: the work continues without a progress line
  }
}

Progress::~Progress() { finish(); }

void Progress::finish() {
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  done_.notify_all();
  if (drawer_.joinable()) drawer_.join();
}

void Progress::stage(std::string what, double from, double to) {
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
  from_ = share_ = from;
  to_ = to;
  stage_began_ = now() - began_;
}

void Progress::at(double share) {
  const std::lock_guard lock(mutex_);
  share_ = std::max(share_, share);
}

void Progress::draw_until_done() noexcept {
  std::unique_lock lock(mutex_);
  while (!done_.wait_for(lock, kRedraw, [this] { return finished_; })) {
    const double elapsed = now() - began_;
    if (elapsed <= kSilentSeconds) continue;
    try {
      draw(elapsed);
    } catch (const std::bad_alloc&) {
      // without memory for new text, the line stays as it is
    }
  }
  if (drawn_) write_stderr("\r\x1b[K");
}

void Progress::draw(double elapsed) {
  double share = share_;
  if (share <= from_ && from_ > 0 && stage_began_ > 0) {
    // the pace so far gives the expected time of this stage; the estimated share approaches the end of the
    // stage, but does not reach it
    const double expected = stage_began_ / from_ * (to_ - from_);
    share = from_ + (to_ - from_) * (1 - std::exp(-(elapsed - stage_began_) / std::max(expected, 1e-3)));
  }
  std::string line = visible(what_);
  if (share > 0.01) {
    line += fmt::format(", {:.0f} %, about {} left", 100 * share,
                        duration(std::max(1.0, elapsed / share * (1 - share))));
  } else {
    line += fmt::format(", {} so far", duration(elapsed));
  }
  write_stderr(fmt::format("\r{}\x1b[K", line));
  drawn_ = true;
}

}  // namespace meshorder::command
