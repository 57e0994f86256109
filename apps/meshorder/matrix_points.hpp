// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "command.hpp"
#include <meshorder/mesh.hpp>

#include <string>
#include <vector>

namespace meshorder::command {

/// Adds --points, the name of a file.
void add_points_option(CLI::App& subcommand, std::string& points);

/// Returns the file of that name as the list that `Files` takes; an empty name is none.
std::vector<std::string> named_files(const std::string& name);

/// Gives the rows of a matrix or graph the coordinates of a file (see `read_points`); an empty name gives
/// none. Throws CommandError for a mesh, which has its own, and InputError for a faulty file.
void take_points(Mesh& mesh, const std::string& input, const std::string& points);

/// Throws CommandError if the mesh is a matrix or graph without coordinates and one of the methods needs
/// them.
void require_points(const Mesh& mesh, const std::string& input, const std::string& vertices,
                    const std::string& elements);

}  // namespace meshorder::command
