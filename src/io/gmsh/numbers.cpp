// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/gmsh/gmsh.hpp"

#include <fmt/format.h>

namespace meshorder::gmsh {
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

void expect_end(ReadContext& reading, std::string_view section) {
  NumberReader& source = reading.source;
  const std::string end = fmt::format("{}{}", reading.metadata.is_version_1() ? "$END" : "$End", section);
  const std::string_view word = source.scanner.peek_word();
  const std::string_view all = source.scanner.all();
  const bool is_cut = word.size() < end.size() && word.data() + word.size() == all.data() + all.size();
  if (word.empty() || is_cut) source.fail("unexpected end of file; expected " + end, "it may be cut short");
  if (word != end && word != fmt::format("$End{}", section)) {
    const std::string found = shown(word);
    if (word.front() == '$' && !same_but_for_case(word.substr(0, 4), "$End")) {
      source.fail(fmt::format("expected {}, found {}", end, found), "end the section before the next one");
    }
    if (word.front() != '$') {
      source.fail(fmt::format("${} continues; expected {}", section, end), "is a count too small?");
    }
    reading.notes.push_back(fmt::format("{}:{}: {} is read as {}; Gmsh itself skips the text after it",
                                        source.scanner.file(), source.scanner.line(), found, end));
  }
  (void)source.scanner.word(end);
}

}  // namespace meshorder::gmsh
