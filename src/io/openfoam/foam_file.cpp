// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/openfoam/foam_file.hpp"

#include "base/text.hpp"
#include "io/stream/byte_order.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_ends.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace meshorder::openfoam {
namespace {

/// Greatest size of a list of one repeated value, whose entries take no bytes in the file. A mesh whose faces
/// all have the same cell is small.
constexpr std::int64_t kMostAlike = 1 << 20;

constexpr std::string_view kMarks = "(){};";
constexpr std::string_view kFormatRemedy = "correct `format` in the header, or write the file again";

bool is_space(char c) { return is_blank(c) || c == '\n' || c == '\r'; }
bool is_mark(char c) { return kMarks.find(c) != std::string_view::npos; }
/// Returns whether this character ends a number or word; a slash may begin a comment.
bool is_end(char c) { return is_space(c) || is_mark(c) || c == '/'; }

/// Returns whether this character cannot occur in a text file of numbers.
bool is_no_text(char c) { return !is_space(c) && (c < ' ' || c > '~'); }

FilePath compressed(const FilePath& path) { return path.beside(path.path().filename().string() + ".gz"); }

/// Returns the compressed form of a file if only this form exists, else the file itself.
FilePath existing(const FilePath& path) {
  return path.exists() || !compressed(path).exists() ? path : compressed(path);
}

}  // namespace

FoamFile::FoamFile(const FilePath& path) {
  const FilePath found = existing(path);
  file_ = found.string();
  text_ = found.read();
  text_.resize(without_padding(text_).size());
  read_header();
}

bool FoamFile::exists(const FilePath& path) { return path.exists() || compressed(path).exists(); }

std::int64_t FoamFile::line_at(std::size_t position) const {
  return 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(position), '\n');
}

void FoamFile::fail(const std::string& what, const std::string& remedy) const {
  if (binary_) throw InputError(Location{file_, 0, static_cast<std::int64_t>(position_)}, what, remedy);
  throw InputError(Location{file_, line_at(position_), -1}, what, remedy);
}

void FoamFile::require_class(std::string_view class_name) const {
  if (class_ == class_name) return;
  throw InputError(
      Location{file_, line_at(class_end_), -1},
      class_.empty() ? "the header names no class" : fmt::format("the class is '{}'", shown(class_)),
      fmt::format("{} is expected: this may be another file under that name", class_name));
}

// ---- words

void FoamFile::skip_blanks() {
  for (;;) {
    while (position_ < text_.size() && is_space(text_[position_])) ++position_;
    const std::string_view rest = std::string_view(text_).substr(position_);
    std::string_view end;
    if (rest.starts_with("//")) {
      end = "\n";
    } else if (rest.starts_with("/*")) {
      end = "*/";
    } else {
      return;
    }
    const std::size_t found = text_.find(end, position_ + 2);
    position_ = found == std::string::npos ? text_.size() : found + end.size();
  }
}

bool FoamFile::at(char mark) {
  skip_blanks();
  return position_ < text_.size() && text_[position_] == mark;
}

bool FoamFile::take(char mark) {
  if (!at(mark)) return false;
  ++position_;
  return true;
}

void FoamFile::expect(char mark, std::string_view what) {
  if (take(mark)) return;
  if (position_ >= text_.size()) fail(fmt::format("the file ends within {}", what), "it may be cut short");
  fail(fmt::format("expected '{}' of {}, found '{}'", mark, what, shown(token())),
       binary_ ? "the size, or `arch` in the header, may be wrong" : "the size may be wrong");
}

std::string_view FoamFile::token() {
  skip_blanks();
  const std::string_view rest = std::string_view(text_).substr(position_);
  if (rest.empty()) return rest;
  if (rest.front() == '"') {
    const std::size_t end = std::min(rest.find('"', 1), rest.size());
    position_ += std::min(end + 1, rest.size());
    return rest.substr(1, end - 1);
  }
  std::size_t size = 1;
  if (!is_mark(rest.front())) {
    while (size < rest.size() && !is_space(rest[size]) && !is_mark(rest[size])) ++size;
  }
  position_ += size;
  return rest.substr(0, size);
}

