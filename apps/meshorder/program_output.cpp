// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "program_output.hpp"

#include "base/text.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace {

constexpr std::size_t kLongestLine = 10'000;
constexpr std::string_view kSeparators = " \t\r\n,;";

bool agree(double a, double b, double tolerance) {
  return a == b || (std::isnan(a) && std::isnan(b)) ||
         std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b));
}

std::regex compiled(const std::string& option, const std::string& pattern) {
  try {
    return std::regex(pattern, std::regex::ECMAScript);
  } catch (const std::regex_error& error) {
    throw InvalidArgument(
        fmt::format("{} {}: it is no regular expression: {}", option, pattern, error.what()));
  }
}

}  // namespace

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  std::string in_c(text);
  for (char& c : in_c) {
    if (c == 'd' || c == 'D') c = 'e';
  }
  double number = 0;
  const auto [end, error] = std::from_chars(in_c.data(), in_c.data() + in_c.size(), number);
  if (error != std::errc() || end != in_c.data() + in_c.size()) return std::nullopt;
  return number;
}

PrintedNumbers::PrintedNumbers(std::string option, std::string pattern)
    : option_(std::move(option)), pattern_(std::move(pattern)), expression_(compiled(option_, pattern_)) {
  if (expression_.mark_count() > 1)
    throw InvalidArgument(fmt::format(
        "{} {}: it has several groups; one captures the number, write others as (?:…)", option_, pattern_));
}

std::vector<double> PrintedNumbers::find(const std::vector<std::filesystem::path>& files) const {
  std::vector<double> numbers;
  for (const std::filesystem::path& file : files) {
    const InputFile opened(file);
    const std::string text = opened.size() > 0 ? FilePath(file).read() : std::string();
    std::string_view rest = text;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      const std::string line(rest.substr(0, std::min(end, kLongestLine)));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      for (std::sregex_iterator match(line.begin(), line.end(), expression_), last; match != last; ++match) {
        const std::string captured = (*match)[expression_.mark_count()].str();
        const std::optional<double> number = number_of(trimmed(captured));
        if (!number)
          throw InvalidArgument(
              fmt::format("{} {}: it captures '{}', which is no number", option_, pattern_, captured));
        numbers.push_back(*number);
      }
    }
  }
  if (numbers.empty())
    throw InvalidArgument(fmt::format("{} {}: no line that the program printed matches", option_, pattern_));
  return numbers;
}

std::string difference(const std::vector<double>& expected, const std::vector<double>& found,
                       double tolerance) {
  if (expected.size() != found.size())
    return fmt::format("{} numbers instead of {}", found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!agree(expected[i], found[i], tolerance))
      return fmt::format("{} instead of {}", found[i], expected[i]);
  }
  return {};
}

std::string difference(std::string_view expected, std::string_view found, double tolerance) {
  for (;;) {
    const std::string_view a = next_word(expected, kSeparators);
    const std::string_view b = next_word(found, kSeparators);
    if (a.empty() && b.empty()) return {};
    const std::optional<double> x = number_of(a);
    const std::optional<double> y = number_of(b);
    if (x && y ? agree(*x, *y, tolerance) : a == b) continue;
    return fmt::format("'{}' instead of '{}'", utf8_prefix(b, 40), utf8_prefix(a, 40));
  }
}

}  // namespace meshorder::command
