// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace meshorder::command {

/// A line on the terminal, shown after two seconds, with the current stage and an estimate of the time left.
/// Writes nothing if stderr is not a terminal.
class Progress {
 public:
  /// @param enabled  false for --quiet
  explicit Progress(bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  /// Begins a stage, which is the share `from` … `to` of the whole. If the stage reports no progress of its
  /// own, its share is estimated from the pace so far.
  void stage(std::string what, double from, double to);

  /// Sets the share of the whole that is done, 0 … 1.
  void at(double share);

  /// Clears the line for good. Call it before results are printed.
  void finish();

 private:
  void draw_until_done() noexcept;
  void draw(double elapsed);

  std::mutex mutex_;
  std::condition_variable done_;
  bool finished_ = false;
  bool drawn_ = false;
  std::string what_;
  double from_ = 0;
  double to_ = 1;
  double share_ = 0;
  double stage_began_ = 0;
  double began_;
  std::thread drawer_;
};

}  // namespace meshorder::command