bool FoamFile::at_end() {
  skip_blanks();
  return position_ >= text_.size();
}

// ---- the header

void FoamFile::read_header() {
  if (token() != "FoamFile" || !take('{')) {
    position_ = 0;
    fail("is not an OpenFOAM file", "an OpenFOAM file begins with the header FoamFile { … }");
  }
  int depth = 1;  // depth of nested braces
  while (depth > 0) {
    const std::string_view key = token();
    if (key.empty()) fail("the file ends within its header", "it may be cut short");
    if (key == "{") ++depth;
    if (key == "}") --depth;
    if (depth != 1 || is_mark(key.front()) || at('{')) continue;
    const std::string_view value = token();
    if (key == "note") note_ = value;
    if (key == "class") {
      class_ = value;
      class_end_ = position_;
    }
    if (key == "arch") read_arch(value);
    if (key == "format") {
      if (value != "ascii" && value != "binary") {
        fail(fmt::format("the format is '{}'", shown(value)), "it must be ascii or binary");
      }
      binary_ = value == "binary";
    }
  }
  if (class_ == "decomposedBlockData") {
    fail("holds the meshes of several processors",
         "write separate files with decomposePar -fileHandler uncollated");
  }
}

void FoamFile::read_arch(std::string_view arch) {
  const auto has = [&](std::string_view part) { return arch.find(part) != std::string_view::npos; };
  order_ = has("MSB") ? std::endian::big : std::endian::little;
  label_bytes_ = has("label=64") ? 8 : 4;
  scalar_bytes_ = has("scalar=32") ? 4 : 8;
}

// ---- numbers

void FoamFile::fail_number(std::string_view what, std::string_view needed) {
  skip_blanks();
  if (position_ >= text_.size()) fail(fmt::format("the file ends before {}", what), "it may be cut short");
  const std::string_view rest = std::string_view(text_).substr(position_);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \n\t\r"));
  if (std::any_of(word.begin(), word.end(), is_no_text)) {
    fail("the header says `format ascii`, but the numbers are binary", std::string(kFormatRemedy));
  }
  fail(fmt::format("{} is '{}'", what, shown(word)), fmt::format("{} is needed", needed));
}

template <class T>
std::errc FoamFile::take_number(T& value) {
  skip_blanks();
  const char* const begin = text_.data() + position_;
  const char* const end = text_.data() + text_.size();
  const auto [after, code] = std::from_chars(begin, end, value);
  if (after != end && !is_end(*after)) return std::errc::invalid_argument;
  if (code == std::errc{}) position_ += static_cast<std::size_t>(after - begin);
  return code;
}

std::int64_t FoamFile::integer(std::string_view what) {
  std::int64_t value = 0;
  const std::errc code = take_number(value);
  if (code == std::errc::result_out_of_range) fail_number(what, "a smaller number");
  if (code != std::errc{}) fail_number(what, "a whole number");
  return value;
}

double FoamFile::finite(std::string_view what) {
  const std::size_t begin = position_;
  double value = 0;
  const std::errc code = take_number(value);
  if (code == std::errc::result_out_of_range) {  // also for numbers too near 0
    const std::string_view digits = token();
    if (digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos) return 0;
  }
  if (code == std::errc{} && std::isfinite(value)) return value;
  position_ = begin;
  fail_number(what, "a finite number");
}

template <class T>
T FoamFile::binary(std::string_view what) {
  if (bytes_left() < static_cast<std::int64_t>(sizeof(T))) {
    fail(fmt::format("the file ends before {}", what), "it may be cut short");
  }
  const T value = number_at<T>(text_.data() + position_, order_);
  position_ += sizeof(T);
  return value;
}

std::int64_t FoamFile::label(std::string_view what) {
  if (!binary_) return integer(what);
  return label_bytes_ == 8 ? binary<std::int64_t>(what) : std::int64_t{binary<std::int32_t>(what)};
}

double FoamFile::scalar(std::string_view what) {
  if (!binary_) return finite(what);
  const double value = scalar_bytes_ == 4 ? double{binary<float>(what)} : binary<double>(what);
  if (!std::isfinite(value)) {
    position_ -= static_cast<std::size_t>(scalar_bytes_);
    fail(fmt::format("{} is not finite", what), "a finite number is needed");
  }
  return value;
}

