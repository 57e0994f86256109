// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder {

/// Returns the decompressed bytes if they are a gzip file, else the bytes as they are.
///
/// @param bytes  all bytes of a file
/// @param file   its path, for errors
/// @throws InputError for a damaged or truncated gzip file, and if the file expands beyond the limit of
/// `claim_memory`
/// @throws Unavailable for a gzip file in a build without zlib
std::string uncompressed(std::string bytes, const std::string& file);

/// Returns the first bytes of a file as they are; for a gzip file, the bytes that can be decompressed from
/// them, at most 1 MiB. Used to find out what a file holds. Throws Unavailable as `uncompressed` does.
std::string uncompressed_start(std::string bytes, const std::string& file);

}  // namespace meshorder
