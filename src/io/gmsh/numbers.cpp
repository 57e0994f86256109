// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/error.hpp"
#include "io/gmsh/gmsh.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace meshorder::gmsh {
namespace {

/// A vector finds numbers faster than a hash map, while they do not lie too far apart.
constexpr std::int64_t kDenseFactor = 4;

}  // namespace

// ---- Places

Places::Places(const Source& source, const std::vector<std::int64_t>& ids, std::string_view what)
    : count_(index_size(ids)) {
  const auto fail_twice = [&](std::int64_t id) {
    source.fail(std::string(what) + " " + std::to_string(id) + " is given twice",
                "each needs a number of its own");
  };
  std::int64_t highest = 0;
  for (Index i = 0; i < count_; ++i) {
    if (ids[i] < 0)
      source.fail(std::string(what) + " " + std::to_string(ids[i]) + " has a negative number",
                  "numbers must be positive");
    consecutive_ = consecutive_ && ids[i] == i + 1;
    highest = std::max(highest, ids[i]);
  }
  if (consecutive_) return;

  if (highest / kDenseFactor <= count_) {
    dense_.assign(highest + 1, -1);
    for (Index i = 0; i < count_; ++i) {
      if (dense_[ids[i]] >= 0) fail_twice(ids[i]);
      dense_[ids[i]] = i;
    }
  } else {
    sparse_.reserve(count_);
    for (Index i = 0; i < count_; ++i) {
      if (!sparse_.try_emplace(ids[i], i).second) fail_twice(ids[i]);
    }
  }
}

Index Places::find(std::int64_t id) const {
  if (consecutive_) return id >= 1 && id <= count_ ? static_cast<Index>(id - 1) : -1;
  if (!dense_.empty()) return id >= 0 && id < index_size(dense_) ? dense_[id] : -1;
  const auto found = sparse_.find(id);
  return found == sparse_.end() ? -1 : found->second;
}

// ---- Source

void Source::fail(const std::string& what, const std::string& remedy) const {
  if (binary) in.fail_at_byte(what, remedy);
  in.fail(what, remedy);
}

std::int32_t Source::int32(std::string_view what) {
  return binary ? in.binary<std::int32_t>(what, order) : in.integer<std::int32_t>(what);
}

std::int64_t Source::size(std::string_view what) {
  return binary ? in.binary<std::int64_t>(what, order) : in.integer<std::int64_t>(what);
}

double Source::real(std::string_view what) { return binary ? in.binary<double>(what, order) : in.real(what); }

double Source::finite(std::string_view what) {
  if (!binary) return in.finite(what);
  const auto value = in.binary<double>(what, order);
  if (!std::isfinite(value)) fail(std::string(what) + " is not finite", "a finite number is needed");
  return value;
}

Index Source::checked(std::int64_t number, std::string_view what, std::int64_t bytes) const {
  if (!binary) return in.checked_count(number, what, bytes);
  const std::string shown = std::string(what) + " is " + std::to_string(number);
  if (number < 0) fail(shown, "it cannot be negative");
  if (number > kMaxIndex) fail(shown, "at most 2147483647 are possible");
  if (number > in.bytes_left() / bytes) {
    fail(shown + ", but only " + std::to_string(in.bytes_left()) + " bytes follow",
         "the count is wrong or the file is cut short");
  }
  return static_cast<Index>(number);
}

Index Source::count(std::string_view what, std::int64_t text_bytes, std::int64_t binary_bytes) {
  const std::int64_t number = size(what);
  return checked(number, what, binary ? binary_bytes : text_bytes);
}

std::int64_t Source::text_integer(std::string_view what) {
  if (!binary) return in.integer<std::int64_t>(what);
  // lines mean nothing in a binary file, so that errors must give the byte
  const std::string_view word = in.peek_word();
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size()) {
    fail(std::string(what) + " is no whole number", "the file may be damaged");
  }
  (void)in.word(what);
  return value;
}

double Source::text_real(std::string_view what) {
  if (!binary) return in.real(what);
  const std::string_view word = in.peek_word();
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size()) {
    fail(std::string(what) + " is no number", "the file may be damaged");
  }
  (void)in.word(what);
  return value;
}

void Source::begin_binary() {
  if (binary) (void)in.raw_line();
}

void Source::expect_end(std::string_view section) {
  const std::string end = "$End" + std::string(section);
  const std::string_view word = in.peek_word();
  if (word == end) {
    (void)in.word(end);
  } else if (word.empty()) {
    fail("the file ends where " + end + " should stand", "it may be cut short");
  } else {
    fail("$" + std::string(section) + " goes on where " + end + " should stand", "is a count too small?");
  }
}

// ---- Sink

void Sink::separate() {
  if (!at_line_start) out.write(" ");
  at_line_start = false;
}

void Sink::int32(std::int64_t value) {
  if (binary) {
    if (value > std::numeric_limits<std::int32_t>::max() ||
        value < std::numeric_limits<std::int32_t>::min()) {
      throw Error(file, "the number " + std::to_string(value) + " does not fit in this binary file",
                  "give nodes and elements numbers below 2147483648");
    }
    out.binary(static_cast<std::int32_t>(value), order);
  } else {
    size(value);
  }
}

void Sink::size(std::int64_t value) {
  if (binary) {
    out.binary(value, order);
  } else {
    separate();
    out.print("{}", value);
  }
}

void Sink::real(double value) {
  if (binary) {
    out.binary(value, order);
  } else {
    separate();
    out.print("{}", value);
  }
}

void Sink::end_line() {
  if (!binary) out.write("\n");
  at_line_start = true;
}

}  // namespace meshorder::gmsh
