// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "command.hpp"
#include "io/format.hpp"
#include "payoff/quantities.hpp"
#include "standard_streams.hpp"

#include <fmt/core.h>
#include <nlohmann/json_fwd.hpp>

#include <string>
#include <utility>

namespace meshorder::command {

/// Output of a subcommand: results on stdout, as text or as one JSON object; warnings on stderr. Characters
/// that a terminal would act on are shown as escapes (see `visible`).
class Console {
 public:
  explicit Console(const Common& common) : json_(common.json), quiet_(common.quiet) {}

  [[nodiscard]] bool json() const noexcept { return json_; }
  [[nodiscard]] bool quiet() const noexcept { return quiet_; }

  /// Prints "meshorder: warning: …" on stderr unless quiet, and keeps the sentence for the JSON object.
  void warn(const std::string& sentence);

  /// Warns of the notes of readers and writers; notes that differ only in one name become one warning.
  void warn_of(const Notes& notes);

  /// Prints a line of the result as text, unless JSON is wanted or the console is quiet.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) const {
    if (!quiet_) print_list(format, std::forward<Args>(args)...);
  }

  /// Prints a line of a list, also with --quiet: some subcommands print nothing else. Prints nothing with
  /// --json.
  template <class... Args>
  void print_list(fmt::format_string<Args...> format, Args&&... args) const {
    if (!json_) write_stdout(visible(fmt::format(format, std::forward<Args>(args)...), "\n") + "\n");
  }

  /// Prints the result as JSON if that is wanted, with the keys `version` and `notes`. Bytes that are not
  /// UTF-8 become U+FFFD.
  void print_json(nlohmann::ordered_json result) const;

 private:
  bool json_;
  bool quiet_;
  Notes notes_;
};

}  // namespace meshorder::command
