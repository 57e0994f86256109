// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/abaqus/output.hpp"

#include "base/text.hpp"
#include "io/abaqus/cards.hpp"
#include "io/names.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <charconv>
#include <set>

namespace meshorder::abaqus {
namespace {

constexpr std::size_t kPerLine = 16;
constexpr std::size_t kMostCharacters = 20;

/// Removes the plus and the leading zeros of an exponent.
std::string_view without_padding(char* begin, char* end) {
  char* const e = std::find(begin, end, 'e');
  if (e == end) return {begin, static_cast<std::size_t>(end - begin)};
  char* to = e + 1;
  char* from = e + 1;
  if (*from == '-') *to++ = *from;
  while (from + 1 < end && std::isdigit(static_cast<unsigned char>(*from)) == 0) ++from;
  while (from + 1 < end && *from == '0') ++from;
  to = std::copy(from, end, to);
  return {begin, static_cast<std::size_t>(to - begin)};
}

/// A number as text.
struct RealText {
  std::array<char, 40> buffer{};
  std::string_view text;
  bool is_rounded = false;

  explicit RealText(double value) {
    write(value);
    if (text.size() <= kMostCharacters) return;
    double rounded = 0;
    for (int digits = 16; text.size() > kMostCharacters; --digits) {
      char* const begin = buffer.data();
      char* const end = begin + buffer.size();
      text =
          without_padding(begin, std::to_chars(begin, end, value, std::chars_format::scientific, digits).ptr);
      std::from_chars(text.data(), text.data() + text.size(), rounded);
      if (text.size() <= kMostCharacters) write(rounded);  // drops trailing zeros
    }
    is_rounded = rounded != value;
  }

 private:
  void write(double value) {
    char* const begin = buffer.data();
    char* const end = begin + buffer.size();
    text = without_padding(begin, std::to_chars(begin, end, value).ptr);
    if (text.size() <= kMostCharacters) return;
    text = without_padding(begin, std::to_chars(begin, end, value, std::chars_format::scientific).ptr);
  }
};

/// Returns a valid name that is not in `taken`, ignoring case, and adds it to `taken`.
std::string name_for(const std::string& given, std::set<std::string>& taken, NameNumbers& numbers) {
  constexpr std::size_t kLongest = 80;
  std::string name = plain_name(given, " ,\"=*.");
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) name = "set_" + name;
  const auto numbered = [&](int k) {
    const std::string end = fmt::format("_{}", k);
    return std::string(utf8_prefix(name, kLongest - end.size())) + end;
  };
  return numbers.free_name(std::string(utf8_prefix(name, kLongest)), numbered,
                           [&](const std::string& free) { return taken.insert(capitals(free)).second; });
}

}  // namespace

std::string short_real(double value) { return std::string(RealText(value).text); }

void DeckOutput::begin_line() {
  if (within_line_) out_.write(line_end_);
  within_line_ = false;
}

void DeckOutput::nodes(std::span<const Point> points, int dimension, const Rows& rows) {
  if (points.empty()) return;
  begin_line();
  std::atomic<std::int64_t> rounded = 0;
  write_row_ranges(out_, index_size(points), [&](Text& text, Index begin, Index end) {
    std::int64_t rounded_here = 0;
    Row row;
    for (Index i = begin; i < end; ++i) {
      rows(row, i);
      text.integer("", row.number);
      for (int k = 0; k < dimension; ++k) {
        const RealText real(points[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]);
        if (real.is_rounded) ++rounded_here;
        text.write(", ");
        text.write(real.text);
      }
      text.write(row.more);
      text.write(line_end_);
    }
    rounded += rounded_here;
  });
  rounded_ += rounded;
}

void DeckOutput::elements(Index count, const Rows& rows) {
  if (count == 0) return;
  begin_line();
  write_row_ranges(out_, count, [&](Text& text, Index begin, Index end) {
    Row row;
    for (Index i = begin; i < end; ++i) {
      rows(row, i);
      text.integer("", row.number);
      std::size_t on_line = 1;
      for (const std::int64_t node : row.nodes) {
        if (on_line == kPerLine) {
          text.write(",");
          text.write(line_end_);
          on_line = 0;
        }
        text.integer(on_line == 0 ? "" : ", ", node);
        ++on_line;
      }
      text.write(row.more);
      text.write(line_end_);
    }
  });
}

void DeckOutput::list(const std::vector<std::int64_t>& numbers) {
  if (numbers.empty()) return;
  begin_line();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    out_.integer(i % kPerLine == 0 ? "" : ", ", numbers[i]);
    if (i % kPerLine == kPerLine - 1 || i + 1 == numbers.size()) out_.write(line_end_);
  }
}

void DeckOutput::set(Association association, std::string_view name,
                     const std::vector<std::int64_t>& members) {
  const std::string_view keyword = association == Association::vertices ? "NSET" : "ELSET";
  begin_line();
  out_.print("*{}, {}={}{}", keyword, keyword, name, line_end_);
  list(members);
}

void DeckOutput::note_rounded(Notes& notes) const {
  if (rounded_ == 0) return;
  notes.push_back(
      fmt::format("{} rounded to the 20 characters that Abaqus and CalculiX read of a number",
                  rounded_ == 1 ? "one coordinate is" : fmt::format("{} coordinates are", rounded_)));
}

void write_sets(DeckOutput& out, const std::vector<EntitySet>& sets, const DeckNumbers& numbers,
                Notes& notes) {
  std::array<std::set<std::string>, 2> taken;
  std::array<NameNumbers, 2> numbering;
  for (const EntitySet& set : sets) {
    const bool of_nodes = set.association == Association::vertices;
    if (set.members.empty()) {
      note_set_empty(set, notes);
      continue;
    }
    const std::string name = name_for(set.name, taken[of_nodes ? 0 : 1], numbering[of_nodes ? 0 : 1]);
    note_renamed_set(set, name, notes);
    std::vector<std::int64_t> members;
    members.reserve(set.members.size());
    for (const Index member : set.members) members.push_back(numbers.of(set.association).at(member));
    out.set(set.association, name, members);
  }
}

}  // namespace meshorder::abaqus
