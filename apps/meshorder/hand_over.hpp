// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace meshorder::command {

/// If another program beside this one does the work, executes that program with the same arguments and does
/// not return. This is `meshorder-mpi` if `mpirun` or `srun` started several processes of this program
/// together, or if `order` has an option of parts; it is `meshorder-lab` for a subcommand of the laboratory.
///
/// @param arguments  those of `main`
/// @return exit status if the other program does not exist, which the first process then reports; nothing if
///         this program does the work
std::optional<int> hand_over(char** arguments) noexcept;

/// Returns whether `meshorder-lab` is beside this program.
bool has_lab();

}  // namespace meshorder::command
