// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class FormatterBase;
}  // namespace CLI

namespace meshorder::command {

/// Returns the layout of the help: descriptions are wrapped so that no line is longer than 100 columns.
std::shared_ptr<CLI::FormatterBase> help_format();

}  // namespace meshorder::command
