// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "fuzz/family.hpp"

#include <span>
#include <string>
#include <string_view>

namespace meshorder::fuzz {

/// A family of mesh files.
struct MeshFamily {
  std::string_view name;
  std::string_view file;  ///< name of the first file; its extension is that of the format
  std::string (*mutate)(std::string input, std::uint32_t seed) = nullptr;
  bool by_library = false;  ///< see Family::by_library
};

/// Returns the families of the formats that this build has.
std::span<const MeshFamily> mesh_families();

/// Checks the files that the input stands for (see `input_files` and `check_mesh_files`).
void check_mesh_family(std::string_view family, Family::Bytes input);

}  // namespace meshorder::fuzz
