// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder {

/// Returns the bytes as they are, or what is in them if they are a gzip file.
///
/// @param bytes  all bytes of a file
/// @param file   its path, for errors
/// @throws InputError for a damaged or truncated gzip file, and for one that expands beyond the limit of
///         `claim_memory`
/// @throws Unavailable for a gzip file in a build without zlib
std::string uncompressed(std::string bytes, const std::string& file);

/// Returns the first bytes as they are, or what begins in them if they are those of a gzip file: at most 1
/// MiB, as far as it can be decoded. To find out what a file holds; throws Unavailable likewise.
std::string uncompressed_start(std::string bytes, const std::string& file);

}  // namespace meshorder
