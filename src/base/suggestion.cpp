// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/suggestion.hpp"

#include "base/text.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>

namespace meshorder {
namespace {

/// Returns the word in lower case without leading dashes.
std::string bare(const std::string& word) {
  std::string letters = word.substr(std::min(word.find_first_not_of('-'), word.size()));
  std::transform(letters.begin(), letters.end(), letters.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return letters;
}

/// Returns the least number of insertions, deletions, replacements and exchanges of adjacent letters that
/// turn one word into the other (Damerau and Levenshtein; no letter is changed twice).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> rows(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) rows[i][0] = i;
  std::iota(rows[0].begin(), rows[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = rows[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      rows[i][j] = std::min({replaced, rows[i][j - 1] + 1, rows[i - 1][j] + 1});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
    }
  }
  return rows[a.size()][b.size()];
}

/// Returns whether the words begin with the same letters: three or more, and all but at most two of `word`.
bool begin_alike(const std::string& word, const std::string& name) {
  constexpr std::size_t kShortestBeginning = 3;
  const auto differ = std::mismatch(word.begin(), word.end(), name.begin(), name.end()).first;
  const auto same = static_cast<std::size_t>(differ - word.begin());
  return same >= kShortestBeginning && same + 2 >= word.size();
}

}  // namespace

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  const std::string letters = bare(word);
  std::size_t least = std::min<std::size_t>(2, (letters.size() + 1) / 3) + 1;
  std::string nearest;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(letters, bare(name));
    if (distance < least) {
      least = distance;
      nearest = name;
    } else if (nearest.empty() && begin_alike(letters, bare(name))) {
      nearest = name;
    }
  }
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

std::string unknown_in_words(std::string_view kind, const std::string& word,
                             const std::vector<std::string>& names) {
  const std::string nearest = suggestion(word, names);
  return "unknown " + std::string(kind) + " '" + word + "'" +
         (nearest.empty() ? "; known are " + join(names) : nearest);
}

}  // namespace meshorder