Index FoamFile::checked(std::int64_t label, std::string_view what, std::int64_t least, std::int64_t end) {
  if (label < least || label >= end) {
    if (binary_) position_ -= static_cast<std::size_t>(label_bytes_);
    fail(fmt::format("{} is {}", what, label),
         end > least ? fmt::format("{} to {} are possible", least, end - 1) : "none are possible");
  }
  return static_cast<Index>(label);
}

// ---- lists

void FoamFile::refuse_text() const {
  const auto first = text_.begin() + static_cast<std::ptrdiff_t>(position_);
  if (!binary_ || std::any_of(first, text_.end(), is_no_text)) return;
  fail("the header says `format binary`, but the numbers are text", std::string(kFormatRemedy));
}

std::int64_t FoamFile::size(std::string_view what, std::int64_t bytes_each) {
  const std::string of = fmt::format("the number of {}", what);
  const std::int64_t size = integer(of);
  if (size < 0) fail(fmt::format("{} is {}", of, size), "it cannot be negative");
  if (size > kMaxIndex) fail(fmt::format("{} is {}", of, size), "at most 2147483647 are possible");
  if (size > 0) refuse_text();
  const std::size_t after = position_;
  // the last entry of a text file may lack a separator after it
  if (!at('{') && size > 0 && size > (bytes_left() + 1) / bytes_each) {
    position_ = after;
    fail(fmt::format("{} is {}, but only {} bytes follow", of, size, bytes_left()),
         "the file is cut short, or the number is wrong");
  }
  return size;
}

void FoamFile::read_labels(std::vector<Index>& labels, std::string_view what, std::int64_t least,
                           std::optional<std::int64_t> end) {
  labels.clear();
  const std::string list = fmt::format("the list of {}s", what);
  const std::string of = fmt::format("the {}", what);
  const std::int64_t count = size(fmt::format("{}s", what), binary_ ? label_bytes_ : 2);
  const std::int64_t limit = end.value_or(count);
  if (!binary_ && take('{')) {
    if (count > kMostAlike) fail(fmt::format("{} {}s are the same", count, what), "the number is wrong");
    if (const std::string fault = refused_claim(static_cast<std::uint64_t>(count) * sizeof(Index), list);
        !fault.empty()) {
      fail(fault, kClaimRemedy);
    }
    labels.assign(static_cast<std::size_t>(count), checked(integer(of), of, least, limit));
    expect('}', list);
    return;
  }
  if (count == 0 && !at('(')) return;  // in a binary file, an empty list has nothing after its size
  expect('(', list);
  labels.reserve(static_cast<std::size_t>(count));
  for (std::int64_t k = 0; k < count; ++k) {
    if (!binary_ && at(')')) {
      fail(fmt::format("{} ends after {}", list, k), fmt::format("the count at the top says {}", count));
    }
    labels.push_back(checked(label(of), of, least, limit));
  }
  expect(')', list);
}

Point FoamFile::point() {
  Point result{};
  if (!binary_) expect('(', "a point");
  for (double& coordinate : result) coordinate = scalar("a coordinate");
  if (!binary_) expect(')', "a point");
  return result;
}

std::vector<Point> FoamFile::read_points() {
  std::vector<Point> points;
  const std::int64_t count = size("points", binary_ ? 3 * std::int64_t{scalar_bytes_} : 8);
  if (count == 0 && !at('(')) return points;
  expect('(', "the list of points");
  points.reserve(static_cast<std::size_t>(count));
  for (std::int64_t k = 0; k < count; ++k) points.push_back(point());
  expect(')', "the list of points");
  return points;
}

std::int64_t FoamFile::begin_lists(std::string_view what) {
  const std::int64_t count = size(what, 2);
  expect('(', fmt::format("the list of {}", what));
  return count;
}

void FoamFile::end_lists(std::string_view what) { expect(')', fmt::format("the list of {}", what)); }

}  // namespace meshorder::openfoam
