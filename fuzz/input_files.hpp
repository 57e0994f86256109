// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/io.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace meshorder::fuzz {

/// Splits an input into its files: the first has the name `first`; each other follows a line "%%file NAME".
/// An input without such lines is one file.
std::vector<MemoryFile> input_files(std::string_view input, const std::string& first);

/// Joins files to an input; the inverse of `input_files`.
std::string input_of(const std::vector<MemoryFile>& files);

/// Returns the bytes of the file of that name; an empty text if there is no such file.
std::string bytes_of(const std::vector<MemoryFile>& files, std::string_view name);

}  // namespace meshorder::fuzz
