// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace meshorder::command {

/// A subcommand of `meshorder-lab`, also in the help of `meshorder`, which runs `meshorder-lab` for it.
struct LabCommand {
  const char* name;
  const char* description;
};

/// The subcommands in the order of the help.
inline constexpr std::array kLabCommands{
    LabCommand{"simulate",
               "Simulate a scenario, an elastic body or water, on a mesh in a given order, and time it."},
    LabCommand{"reproduce",
               "Repeat the paper's study on this machine: six scenarios and a fluid, in the paper's five\n"
               "orders and in that of `meshorder order`. Writes tables and a page."},
    LabCommand{
        "report",
        "Write a page for the browser. It shows meshes coloured by their order, edge spans, cache misses\n"
        "and times of kernels. The page is one file and needs no network."},
    LabCommand{"models", "Make example meshes: the paper's bodies, and grids, balls and tori of any size."},
};

}  // namespace meshorder::command
