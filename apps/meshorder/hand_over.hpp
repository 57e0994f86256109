// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace meshorder::command {

/// Where this process is one of several that `mpirun` or `srun` started together, or `order` is given an
/// option of parts, executes `meshorder-mpi` from beside this program with the same arguments, and does not
/// return.
///
/// @param arguments  as of `main`
/// @return exit status where there is no such program, which the first process has said; nothing where this
///         program does the work
std::optional<int> hand_over_to_mpi(char** arguments) noexcept;

}  // namespace meshorder::command
