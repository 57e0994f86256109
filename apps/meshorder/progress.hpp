// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace meshorder::command {

/// A line on the terminal that says what is being done and about how long it will take, from two seconds on.
/// Writes nothing where stderr is no terminal.
class Progress {
 public:
  /// `enabled` is false for --quiet.
  explicit Progress(bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  /// From now on `what` is done, the share `from` … `to` of the whole. Within a stage that reports nothing
  /// further the share is guessed from the pace so far.
  void stage(std::string what, double from, double to);

  /// The share of the whole that is done, 0 … 1, for stages that know it.
  void at(double share);

  /// Clears the line, before results are printed; nothing is drawn from then on.
  void finish();

 private:
  void draw_until_done();
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
