// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace meshorder {

/// Returns "; did you mean 'order'?" if one of the names is spelt or begins almost like `word`; else "".
std::string suggestion(const std::string& word, const std::vector<std::string>& names);

}  // namespace meshorder
