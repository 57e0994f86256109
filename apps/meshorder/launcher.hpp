// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::command {

/// Returns whether `mpirun` or `srun` started this process together with others, as the variables of the
/// environment say. A batch script's variables alone are no such start.
bool is_one_of_several();

/// Returns whether this process is the first of those that were started together, or the only one.
bool is_first_process();

}  // namespace meshorder::command
