// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace meshorder {

/// Returns the folder for files that can be remade: `$MESHORDER_CACHE`, `$XDG_CACHE_HOME/meshorder` or
/// `~/.cache/meshorder`, the first that is set; empty if none of the variables is. It need not exist.
std::filesystem::path user_cache_folder();

}  // namespace meshorder
