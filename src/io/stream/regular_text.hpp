// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/id_map.hpp"
#include "io/stream/scanner.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <type_traits>

namespace meshorder {

/// How much of a text was read as numbers.
struct RegularNumbers {
  std::size_t count = 0;     ///< how many numbers were read
  std::size_t bytes = 0;     ///< bytes up to the end of the last number or of the blanks after it
  std::int64_t lines = 0;    ///< line feeds in these bytes
  bool has_returns = false;  ///< these bytes may contain carriage returns, which also end lines
};

/// As `read_regular_numbers`, for double, float, uint8, int32 and int64.
template <class Number>
RegularNumbers read_numbers_of_type(std::string_view text, std::span<Number> values, std::size_t part_bytes);

/// Reads numbers from the beginning of a text on all threads, as far as they are regular: in the form and
/// range of `std::from_chars`, and separated by blanks, tabs and line ends alone. The caller reads the other
/// numbers one by one: errors and results are then those of reading all numbers one by one.
///
/// The text is divided at blanks and line ends into parts. The words of each part are counted, which gives
/// the index of the next part's first number.
///
/// @param values      receives the numbers, as many as fit; entries after these numbers may be overwritten
/// @param part_bytes  least size of a part, > 0
/// @note O(bytes of the numbers); memory: a few numbers for each part. Reads nothing if `Number` is a type
///       that is rare in files.
template <class Number>
RegularNumbers read_regular_numbers(std::string_view text, std::span<Number> values,
                                    std::size_t part_bytes = std::size_t{1} << 20) {
  if constexpr (std::is_floating_point_v<Number> || std::is_same_v<Number, std::uint8_t> ||
                (std::is_signed_v<Number> && sizeof(Number) >= sizeof(std::int32_t)))
    return read_numbers_of_type(text, values, part_bytes);
  else
    return {};
}

/// As the function above, from the position of a scanner without comments. Moves the scanner after the last
/// number. Returns how many numbers it read.
template <class Number>
std::size_t read_regular_numbers(Scanner& in, std::span<Number> values) {
  const RegularNumbers read =
      read_regular_numbers(in.all().substr(static_cast<std::size_t>(in.byte())), values);
  const std::int64_t end = in.byte() + static_cast<std::int64_t>(read.bytes);
  if (read.has_returns)
    in.seek(end);
  else
    in.move_to(in.at(end, in.line() + read.lines));
  return read.count;
}

/// Counts the words of a text on all threads. Every byte ≤ 0x20 separates words.
std::size_t count_words(std::string_view text);

/// Reads the next records of a text on all threads, up to the first that is not regular. Each record has its
/// own lines. Returns how many records it read; the scanner is then after the last of them. The caller reads
/// the other records one by one, reports their errors and accepts unusual but valid records. So errors and
/// results are those of a reader that reads all records one by one.
///
/// The text is divided at line ends into parts; a record belongs to the part in which it begins. The lines
/// with words in each part are counted, which gives the first record of the next part.
///
/// @param in     its next word must be the first word of the first record
/// @param count  the most records to read, ≥ 0
/// @param read   `read(part, record)` takes the words of a record; returns false if the record is not
///              regular. `read` writes only data of the record, and may be called again for the same record.
///              A record is also not regular if `read` throws an InputError, if more words follow on its last
///              line, or if its number of lines is not `lines`
/// @param part_bytes  least size of a part, > 0
/// @param lines       number of lines of each record, > 0
/// @note O(bytes); memory: a few numbers for each part.
Index read_regular_records(Scanner& in, Index count, const std::function<bool(Scanner&, Index)>& read,
                           std::size_t part_bytes = std::size_t{1} << 20, Index lines = 1);

/// As `read_regular_records`, for records that may have no word: each line is a record. The scanner must be
/// at the beginning of a line of a text without comments; afterwards it is at the beginning of the line after
/// the last record.
Index read_regular_lines(Scanner& in, Index count, const std::function<bool(Scanner&, Index)>& read,
                         std::size_t part_bytes = std::size_t{1} << 20);

/// Reads all records of a text: regular records on all threads, all other records one by one.
///
/// @param read  `read(scanner, record)` takes the words of a record. It throws an InputError if the record is
///              faulty, and writes only data of the record: it may be called again for the same record
template <class Read>
void read_records(Scanner& in, Index count, const Read& read) {
  const Index regular = read_regular_records(in, count, [&](Scanner& part, Index record) {
    read(part, record);
    return true;
  });
  for (Index record = regular; record < count; ++record) read(in, record);
}

/// Reads records as `read_regular_records` does. A record is regular only if it begins with a number that is
/// one more than the number of the previous record. Reads nothing if one of `count` such numbers would be
/// outside of `least` … `most`. Adds the numbers to `numbering`, which must be empty.
template <class Read>
Index read_numbered_records(Scanner& in, Index count, IdMap& numbering, const Read& read,
                            std::int64_t least = -(std::int64_t{1} << 40),
                            std::int64_t most = std::int64_t{1} << 40) {
  std::int64_t first = 0;
  Scanner ahead = in;
  if (!ahead.take_number(first) || first < least || first > most - count) return 0;
  const Index regular = read_regular_records(in, count, [&](Scanner& part, Index record) {
    std::int64_t number = 0;
    return part.take_number(number) && number == first + record && read(part, record);
  });
  if (regular > 0) numbering.add_run(first, regular);
  return regular;
}

}  // namespace meshorder
