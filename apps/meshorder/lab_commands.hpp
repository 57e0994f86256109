// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace meshorder::command {

/// A subcommand of `meshorder-lab`. `meshorder` shows it in its help and executes that program for it.
struct LabCommand {
  const char* name;
  const char* description;
};

/// The subcommands in the order of the help.
inline constexpr std::array kLabCommands{
    LabCommand{"simulate",
               "Simulate an elastic body or water as a scenario describes, in a given order, and time it."},
    LabCommand{"reproduce",
               "Repeat the paper's study on this machine: six scenarios and a fluid, in the paper's five\n"
               "orders and in that of `meshorder order`; writes tables and a page."},
    LabCommand{
        "report",
        "Write a page for the browser: meshes, coloured by their order; spans, caches, kernels, tables.\n"
        "The page is one file and needs no network."},
    LabCommand{"models",
               "Make meshes to try things on: the paper's bodies, and grids, balls and tori of any size."},
};

}  // namespace meshorder::command
