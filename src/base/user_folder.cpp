// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/user_folder.hpp"

#include <cstdlib>

namespace meshorder {
namespace fs = std::filesystem;

namespace {

/// Returns the folder in an environment variable; empty if unset or relative, which the XDG standard calls
/// invalid.
fs::path folder_in(const char* variable) {
  const char* const value = std::getenv(variable);
  fs::path folder = value != nullptr ? value : "";
  return folder.is_absolute() ? folder : fs::path();
}

}  // namespace

fs::path user_cache_folder() {
  const char* const own = std::getenv("MESHORDER_CACHE");
  if (own != nullptr && *own != '\0') return fs::absolute(own);
  if (const fs::path folder = folder_in("XDG_CACHE_HOME"); !folder.empty()) return folder / "meshorder";
  if (const fs::path home = folder_in("HOME"); !home.empty()) return home / ".cache/meshorder";
  return {};
}

}  // namespace meshorder
