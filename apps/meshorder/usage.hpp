// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
class FormatterBase;
class ParseError;
}  // namespace CLI

namespace meshorder::command {

/// Returns what is wrong with an argument like `--maps=`, for which the parser would take the next argument
/// as the value; nothing if there is no such argument.
std::optional<std::string> option_without_value(const std::vector<std::string>& arguments);

/// Returns the arguments with `help WORDS…` and `version` replaced by the equivalent options.
std::vector<std::string> with_words_as_options(std::vector<std::string> arguments);

/// Makes the options of a command and of its subcommands refuse an empty text: it usually comes from an unset
/// variable of a script.
void refuse_empty_values(CLI::App& command);

/// Returns "unknown command 'ordr'; did you mean 'order'?" if the parsed arguments name a command that does
/// not exist.
std::optional<std::string> unknown_command(const CLI::App& app);

/// Returns what is wrong with the parsed arguments and which help to read. Looks first for known faults, such
/// as an unknown command or option, and names the nearest known one; else returns the parser's own error.
std::string usage_fault(const CLI::App& app, const CLI::ParseError& error);

/// Returns the layout of the help: descriptions are wrapped so that no line is longer than 100 columns.
std::shared_ptr<CLI::FormatterBase> help_format();

}  // namespace meshorder::command
