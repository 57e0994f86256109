// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace meshorder {

/// One file of a collection.
struct PvdEntry {
  double time = 0;   ///< s
  std::string file;  ///< its path, relative to the collection's folder
};

/// Writes ParaView's collection of the files that show one thing at several times (.pvd): ParaView opens it
/// as an animation. It appears whole or not at all. Throws Error when it cannot be written, InvalidArgument
/// for a time that is not finite. O(entries).
/// https://www.paraview.org/Wiki/ParaView/Data_formats
void write_pvd(std::span<const PvdEntry> entries, const std::filesystem::path& path);

}  // namespace meshorder
