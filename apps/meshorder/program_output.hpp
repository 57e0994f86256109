// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::command {

/// Returns the number that a text spells, also in Fortran's form ("1.5D-3") or with a plus; nothing for other
/// texts.
std::optional<double> number_of(std::string_view text);

/// Finds numbers in the output of a program.
class PrintedNumbers {
 public:
  /// @param option   option that gave the expression, for messages
  /// @param pattern  an ECMAScript expression; its group or, without a group, the whole match is a number
  /// Throws InvalidArgument for a faulty expression and for an expression with several groups.
  PrintedNumbers(std::string option, std::string pattern);

  /// Returns the numbers in the lines of these files; each line is cut after 10,000 characters. Throws
  /// InvalidArgument if nothing matches, or if a match is not a number.
  [[nodiscard]] std::vector<double> find(const std::vector<std::filesystem::path>& files) const;

  /// Returns the option with its expression, for messages.
  [[nodiscard]] std::string name() const { return option_ + ' ' + pattern_; }

 private:
  std::string option_;
  std::string pattern_;
  std::regex expression_;
};

/// Returns the first difference in words: another count of numbers, or numbers that differ by more than the
/// relative tolerance and by more than 1e-12 times the largest magnitude in `expected`. Empty if none.
std::string difference(const std::vector<double>& expected, const std::vector<double>& found,
                       double tolerance);

/// Returns the first difference of two texts in words; empty if none. Compares words exactly, integers with
/// the limits above, and other numbers up to the tolerance relative to the largest number of their kind in
/// `expected`: the same column under the same heading.
std::string difference(std::string_view expected, std::string_view found, double tolerance);

/// Returns why a text cannot be compared: it has no words, or all numbers of a kind are NaN or infinite.
/// Empty if it can be compared.
std::string why_not_comparable(std::string_view text);

/// Returns the files that hold a program's stdout and stderr; see TrialCommand::log.
std::vector<std::filesystem::path> printed_files(const std::filesystem::path& log);

/// Returns the last line of stderr, or else of stdout, that begins with the word "error", in any case, after
/// blanks, "*", "-", "#" or "["; else an empty text. Skips results: lines with only a number after the last
/// "=" or ":", or after "error". Searches the last 16 MiB of each; cuts the line to 300 bytes.
std::string error_line(const std::filesystem::path& log);

/// Returns the last line that is not blank in the last 4 KiB of a file, cut to 300 bytes.
std::string last_line(const std::filesystem::path& file);

}  // namespace meshorder::command
