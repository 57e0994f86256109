// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshorder {

/// Returns the git revision that this program was built from: the commit, and after a '+' a checksum of what
/// was changed since. Empty for a build without git, as from a tarball. Only the source of this function
/// changes with the revision: no other source is compiled again.
std::string_view build_revision();

}  // namespace meshorder
