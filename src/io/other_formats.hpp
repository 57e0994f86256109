// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshorder {

/// A format of other programs that meshorder does not read.
struct OtherFormat {
  std::string_view extension;  ///< with dot, lower case
  std::string_view what;       ///< "holds VTK's PolyData"
  std::string_view advice;     ///< how to make a mesh of it that meshorder reads
};

/// Returns the format of files with this extension in lower case, null if it is not known.
const OtherFormat* other_format(std::string_view extension);

}  // namespace meshorder
