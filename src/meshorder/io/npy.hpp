// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace meshorder {

/// Writes a one-dimensional NumPy array (format 1.0, little endian): `numpy.load` reads it. Throws Error when
/// the target cannot be written; nothing is left behind then.
void write_npy(std::span<const std::int32_t> values, const std::filesystem::path& path);
void write_npy(std::span<const std::int64_t> values, const std::filesystem::path& path);

/// Reads a one-dimensional NumPy array of 32- or 64-bit integers, signed or not. Throws Error, with the byte,
/// for anything else.
std::vector<std::int64_t> read_npy(const std::filesystem::path& path);

}  // namespace meshorder
