// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "console.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cmath>

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

std::string with_commas(long long number) {
  std::string digits = std::to_string(number);
  const std::size_t first = number < 0 ? 1 : 0;
  for (std::size_t place = digits.size(); place > first + 3; place -= 3) digits.insert(place - 3, ",");
  return digits;
}

std::string duration(double seconds) {
  if (seconds < 1) return fmt::format("{:.3g} ms", seconds * 1e3);
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const auto whole = std::llround(seconds);
  return fmt::format("{} min {} s", whole / 60, whole % 60);
}

}  // namespace meshorder::command
