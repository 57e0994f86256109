// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace meshorder {

/// Returns the folder for what can be made anew: `$MESHORDER_CACHE`, else `$XDG_CACHE_HOME/meshorder`, else
/// `~/.cache/meshorder`; empty if none of the variables is set. It need not exist.
std::filesystem::path user_cache_folder();

}  // namespace meshorder
