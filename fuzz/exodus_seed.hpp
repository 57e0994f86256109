// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/exodus/netcdf.hpp"

#include <filesystem>

namespace meshorder::fuzz {

/// Writes a file of Exodus II of some kilobytes with blocks, sets, sides, attributes, maps and variables of
/// all kinds in two steps. Files written from meshes of other formats lack most of these.
void write_exodus_seed(const std::filesystem::path& path, const exodus::Storage& storage);

}  // namespace meshorder::fuzz
