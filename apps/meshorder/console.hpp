// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "command.hpp"
#include "io/format.hpp"
#include "lab/support/quantities.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <utility>

namespace meshorder::command {

/// Where a subcommand speaks: results on stdout, as text or as one JSON object; the log on stderr.
class Console {
 public:
  explicit Console(const Common& common) : json_(common.json), quiet_(common.quiet) {}

  [[nodiscard]] bool json() const noexcept { return json_; }
  [[nodiscard]] bool quiet() const noexcept { return quiet_; }

  /// A line of the log.
  template <class... Args>
  void log(fmt::format_string<Args...> format, Args&&... args) const {
    if (!quiet_) log_line(fmt::format(format, std::forward<Args>(args)...));
  }

  /// What readers and writers noted, each on a line of the log.
  void log_notes(const Notes& notes) const;

  /// A line of the result, for people.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) const {
    if (!json_) fmt::print("{}\n", fmt::format(format, std::forward<Args>(args)...));
  }

  /// The result, for scripts.
  void print_json(const nlohmann::ordered_json& result) const {
    if (json_) fmt::print("{}\n", result.dump(2));
  }

 private:
  static void log_line(std::string_view line);

  bool json_;
  bool quiet_;
};

}  // namespace meshorder::command
