// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace meshorder::command {

/// Where this process is one of several that `mpirun` or `srun` started together, executes `meshorder-mpi`
/// from beside this program with the same arguments, and does not return. A batch script's variables alone
/// are no such start.
///
/// @param arguments  as of `main`
/// @return exit status where there is no such program, which the first rank has said; nothing for a process
///         of its own
std::optional<int> hand_over_to_mpi(char** arguments) noexcept;

}  // namespace meshorder::command
