// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "help_format.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <istream>
#include <sstream>
#include <string>

namespace meshorder::command {
namespace {

constexpr std::size_t kColumns = 100;

/// Reads a word; words in backquotes count as one. Returns whether there was one.
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

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_format() { return std::make_shared<HelpFormat>(); }

}  // namespace meshorder::command
