// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "program_output.hpp"

#include "base/input_file.hpp"
#include "base/text.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace {

constexpr std::size_t kLongestLine = 10'000;
constexpr std::string_view kSeparators = " \t\r\n,;";

/// Calls `use` with each line of a text, cut after `kLongestLine` characters.
template <class Use>
void for_each_line(std::string_view text, Use use) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    use(text.substr(0, std::min(end, kLongestLine)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// Returns the end of a file: at most `most` bytes.
std::string end_of(const std::filesystem::path& file, std::uint64_t most) {
  const InputFile opened(file);
  std::string tail(std::min(most, opened.size()), '\0');
  tail.resize(opened.read_at(opened.size() - tail.size(), tail));
  return tail;
}

/// Returns whether a line reports an error: it begins with the word "error", after blanks and marks such as
/// "*" or "[". Results do not count: "error = 1e-9", "error condition (0=good, 1=bad) = 0".
bool begins_with_error(std::string_view line) {
  constexpr std::string_view kMarks = " \t*-#[";
  constexpr std::string_view kError = "error";
  line = line.substr(0, line.find('\r'));
  line.remove_prefix(std::min(line.find_first_not_of(kMarks), line.size()));
  if (!same_but_for_case(line.substr(0, kError.size()), kError)) return false;
  line.remove_prefix(kError.size());
  const unsigned char next = line.empty() ? ' ' : static_cast<unsigned char>(line.front());
  if (next == '_' || std::isalnum(next) != 0) return false;
  return !number_of(trimmed(line.substr(line.find_last_of("=:") + 1)));
}

/// The allowed difference of two numbers of an output: the larger of two limits.
struct Closeness {
  double tolerance = 0;  ///< relative to the larger number
  double floor = 0;      ///< absolute, for sums that would be zero without rounding

  [[nodiscard]] bool agree(double a, double b) const {
    return a == b || (std::isnan(a) && std::isnan(b)) ||
           std::abs(a - b) <= std::max(tolerance * std::max(std::abs(a), std::abs(b)), floor);
  }
};

/// Returns the allowed difference for an output whose largest number is `largest`.
Closeness closeness(double tolerance, double largest) {
  constexpr double kRounding = 1e-12;
  return {.tolerance = tolerance, .floor = kRounding * largest};
}

/// Returns the larger of `largest` and the magnitude of a number; `largest` if the number is not finite.
double larger(double largest, double number) {
  return std::isfinite(number) ? std::max(largest, std::abs(number)) : largest;
}

std::regex compiled(const std::string& option, const std::string& pattern) {
  try {
    return std::regex(pattern, std::regex::ECMAScript);
  } catch (const std::regex_error& error) {
    throw InvalidArgument(
        fmt::format("{} {}: it is not a regular expression: {}", option, pattern, error.what()));
  }
}

/// Returns a line as messages show it: without blanks at its ends, cut to 300 bytes.
std::string shown_line(std::string_view line) {
  constexpr std::size_t kMost = 300;
  if (line.ends_with('\r')) line.remove_suffix(1);
  return std::string(utf8_prefix(trimmed(line), kMost));
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
        "{} {}: it has several groups; keep the one that captures the number, and write the others as (?:…)",
        option_, pattern_));
}

std::vector<double> PrintedNumbers::find(const std::vector<std::filesystem::path>& files) const {
  std::vector<double> numbers;
  const auto find_in = [&](std::string_view line) {
    const char* const end = line.data() + line.size();
    for (std::cregex_iterator match(line.data(), end, expression_), last; match != last; ++match) {
      const std::string captured = (*match)[expression_.mark_count()].str();
      const std::optional<double> number = number_of(trimmed(captured));
      if (!number)
        throw InvalidArgument(
            fmt::format("{} {}: it captures '{}', which is not a number", option_, pattern_, captured));
      numbers.push_back(*number);
    }
  };
  for (const std::filesystem::path& file : files) {
    if (InputFile(file).size() > 0) for_each_line(FilePath(file).read(), find_in);
  }
  if (numbers.empty())
    throw InvalidArgument(fmt::format("{} {}: no line of the program's output matches", option_, pattern_));
  return numbers;
}

std::string difference(const std::vector<double>& expected, const std::vector<double>& found,
                       double tolerance) {
  if (expected.size() != found.size())
    return fmt::format("{} numbers instead of {}", found.size(), expected.size());
  const Closeness allowed =
      closeness(tolerance, std::accumulate(expected.begin(), expected.end(), 0.0, larger));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!allowed.agree(expected[i], found[i])) return fmt::format("{} instead of {}", found[i], expected[i]);
  }
  return {};
}

std::string difference(std::string_view expected, std::string_view found, double tolerance) {
  double largest = 0;
  for (std::string_view rest = expected, word; !(word = next_word(rest, kSeparators)).empty();)
    largest = larger(largest, number_of(word).value_or(0));
  const Closeness allowed = closeness(tolerance, largest);
  for (;;) {
    const std::string_view a = next_word(expected, kSeparators);
    const std::string_view b = next_word(found, kSeparators);
    if (a.empty() && b.empty()) return {};
    const std::optional<double> x = number_of(a);
    const std::optional<double> y = number_of(b);
    if (x && y ? allowed.agree(*x, *y) : a == b) continue;
    return fmt::format("'{}' instead of '{}'", utf8_prefix(b, 40), utf8_prefix(a, 40));
  }
}

std::vector<std::filesystem::path> printed_files(const std::filesystem::path& log) {
  return {log.string() + ".out", log.string() + ".err"};
}

std::string error_line(const std::filesystem::path& log) {
  constexpr std::uint64_t kLooksAt = std::uint64_t{1}
                                     << 24;  // bytes at the end of each file; a program may print far more
  std::string result;
  for (const std::filesystem::path& file : printed_files(log)) {
    for_each_line(end_of(file, kLooksAt), [&](std::string_view line) {
      if (begins_with_error(line)) result = shown_line(line);
    });
  }
  return result;
}

std::string last_line(const std::filesystem::path& file) {
  std::string tail = end_of(file, 4096);
  const std::size_t last = tail.find_last_not_of(" \t\r\n");
  if (last == std::string::npos) return {};
  tail.resize(last + 1);
  const std::size_t before = tail.find_last_of('\n');
  return shown_line(std::string_view(tail).substr(before == std::string::npos ? 0 : before + 1));
}

}  // namespace meshorder::command
