// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "console.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace meshorder::command {

void Console::log_line(std::string_view line) { fmt::print(stderr, "meshorder: {}\n", line); }

void Console::log_notes(const Notes& notes) const {
  for (const std::string& note : notes) log("{}", note);
}

void Console::print_json(const nlohmann::ordered_json& result) const {
  if (json_) fmt::print("{}\n", result.dump(2));
}

}  // namespace meshorder::command
