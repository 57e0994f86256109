// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/io.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace meshorder::fuzz {

/// Checks the promises about a mesh file, and aborts with a message if a promise is broken:
/// - Reading the file gives an error of one line or a mesh that `check_mesh` accepts.
/// - That mesh, reordered, is the same after it is written and read.
/// - Written in another format that can hold its cells (one input in four), the mesh has the same cells.
void check_mesh_files(std::string_view format, const std::vector<MemoryFile>& files);

}  // namespace meshorder::fuzz
