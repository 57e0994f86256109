// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <vector>

namespace meshorder::test {

/// The files of a mesh in memory, the main file first, and the notes of the writer.
struct Written {
  std::vector<MemoryFile> files = {};
  Notes notes = {};
};

/// Writes a mesh to memory as "a" with the format's first extension. Throws as `write_mesh_to_memory`.
Written written_as(const Mesh& mesh, const Format& format);

/// Reads what `written_as` wrote.
Mesh read_back(const std::vector<MemoryFile>& files, const Format& format);

}  // namespace meshorder::test
