// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::command {

/// Returns the number that a text is, also one of Fortran ("1.5D-3") and one with a plus; nothing for other
/// texts.
std::optional<double> number_of(std::string_view text);

/// Numbers in what a program printed.
class PrintedNumbers {
 public:
  /// @param option   that the expression was given by, for messages
  /// @param pattern  ECMAScript; its group, or all that matches, is a number
  /// Throws InvalidArgument for a faulty expression and for one with several groups.
  PrintedNumbers(std::string option, std::string pattern);

  /// Returns the numbers in the lines of these files, each line cut after 10,000 characters. Throws
  /// InvalidArgument if nothing matches, or what is captured is no number.
  [[nodiscard]] std::vector<double> find(const std::vector<std::filesystem::path>& files) const;

 private:
  std::string option_;
  std::string pattern_;
  std::regex expression_;
};

/// Returns where two lists of numbers disagree by more than the relative tolerance; empty if they do not.
std::string difference(const std::vector<double>& expected, const std::vector<double>& found,
                       double tolerance);

/// Returns where two texts disagree, word by word: numbers by the relative tolerance, others in any
/// character.
std::string difference(std::string_view expected, std::string_view found, double tolerance);

}  // namespace meshorder::command
