// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// Returns findings on the meshes, as sentences: verdicts, edge spans, simulated misses of the last level on
/// each processor and, in a study without scenarios, the measured kernels that gain and lose most.
std::vector<std::string> mesh_findings(const StudyResults& results);

}  // namespace meshorder
