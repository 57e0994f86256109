// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>

namespace meshorder {

/// Returns as HTML how much faster each mesh is in the order that `meshorder order` makes: a number if it is
/// certain; the verdict; and for each kernel two bars, its times in the mesh's own order and in that order.
/// Empty for a study with scenarios. Leaves out meshes that have neither a verdict nor times.
std::string headlines_of(const StudyResults& results);

}  // namespace meshorder
