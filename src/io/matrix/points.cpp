// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Matrix Market's dense arrays: R. Boisvert, R. Pozo and K. Remington, "The Matrix Market exchange formats:
// initial design", NISTIR 5935 (1996).
#include "base/text.hpp"
#include "io/matrix/matrix.hpp"
#include "io/npy.hpp"
#include "io/stream/scanner.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace meshorder {
namespace {

constexpr std::string_view kArrayBanner = "%%MatrixMarket";
constexpr const char* kRowRemedy = "give a row of 2 or 3 numbers for each row of the matrix, or vertex";

class PointReader {
 public:
  PointReader(const FilePath& path, Index rows) : in_(path), rows_(rows) {}

  RowPoints read() {
    result_.points.assign(rows_, Point{0, 0, 0});
    if (in_.all().starts_with("\x93NUMPY")) {
      read_numpy();
    } else if (same_but_for_case(in_.all().substr(0, kArrayBanner.size()), kArrayBanner)) {
      read_array();
    } else {
      read_text();
    }
    const std::vector<Point>& points = result_.points;
    if (std::all_of(points.begin(), points.end(), [&](const Point& p) { return p == points.front(); })) {
      throw InputError(in_.file(), "all points are the same",
                       "an order by coordinates needs ones that differ");
    }
    return std::move(result_);
  }

 private:
  /// Fails unless the file has as many rows as the matrix, and two or three numbers in each row.
  void take_shape(std::int64_t rows, std::int64_t columns) {
    if (columns != 2 && columns != 3) in_.fail(fmt::format("a row has {} numbers", columns), kRowRemedy);
    if (rows != rows_) fail_of_rows(fmt::format("has {} rows of coordinates", rows));
    result_.dimension = static_cast<int>(columns);
  }

  [[noreturn]] void fail_of_rows(const std::string& what) const {
    in_.fail(fmt::format("{}, where {} are needed", what, rows_), kRowRemedy);
  }

  void read_numpy() {
    const NpyHeader header = read_npy_header(in_);
    const std::string& type = header.type;
    const bool known = type == "<f8" || type == "<f4" || type == ">f8" || type == ">f4";
    if (!known) in_.fail_at_byte("holds '" + shown(type) + "'", "32- or 64-bit real numbers are needed");
    if (header.shape.size() != 2) {
      in_.fail_at_byte(fmt::format("is an array of {} dimensions", header.shape.size()), kRowRemedy);
    }
    take_shape(header.shape[0], header.shape[1]);
    const std::endian order = type[0] == '<' ? std::endian::little : std::endian::big;
    const bool is_double = type[2] == '8';
    for_places(header.columns_first, [&](double& value) {
      value =
          is_double ? in_.binary<double>("a coordinate", order) : in_.binary<float>("a coordinate", order);
      if (!std::isfinite(value)) {
        in_.fail_at_byte("a coordinate is " + std::to_string(value), "finite numbers are needed");
      }
    });
    if (in_.bytes_left() > 0) in_.fail_at_byte("continues after the last number", "write it with numpy.save");
  }

  void read_array() {
    std::string_view line = in_.peek_line();
    (void)next_word(line);
    for (const std::string_view expected : {"matrix", "array"}) {
      if (const std::string_view word = next_word(line); !same_but_for_case(word, expected)) {
        in_.fail(fmt::format("the first line has '{}' where '{}' is needed", shown(word), expected),
                 "points are a dense array");
      }
    }
    if (const std::string_view field = next_word(line);
        !same_but_for_case(field, "real") && !same_but_for_case(field, "integer")) {
      in_.fail(fmt::format("the array is of the field '{}'", shown(field)), "real numbers are needed");
    }
    if (const std::string_view symmetry = next_word(line); !same_but_for_case(symmetry, "general")) {
      in_.fail(fmt::format("the array is '{}'", shown(symmetry)), "'general' is needed");
    }
    (void)in_.raw_line();
    while (in_.bytes_left() > 0 &&
           (trimmed(in_.peek_line()).empty() || trimmed(in_.peek_line()).front() == '%'))
      (void)in_.raw_line();
    const auto rows = in_.integer<std::int64_t>("the number of rows");
    const auto columns = in_.integer<std::int64_t>("the number of columns");
    take_shape(rows, columns);
    for_places(true, [&](double& value) { value = in_.finite("a coordinate"); });
    if (!in_.at_end()) in_.fail("more numbers than the sizes say", "the sizes are wrong");
  }

  void read_text() {
    Index row = 0;
    for (; in_.bytes_left() > 0; (void)in_.raw_line()) {
      const std::string_view line = in_.peek_line();
      const std::string_view rest = trimmed(line.substr(0, line.find_first_of("#%")));
      if (rest.empty()) continue;
      if (row == rows_) fail_of_rows("has more rows of coordinates");
      const int count = read_row(rest, result_.points[row]);
      if (row > 0 && count != result_.dimension) {
        in_.fail(fmt::format("the row has {} numbers, those before it {}", count, result_.dimension),
                 kRowRemedy);
      }
      result_.dimension = count;
      ++row;
    }
    if (row < rows_) fail_of_rows(fmt::format("has {} rows of coordinates", row));
  }

  /// Reads the numbers of a row into `point`; returns how many there are.
  int read_row(std::string_view text, Point& point) {
    constexpr std::string_view kBlanks = " \t\r";
    int count = 0;
    for (bool more = true; more; ++count) {
      const auto end = std::min(text.find_first_of(" \t\r,"), text.size());
      const double value = parse_real(in_, text.substr(0, end), "a coordinate");
      if (!std::isfinite(value)) {
        in_.fail("a coordinate is " + shown(text.substr(0, end)), "finite numbers are needed");
      }
      if (count < 3) point[count] = value;
      text.remove_prefix(end);
      text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
      const bool comma = text.starts_with(',');
      if (comma) text.remove_prefix(1);
      text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
      more = comma || !text.empty();
    }
    if (count < 2 || count > 3) in_.fail(fmt::format("the row has {} numbers", count), kRowRemedy);
    return count;
  }

  /// Calls `set` for each coordinate in the order of the file.
  template <class Set>
  void for_places(bool columns_first, Set set) {
    if (columns_first) {
      for (int c = 0; c < result_.dimension; ++c) {
        for (Point& point : result_.points) set(point[c]);
      }
    } else {
      for (Point& point : result_.points) {
        for (int c = 0; c < result_.dimension; ++c) set(point[c]);
      }
    }
  }

  Scanner in_;
  Index rows_;
  RowPoints result_;
};

}  // namespace

RowPoints read_points(const FilePath& path, Index rows) { return PointReader(path, rows).read(); }

}  // namespace meshorder
