// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshorder {

/// Returns the git revision that this program was built from: the commit, and after a '+' a checksum of what
/// was changed since. Empty for a build without git, as from a tarball. The only source that changes with the
/// revision is the one of this function, so that all others are compiled, and found by ccache, as before.
std::string_view build_revision();

}  // namespace meshorder
