// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>

namespace meshorder {

/// What the paper's two orders, Fiedler and VF Fiedler, save over vertices scrambled in its scenarios, beside
/// what it reports. Empty unless the study has one of them and that reference.
std::string headline(const StudyResults& results);

/// What the VF Fiedler order saves over vertices and elements both scrambled, which the paper does not
/// compare. Empty unless the study has both.
std::string against_all_scrambled(const StudyResults& results);

}  // namespace meshorder
