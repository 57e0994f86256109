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
#include <functional>
#include <numeric>
#include <system_error>
#include <unordered_map>
#include <utility>

namespace meshorder::command {
namespace {

constexpr std::size_t kLongestLine = 10'000;
constexpr std::string_view kSeparators = "\r,;";

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

/// Returns whether a word is a sign and digits alone.
bool is_integer(std::string_view word) {
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Reads a text word by word. Numbers have a kind: lines of equally many words, each line under the same
/// heading, form a table, and the numbers in a column of it are of one kind. A heading is the last line that
/// has words besides numbers; the numbers in it do not count.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// Goes on to the next word; returns false at the end, where the word is empty.
  bool next() {
    while (++at_ >= words_.size()) {
      words_.clear();
      if (rest_.empty()) return false;
      read_line();
    }
    return true;
  }

  [[nodiscard]] std::string_view text() const {
    return at_ < words_.size() ? words_[at_].text : std::string_view();
  }
  [[nodiscard]] std::optional<double> number() const {
    return at_ < words_.size() ? words_[at_].number : std::nullopt;
  }
  [[nodiscard]] std::size_t kind() const { return mixed(mixed(heading_, words_.size()), at_); }

 private:
  struct Word {
    std::string_view text;
    std::optional<double> number;
  };

  static std::size_t mixed(std::size_t hash, std::size_t with) {
    constexpr std::size_t kFactor = 1099511628211U;
    return (hash ^ with) * kFactor;
  }

  void read_line() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    std::size_t heading = 0;
    for (std::string_view word; !(word = next_word(line, kSeparators)).empty();) {
      words_.push_back({word, number_of(word)});
      if (!words_.back().number) heading = mixed(heading, std::hash<std::string_view>{}(word));
    }
    if (heading != 0) heading_ = heading;
    at_ = static_cast<std::size_t>(-1);
  }

  std::string_view rest_;
  std::vector<Word> words_;  // of the line
  std::size_t at_ = static_cast<std::size_t>(-1);
  std::size_t heading_ = 0;
};

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
  std::unordered_map<std::size_t, double> largest;  // by kind
  double largest_of_all = 0;
  for (Words words(expected); words.next();) {
    if (!words.number()) continue;
    double& of_kind = largest.try_emplace(words.kind(), 0).first->second;
    of_kind = larger(of_kind, *words.number());
    largest_of_all = larger(largest_of_all, *words.number());
  }
  Words a(expected);
  Words b(found);
  for (;;) {
    const bool has_ended = !a.next();
    if (!b.next() && has_ended) return {};
    if (a.number() && b.number()) {
      Closeness allowed = closeness(tolerance, largest_of_all);
      if (!is_integer(a.text()) || !is_integer(b.text()))
        allowed.floor = std::max(allowed.floor, tolerance * largest[a.kind()]);
      if (allowed.agree(*a.number(), *b.number())) continue;
    } else if (a.text() == b.text()) {
      continue;
    }
    return fmt::format("'{}' instead of '{}'", utf8_prefix(b.text(), 40), utf8_prefix(a.text(), 40));
  }
}

std::string why_not_comparable(std::string_view text) {
  std::unordered_map<std::size_t, bool> is_finite;  // by kind: whether a number is
  std::unordered_map<std::size_t, std::string_view> examples;
  bool is_empty = true;
  for (Words words(text); words.next();) {
    is_empty = false;
    if (!words.number()) continue;
    const bool is_finite_here = std::isfinite(*words.number());
    bool& of_kind = is_finite.try_emplace(words.kind(), false).first->second;
    of_kind = of_kind || is_finite_here;
    if (!is_finite_here) examples.try_emplace(words.kind(), words.text());
  }
  if (is_empty) return "it is empty";
  for (const auto& [kind, example] : examples) {
    if (!is_finite[kind]) return fmt::format("it has '{}' where a number should be", example);
  }
  return {};
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
