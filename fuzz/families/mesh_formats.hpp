// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

namespace meshorder::fuzz {

/// A family of mesh files.
struct MeshFamily {
  std::string_view name;
  std::string_view file;    ///< name of the first file; its extension is that of the format
  bool by_library = false;  ///< see Family::by_library
};

/// Returns the families of the formats that this build has.
std::span<const MeshFamily> mesh_families();

}  // namespace meshorder::fuzz
