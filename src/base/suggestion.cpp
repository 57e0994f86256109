// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/suggestion.hpp"

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

/// Returns the number of letters to insert, delete or replace that turn one word into the other
/// (Levenshtein).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

/// Returns whether the words are the same at their beginning, but for at most two letters of `word`.
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

}  // namespace meshorder
