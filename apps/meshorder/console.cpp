// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "console.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace meshorder::command {

void Console::log_line(std::string_view line) {
  static const auto logger = [] {
    auto made = spdlog::stderr_color_mt("meshorder");
    made->set_pattern("%n: %v");
    return made;
  }();
  logger->info(line);
}

void Console::log_notes(const Notes& notes) const {
  for (const std::string& note : notes) log("{}", note);
}

}  // namespace meshorder::command
