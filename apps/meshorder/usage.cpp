// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "usage.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>

namespace meshorder::command {
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

/// Returns "; did you mean 'order'?" if one of the names is spelt or begins almost like `word`; else "".
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

/// The subcommand that the arguments name, as far as they were understood, and its words: "meshorder models".
struct Place {
  const CLI::App* command;
  std::string words;
};

Place place_of(const CLI::App& app) {
  Place place{&app, "meshorder"};
  while (!place.command->get_subcommands().empty()) {
    place.command = place.command->get_subcommands().front();
    place.words += " " + place.command->get_name();
  }
  return place;
}

/// Returns the names of the subcommands that the help shows.
std::vector<std::string> subcommands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* const subcommand : command.get_subcommands({})) {
    if (!subcommand->get_group().empty()) names.push_back(subcommand->get_name());
  }
  return names;
}

/// Returns the names of the options of a command and of those that it is part of.
std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* const option : app->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
  }
  return names;
}

/// Returns the first word that names an option which there is not, without its value; "" if there is none.
std::string unknown_option(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word == "--") break;
    if (word.size() > 1 && word.starts_with('-')) return word.substr(0, word.find('='));
  }
  return "";
}

}  // namespace

std::vector<std::string> with_words_as_options(std::vector<std::string> arguments) {
  if (arguments.empty()) return arguments;
  if (arguments.front() == "version") arguments.front() = "--version";
  if (arguments.front() == "help") {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  return arguments;
}

std::optional<std::string> unknown_command(const CLI::App& app) {
  const Place place = place_of(app);
  const std::vector<std::string> names = subcommands_of(*place.command);
  const std::vector<std::string> words = app.remaining(true);
  if (names.empty() || words.empty() || words.front().starts_with('-')) return std::nullopt;
  const std::string nearest = suggestion(words.front(), names);
  return "unknown command '" + words.front() + "'" +
         (nearest.empty() ? "; see " + place.words + " --help" : nearest);
}

std::string usage_fault(const CLI::App& app, const CLI::ParseError& error) {
  if (std::optional<std::string> fault = unknown_command(app)) return *std::move(fault);
  const Place place = place_of(app);
  const std::string help = "see " + place.words + " --help";
  const std::vector<std::string> words = app.remaining(true);
  const std::string option = unknown_option(words);
  if (!option.empty()) {
    const std::vector<std::string> known = options_of(*place.command);
    if (std::find(known.begin(), known.end(), option) != known.end()) {
      return "'" + option + "' stands before the command; write " + place.words + " " + option;
    }
    const std::string nearest = suggestion(option, known);
    return "unknown option '" + option + "'" + (nearest.empty() ? "; " : nearest + " ") + help;
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !words.empty())
    return "unexpected argument '" + words.front() + "'; " + help;
  return std::string(error.what()) + "; " + help;
}

}  // namespace meshorder::command
