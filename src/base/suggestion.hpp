// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Returns "; did you mean 'order'?" if one of the names is spelt or begins almost like `word`; else "".
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

/// Returns "unknown use 'spring'; did you mean 'springs'?", or "unknown use 'a'; known are …" if no name is
/// near.
std::string unknown_in_words(std::string_view kind, const std::string& word,
                             const std::vector<std::string>& names);

}  // namespace meshorder
