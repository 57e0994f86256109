// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder {

/// Returns the bytes that a gzip file decompresses to; returns the bytes of any other file unchanged.
///
/// @param bytes  all bytes of a file
/// @param file   its path, for errors
/// @throws InputError for a damaged or truncated gzip file, and if the file expands beyond the limit of
/// `claim_memory`
/// @throws Unavailable for a gzip file in a build without zlib
std::string uncompressed(std::string bytes, const std::string& file);

/// As `uncompressed`, for the first bytes of a file, to find out what the file holds. Returns at most 1 MiB
/// of decompressed bytes. Throws Unavailable as `uncompressed` does.
std::string uncompressed_start(std::string bytes, const std::string& file);

}  // namespace meshorder
