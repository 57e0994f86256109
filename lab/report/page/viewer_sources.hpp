// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshorder {

/// The files of viewer/, and three.js with its licence, built into the program.
struct ViewerSources {
  std::string_view page;        ///< page.html, with its placeholders
  std::string_view comparison;  ///< comparison.html, with its placeholders
  std::string_view style;       ///< style.css
  std::string_view scripts;     ///< all *.js, in the order of their names
  std::string_view three;
};

const ViewerSources& viewer_sources();

}  // namespace meshorder
