// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "command.hpp"
#include "io/format.hpp"
#include "payoff/quantities.hpp"

#include <fmt/core.h>
#include <nlohmann/json_fwd.hpp>

#include <string_view>
#include <utility>

namespace meshorder::command {

/// Output of a subcommand: results on stdout, as text or as one JSON object; notes on stderr.
class Console {
 public:
  explicit Console(const Common& common) : json_(common.json), quiet_(common.quiet) {}

  [[nodiscard]] bool json() const noexcept { return json_; }
  [[nodiscard]] bool quiet() const noexcept { return quiet_; }

  /// Prints a line on stderr, unless quiet.
  template <class... Args>
  void log(fmt::format_string<Args...> format, Args&&... args) const {
    if (!quiet_) log_line(fmt::format(format, std::forward<Args>(args)...));
  }

  /// Prints the notes of readers and writers on stderr, a line each, unless quiet.
  void log_notes(const Notes& notes) const;

  /// Prints a line of the result as text, unless JSON is wanted.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) const {
    if (!json_) fmt::print("{}\n", fmt::format(format, std::forward<Args>(args)...));
  }

  /// Prints the result as JSON if that is wanted.
  void print_json(const nlohmann::ordered_json& result) const;

 private:
  static void log_line(std::string_view line);

  bool json_;
  bool quiet_;
};

}  // namespace meshorder::command
