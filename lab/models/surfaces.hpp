// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::models {

/// Runs a program that the model `model` needs. Throws Error, naming the Debian package to install, when it
/// is not there, and with its last line when it fails. Its output goes to `folder/log`.
void run_tool(std::string_view model, std::string_view program, const std::vector<std::string>& arguments,
              const std::filesystem::path& folder);

/// Throws Error when one of the programs is not installed, before time is spent on the others.
void require_tools(std::string_view model, const std::vector<std::string_view>& programs);

/// Where a surface of CGAL's examples is kept, "armadillo.off"; there may be no file yet.
std::filesystem::path surface_file(std::string_view surface);

/// Downloads Debian's package of CGAL's examples and keeps the surfaces of all models. Throws Error when a
/// program is missing or fails, and when there is no network.
void fetch_surfaces(std::string_view model);

}  // namespace meshorder::models
