// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::models {

/// Runs a program that a model needs; its output goes to `folder/log`. Throws Error with the Debian package
/// to install if the program is missing, and with its last line of output if it fails.
void run_tool(std::string_view model, std::string_view program, const std::vector<std::string>& arguments,
              const std::filesystem::path& folder);

/// Throws Error if one of the programs is not installed.
void require_tools(std::string_view model, const std::vector<std::string_view>& programs);

/// Returns the path of a surface of CGAL's examples, "armadillo.off"; the file may not exist yet.
std::filesystem::path surface_file(std::string_view surface);

/// Downloads Debian's package of CGAL's examples and stores the surfaces of all models. Throws Error if a
/// program is missing or fails, or if there is no network.
void fetch_surfaces(std::string_view model);

}  // namespace meshorder::models
