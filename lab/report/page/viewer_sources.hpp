// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshorder {

/// The files of viewer/, and three.js with its licence, as they were when the program was built; it needs
/// none of them when it runs.
struct ViewerSources {
  std::string_view page;     ///< page.html, with its placeholders
  std::string_view style;    ///< style.css
  std::string_view scripts;  ///< all *.js, by their names' order
  std::string_view three;
};

const ViewerSources& viewer_sources();

}  // namespace meshorder
