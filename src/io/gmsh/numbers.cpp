// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/gmsh/gmsh.hpp"
#include <meshorder/error.hpp>

#include <limits>

namespace meshorder::gmsh {
// ---- reading

IdMap number_ids(const NumberReader& source, const std::vector<std::int64_t>& ids, std::string_view what) {
  for (const std::int64_t id : ids) {
    if (id < 0)
      source.fail(std::string(what) + " " + std::to_string(id) + " has a negative number",
                  "numbers must be positive");
  }
  IdMap result;
  for (const std::int64_t id : ids) {
    if (!result.add(id))
      source.fail(std::string(what) + " " + std::to_string(id) + " is given twice",
                  "each needs a number of its own");
  }
  return result;
}

void expect_end(NumberReader& source, std::string_view section) {
  const std::string end = "$End" + std::string(section);
  const std::string_view word = source.scanner.peek_word();
  if (word.empty()) source.fail("unexpected end of file; expected " + end, "it may be cut short");
  if (word != end) {
    source.fail("$" + std::string(section) + " goes on; expected " + end, "is a count too small?");
  }
  (void)source.scanner.word(end);
}

// ---- writing

void NumberWriter::int32(std::int64_t value) {
  if (binary) {
    if (value > std::numeric_limits<std::int32_t>::max() ||
        value < std::numeric_limits<std::int32_t>::min()) {
      throw InputError(file, "the number " + std::to_string(value) + " does not fit in this binary file",
                       "give nodes and elements numbers below 2147483648");
    }
    out.binary(static_cast<std::int32_t>(value), order);
  } else {
    size(value);
  }
}

void NumberWriter::size(std::int64_t value) {
  if (binary) {
    out.binary(value, order);
  } else {
    out.integer(at_line_start ? "" : " ", value);
    at_line_start = false;
  }
}

void NumberWriter::real(double value) {
  if (binary) {
    out.binary(value, order);
  } else {
    out.real(at_line_start ? "" : " ", value);
    at_line_start = false;
  }
}

void NumberWriter::end_line() {
  if (!binary) out.write("\n");
  at_line_start = true;
}

}  // namespace meshorder::gmsh
