// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder::command {

/// Returns whether `mpirun` or `srun` started this process, according to environment variables.
bool is_started_as_rank();

/// Returns whether `mpirun` or `srun` started this process together with others, according to environment
/// variables. Variables that only describe a batch script do not count.
bool is_one_of_several();

/// Returns whether this process is the first of those started together, or the only one.
bool is_first_process();

}  // namespace meshorder::command
