// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/tables/tables.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// So many significant digits, 4: "0.04321", "12.35", "1,846"; all digits of whole numbers.
std::string with_digits(double number, int digits);

/// As `with_digits(whole, digits)` shows the whole that the number is a part of: after "12.35" a "0.50".
std::string with_digits_of(double number, double whole, int digits);

/// One digit after the point and a sign: "+24.9", "−0.3", "0.0".
std::string signed_percent(double percent);

/// "9,870", "12.3 k", "1.23 M": three digits for what is larger than 10,000.
std::string metric(double number);

/// 49152 as "48 KB".
std::string bytes_in_words(double bytes);

/// "falling", "falling and bowl", "falling, bowl and bounce"
std::string in_words(const std::vector<std::string>& names);

/// What heads the row of a scenario in an order: "falling, VF Fiedler".
TableCell head_of(const StudyResults& results, const ScenarioRecord& scenario, const OrderOfScenario& order);

TableCell text_cell(std::string text);
TableCell number_cell(double number, int digits = 4);
TableCell percent_cell(double percent);  ///< signed
TableCell count_cell(long long number);  ///< with commas
TableCell unknown_cell();                ///< a dash

}  // namespace meshorder
