// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/io.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace meshorder::fuzz {

/// Checks what is promised of a mesh file: reading it gives an error of one line or a mesh that `check_mesh`
/// accepts; that mesh, with vertices and cells moved, is the same after it was written and read; written in
/// another format that holds its cells, it has the same cells. Aborts with a message otherwise.
void check_mesh_files(std::string_view format, const std::vector<MemoryFile>& files);

}  // namespace meshorder::fuzz
