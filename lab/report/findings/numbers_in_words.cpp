// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/numbers_in_words.hpp"

#include "lab/report/findings/lookup.hpp"
#include "payoff/quantities.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

/// Returns the text of a number with a true minus sign.
std::string with_minus(const std::string& text) {
  return text.starts_with('-') ? "−" + text.substr(1) : text;
}

}  // namespace

std::string with_digits(double number, int digits) { return with_digits_of(number, number, digits); }

std::string with_digits_of(double number, double whole, int digits) {
  const double size = std::abs(whole);
  if (number == 0) return "0";
  if (size > 0 && size < 1e-4) return with_minus(fmt::format("{:.3g}", number));
  // counts the digits before the point of the rounded number: 9.9996 becomes 10
  const double rounded_up = size / (1 - 0.5 * std::pow(10, -digits));
  const int before = size > 0 ? static_cast<int>(std::floor(std::log10(rounded_up))) + 1 : 1;
  if (before >= digits) return with_minus(with_commas(std::llround(number)));
  return with_minus(fmt::format("{:.{}f}", number, digits - before));
}

std::string signed_percent(double percent) {
  const double rounded = std::round(10 * percent) / 10;
  return rounded == 0 ? "0.0" : with_minus(fmt::format("{:+.1f}", rounded));
}

std::string metric(double number) {
  if (number < 10'000) return with_commas(std::llround(number));
  constexpr std::array kPrefixes{" k", " M", " G", " T"};
  std::size_t prefix = 0;
  double scaled = number / 1000;
  while (scaled >= 999.5 && prefix + 1 < kPrefixes.size()) {
    scaled /= 1000;
    ++prefix;
  }
  const int digits = scaled < 9.995 ? 2 : scaled < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f}{}", scaled, digits, kPrefixes[prefix]);
}

std::string bytes_in_words(double bytes) {
  constexpr std::array kUnits{"bytes", "KB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 1024 && unit + 1 < kUnits.size()) {
    bytes /= 1024;
    ++unit;
  }
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

std::string in_words(const std::vector<std::string>& names) {
  if (names.size() < 2) return names.empty() ? "" : names.front();
  return fmt::format("{} and {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

TableCell text_cell(std::string text) { return {std::move(text), std::nullopt, false}; }
TableCell number_cell(double number, int digits) { return {with_digits(number, digits), number, false}; }
TableCell percent_cell(double percent) { return {signed_percent(percent), percent, false}; }
TableCell count_cell(long long number) {
  return {with_minus(with_commas(number)), static_cast<double>(number), false};
}
TableCell unknown_cell() { return {"–", std::nullopt, true}; }

TableCell head_of(const StudyResults& results, const ScenarioRecord& scenario,
                  const ScenarioOrderRecord& order) {
  return text_cell(fmt::format("{}, {}", scenario.name, title_of(results, order.ordering)));
}

}  // namespace meshorder
