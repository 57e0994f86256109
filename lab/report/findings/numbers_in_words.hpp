// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/tables/tables.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// Returns a number with that many significant digits: with 4, "0.04321", "12.35", "1,846". The part before
/// the point always has all its digits.
std::string with_digits(double number, int digits);

/// Returns a number with as many decimals as `with_digits(whole, digits)` has: "0.50" for a part of "12.35".
std::string with_digits_of(double number, double whole, int digits);

/// Returns a number with a sign and one decimal: "+24.9", "−0.3"; "0.0" has no sign.
std::string signed_percent(double percent);

/// Returns "9,870", "12.3 k", "1.23 M": three digits from 10,000 on.
std::string metric(double number);

/// Returns "48 KB" for 49152.
std::string bytes_in_words(double bytes);

/// Returns "falling", "falling and bowl", "falling, bowl and bounce".
std::string in_words(const std::vector<std::string>& names);

/// Returns the head of a row: "falling, VF Fiedler".
TableCell head_of(const StudyResults& results, const ScenarioRecord& scenario,
                  const ScenarioOrderRecord& order);

TableCell text_cell(std::string text);
TableCell number_cell(double number, int digits = 4);
TableCell percent_cell(double percent);  ///< signed
TableCell count_cell(long long number);  ///< with commas
TableCell unknown_cell();                ///< a dash

}  // namespace meshorder
