// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/descriptor.hpp"
#include "io/stream/file_path.hpp"

#include <filesystem>

namespace meshorder {

/// Where the bytes of an output go.
struct OutputPlace {
  std::filesystem::path path;  ///< with all symbolic links followed
  bool exists = false;
  bool is_through = false;   ///< a device, a pipe or an open file of this process: cannot be replaced
  int own_descriptor = -1;   ///< of an open file of this process, such as /dev/stdout; else −1
  unsigned other_names = 0;  ///< hard links besides this path
};

/// Returns the folder of a path, "." for a plain name.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// Returns where a path leads, with all symbolic links followed. Throws InputError for a folder, for links in
/// a circle, for a path that the system refuses, and for a link of another user in a folder open to all. If
/// this program named the file or a part of its path, also throws for a link in that part, a device or a
/// pipe.
OutputPlace output_place(const FilePath& file);

/// Gives an open file the owner, the group, the mode, the ACLs and the other extended attributes of the file
/// that it is to replace, as far as the system allows. If the group cannot be kept, the file's new group gets
/// no more access than all others have. Returns 0 or an `errno`.
[[nodiscard]] int copy_attributes(const std::filesystem::path& from, const Descriptor& to);

}  // namespace meshorder
