// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/error.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace meshorder {

/// The beginning and the greatest size in bytes of a pointer of Git LFS, which stands for a file.
inline constexpr std::string_view kLfsPointer = "version https://git-lfs.github.com/spec/";
inline constexpr std::size_t kLongestLfsPointer = 1024;

/// Throws InputError if a file begins like a pointer of Git LFS.
inline void refuse_lfs_pointer(std::string_view beginning, const std::string& name) {
  if (beginning.starts_with(kLfsPointer))
    throw InputError(name, "is a pointer of Git LFS, not the file", "get the file by `git lfs pull`");
}

}  // namespace meshorder
