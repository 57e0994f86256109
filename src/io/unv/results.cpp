// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/unv/unv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace meshorder::unv {
namespace {

constexpr std::string_view kNoText = "NONE";
constexpr std::int64_t kMostComponents = 1000;

/// Returns the whole numbers at the beginning of a line, at most `most`.
std::vector<std::int64_t> integers_of(std::string_view line, std::size_t most) {
  std::vector<std::int64_t> numbers;
  for (std::string_view word = next_word(line); !word.empty() && numbers.size() < most;
       word = next_word(line)) {
    std::int64_t number = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (code != std::errc{} || end != word.data() + word.size()) break;
    numbers.push_back(number);
  }
  return numbers;
}

/// Takes `count` lines; fewer at the end of the file.
std::vector<std::string_view> take_lines(Scanner& in, std::size_t count) {
  std::vector<std::string_view> lines;
  while (lines.size() < count && in.bytes_left() > 0) lines.push_back(in.raw_line());
  return lines;
}

/// Sets the fields that depend on a data type (1 integer, 2 single, 4 double, 5 complex single, 6 complex
/// double) and the number of values; returns false if the type or the number is not supported.
bool set_type(Results& results, std::int64_t type, std::int64_t values) {
  if (values < 1 || values > kMostComponents) return false;
  const bool is_complex = type == 5 || type == 6;
  if (type != 1 && type != 2 && type != 4 && !is_complex) return false;
  results.components_in_file = values;
  results.components = static_cast<Index>(is_complex ? 2 * values : values);
  results.digits = type == 4 || type == 6 ? 12 : 5;
  results.integers = type == 1;
  return true;
}

/// Sets the name to the first of the candidate lines that is not empty or NONE.
void set_name(Results& results, const std::vector<std::string_view>& lines,
              std::initializer_list<std::size_t> candidates) {
  results.name = "results";
  for (const std::size_t k : candidates) {
    const std::string_view text = trimmed(lines[k]);
    if (text.empty() || text == kNoText) continue;
    results.name = text;
    return;
  }
}

std::optional<Results> header_of_analysis(Scanner& in) {
  const std::vector<std::string_view> lines = take_lines(in, 13);
  if (lines.size() < 13) return {};
  const std::vector<std::int64_t> location = integers_of(lines[2], 1);
  const std::vector<std::int64_t> kinds = integers_of(lines[8], 6);
  if (location.size() != 1 || location[0] < 1 || location[0] > 2 || kinds.size() != 6) return {};
  Results results;
  results.association = location[0] == 1 ? Association::vertices : Association::cells;
  if (!set_type(results, kinds[4], kinds[5])) return {};
  set_name(results, lines, {1, 3});
  return results;
}

std::optional<Results> header_of_old(Scanner& in, int dataset) {
  const std::vector<std::string_view> lines = take_lines(in, 6);
  if (lines.size() < 6) return {};
  const std::vector<std::int64_t> kinds = integers_of(lines[5], 6);
  const std::vector<std::int64_t> counts = integers_of(in.peek_line(), 2);
  if (kinds.size() != 6 || counts.size() < 2) return {};
  if (std::any_of(counts.begin(), counts.begin() + 2, [](std::int64_t n) { return n < 0 || n > 1000; })) {
    return {};
  }
  Results results;
  results.association = dataset == kResultsAtNodes ? Association::vertices : Association::cells;
  if (!set_type(results, kinds[4], kinds[5])) return {};
  set_name(results, lines, {0, 1});
  // a line has 8 whole or 6 real numbers; the two counts are whole numbers, too
  const auto lines_of = [](std::int64_t numbers, std::int64_t on_line) {
    return static_cast<std::size_t>(std::max<std::int64_t>((numbers + on_line - 1) / on_line, 1));
  };
  (void)take_lines(in, lines_of(counts[0] + 2, 8) + lines_of(counts[1], 6));
  return results;
}

}  // namespace

std::optional<Results> read_results_header(Scanner& in, int dataset) {
  return dataset == kResults ? header_of_analysis(in) : header_of_old(in, dataset);
}

std::optional<DataArray> array_of(const FoundResults& found, const IdMap& items) {
  const auto components = static_cast<std::size_t>(found.results.components);
  const auto count = static_cast<std::size_t>(items.size());
  std::vector<Index> rows;  // node or element of each row
  std::vector<bool> seen(count, false);
  rows.reserve(found.numbers.size());
  for (const std::int64_t number : found.numbers) {
    const Index item = items.find(number);
    if (item < 0 || seen[item]) return {};
    seen[item] = true;
    rows.push_back(item);
  }
  if (rows.empty()) return {};
  DataArray array{found.results.array, found.results.association, found.results.components, {}, {}, {}};
  std::vector<double> values = found.values;
  if (rows.size() == count) {
    for (std::size_t r = 0; r < count; ++r) {
      std::copy_n(
          found.values.begin() + static_cast<std::ptrdiff_t>(r * components), components,
          values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(rows[r]) * components));
    }
  } else {
    array.indices = std::move(rows);
  }
  const bool whole = found.results.integers && std::all_of(values.begin(), values.end(), [](double value) {
                       return value == std::trunc(value) && std::abs(value) <= kMaxIndex &&
                              fits_columns(static_cast<std::int64_t>(value));
                     });
  if (whole) {
    std::vector<std::int32_t> integers(values.size());
    std::transform(values.begin(), values.end(), integers.begin(),
                   [](double value) { return static_cast<std::int32_t>(value); });
    array.values = std::move(integers);
  } else {
    array.values = std::move(values);
  }
  return array;
}

std::vector<std::int64_t> local_systems(std::string_view text) {
  // 2 lines begin the dataset, 2 name the part; then each system: numbers, name, matrix in 4 lines
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  std::vector<std::int64_t> systems;
  for (std::size_t k = 4; k + 6 <= lines.size(); k += 6) {
    const std::vector<std::int64_t> fields = integers_of(lines[k], 2);
    if (fields.size() < 2) break;
    bool is_global = fields[1] == 0;  // Cartesian
    for (std::size_t row = 0; row < 4; ++row) {
      std::string_view rest = lines[k + 2 + row];
      for (std::size_t column = 0; column < 3; ++column) {
        std::string word(next_word(rest, "\r"));
        std::replace_if(
            word.begin(), word.end(), [](char c) { return c == 'D' || c == 'd'; }, 'e');
        double value = 0;
        const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
        const double expected = row == column ? 1 : 0;
        is_global = is_global && code == std::errc{} && value == expected;
      }
    }
    if (!is_global) systems.push_back(fields[0]);
  }
  return systems;
}

double real_of(const Scanner& at, std::string_view word, std::string_view what) {
  // words of the usual length are parsed here; all other words go to the general parser
  std::array<char, 40> buffer{};
  if (word.size() < buffer.size()) {
    char* const end = std::transform(word.begin(), word.end(), buffer.begin(),
                                     [](char c) { return c == 'D' || c == 'd' ? 'e' : c; });
    double value = 0;
    const auto [after, code] = std::from_chars(buffer.data(), end, value);
    if (code == std::errc{} && after == end) return value;
    // an exponent of three digits has no letter
    const bool is_sign = code == std::errc{} && (*after == '-' || *after == '+');
    if (is_sign && end + 1 < buffer.data() + buffer.size()) {
      const auto mantissa = static_cast<std::size_t>(after - buffer.data());
      return parse_real(at, std::string(word.substr(0, mantissa)) + 'e' + std::string(word.substr(mantissa)),
                        what);
    }
  }
  return parse_real(at, word, what);
}

}  // namespace meshorder::unv
