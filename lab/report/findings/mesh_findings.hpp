// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// What is known of the meshes without simulating anything, in sentences: verdicts, edge spans, where
/// simulated misses of the last level differ between the processors, and in a study without scenarios the
/// kernels that gain and lose most by the clock.
std::vector<std::string> mesh_findings(const StudyResults& results);

}  // namespace meshorder
