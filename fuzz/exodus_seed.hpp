// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/exodus/netcdf.hpp"

#include <filesystem>

namespace meshorder::fuzz {

/// Writes an Exodus II file of some kilobytes that has blocks, sets, sides, attributes, maps and variables of
/// all kinds, and two time steps. Files written from meshes of other formats lack most of these.
void write_exodus_seed(const std::filesystem::path& path, const exodus::Storage& storage);

}  // namespace meshorder::fuzz
