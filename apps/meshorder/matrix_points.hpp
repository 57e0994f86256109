// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "command.hpp"
#include <meshorder/mesh.hpp>

#include <string>
#include <vector>

namespace meshorder::command {

/// Adds --points, which names a file.
void add_points_option(CLI::App& subcommand, std::string& points);

/// Returns the list {`name`} for a member of `Files`; an empty list for an empty name.
std::vector<std::string> named_files(const std::string& name);

/// Reads coordinates for the rows of a matrix or graph from a file (see `read_points`); does nothing for an
/// empty name. Throws InvalidArgument for a mesh, which has its own coordinates, and InputError for a faulty
/// file.
void take_points(Mesh& mesh, const std::string& input, const std::string& points);

/// Throws InvalidArgument if the mesh is a matrix or graph without coordinates and one of the methods needs
/// them.
void require_points(const Mesh& mesh, const std::string& input, const std::string& vertices,
                    const std::string& elements);

/// Throws InvalidArgument if the mesh is a matrix or graph without coordinates.
///
/// @param by      what needs the coordinates: "order 'hilbert'"
/// @param others  methods that need no coordinates
void require_coordinates(const Mesh& mesh, const std::string& input, const std::string& by,
                         const std::vector<std::string>& others);

}  // namespace meshorder::command
