// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "usage.hpp"

#include "base/text.hpp"
#include "wording.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <istream>
#include <sstream>
#include <string>

namespace meshorder::command {
namespace {

constexpr std::size_t kColumns = 100;

/// Reads a word; words in backquotes count as one. Returns whether there was a word.
bool next_word(std::istream& text, std::string& word) {
  if (!(text >> word)) return false;
  for (std::string next; std::count(word.begin(), word.end(), '`') % 2 == 1 && text >> next;)
    word += ' ' + next;
  return true;
}

/// Returns the text in lines of at most `width` characters.
std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string lines;
  std::size_t length = 0;
  for (std::string word; next_word(words, word); length += word.size()) {
    if (length > 0) {
      const bool fits = length + 1 + word.size() <= width;
      lines += fits ? ' ' : '\n';
      length = fits ? length + 1 : 0;
    }
    lines += word;
  }
  return lines;
}

class HelpFormat : public CLI::Formatter {
 public:
  /// Adds the program that `try` runs, which is not among its options.
  std::string make_usage(const CLI::App* app, std::string name) const override {
    std::string usage = CLI::Formatter::make_usage(app, name);
    if (app->get_name() == "try") usage.insert(usage.find_last_not_of('\n') + 1, " -- PROGRAM ARGUMENTS...");
    return usage;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(CLI::Formatter::make_option_desc(option), width());
  }
  std::string make_subcommand(const CLI::App* subcommand) const override {
    std::stringstream entry;
    CLI::detail::format_help(entry, subcommand->get_name(), wrapped(subcommand->get_description(), width()),
                             get_column_width());
    return entry.str();
  }

 private:
  [[nodiscard]] std::size_t width() const { return kColumns - get_column_width(); }
};

/// The innermost subcommand that was parsed, and the words to write for it: "meshorder models".
struct Place {
  const CLI::App* command;
  std::string words;
};

Place place_of(const CLI::App& app) {
  Place place{&app, app.get_name()};
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

/// Returns the names of the options of a command and of its parents.
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

/// Returns the first left-over word that looks like an option, without its value; "" if there is none.
std::string unknown_option(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word == "--") break;
    if (word.size() > 1 && word.starts_with('-')) return word.substr(0, word.find('='));
  }
  return "";
}

/// Returns the words to type after `order` if the user named a mesh but no output: "part.msh -o
/// ordered-part.msh". A single superfluous argument in `words` becomes the output.
std::optional<std::string> line_with_output(const CLI::App& command, const std::vector<std::string>& words) {
  const CLI::Option* const mesh = command.get_option_no_throw("MESH");
  const CLI::Option* const output = command.get_option_no_throw("--output");
  if (command.get_name() != "order" || mesh == nullptr || output == nullptr) return std::nullopt;
  if (mesh->results().size() != 1 || mesh->results().front().empty() || !output->empty()) return std::nullopt;
  const std::string& name = mesh->results().front();
  const bool names_output = words.size() == 1 && !words.front().empty() && !words.front().starts_with('-');
  return in_shell(name) + " -o " + in_shell(names_output ? words.front() : ordered_name(name));
}

/// Returns an error message if `try` is given a program without -- before it.
std::optional<std::string> program_without_mark(const Place& place, const std::vector<std::string>& words) {
  if (place.command->get_name() != "try" || words.empty() || words.front().starts_with('-'))
    return std::nullopt;
  const CLI::Option* const mesh = place.command->get_option_no_throw("MESH");
  std::string line = place.words;
  if (mesh != nullptr && !mesh->empty()) line += " " + in_shell(mesh->results().front());
  return "unexpected argument '" + words.front() + "': -- must come before the program; write " + line +
         " -- " + in_shell(words.front()) + " …";
}

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_format() { return std::make_shared<HelpFormat>(); }

std::vector<std::string> with_words_as_options(std::vector<std::string> arguments) {
  if (arguments.empty()) return arguments;
  if (arguments.front() == "version") arguments.front() = "--version";
  if (arguments.front() == "help") {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  return arguments;
}

std::optional<std::string> option_without_value(const std::vector<std::string>& arguments) {
  const auto found = std::find_if(arguments.begin(), arguments.end(), [](const std::string& argument) {
    return argument.starts_with("--") && argument.find('=') == argument.size() - 1;
  });
  if (found == arguments.end()) return std::nullopt;
  return *found + " has no value; give one right after the =";
}

void refuse_empty_values(CLI::App& command) {
  const CLI::Validator not_empty(
      [](const std::string& text) {
        return text.empty() ? std::string("the value is empty") : std::string();
      },
      "");
  for (CLI::Option* const option : command.get_options()) {
    if (option->get_items_expected_min() > 0) option->check(not_empty);
  }
  for (CLI::App* const subcommand : command.get_subcommands({})) refuse_empty_values(*subcommand);
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
  if (std::optional<std::string> fault = program_without_mark(place, words)) return *std::move(fault);
  const std::string option = unknown_option(words);
  if (!option.empty()) {
    const std::vector<std::string> known = options_of(*place.command);
    if (std::find(known.begin(), known.end(), option) != known.end()) {
      return "'" + option + "' comes before the command; write " + place.words + " " + option;
    }
    const std::string nearest = suggestion(option, known);
    return "unknown option '" + option + "'" + (nearest.empty() ? "; " : nearest + " ") + help;
  }
  const bool lacks_something = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (const auto line = line_with_output(*place.command, words); lacks_something && line)
    return "there is no output; write " + place.words + " " + *line;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !words.empty())
    return "unexpected argument '" + words.front() + "'; " + help;
  return std::string(error.what()) + "; " + help;
}

}  // namespace meshorder::command
