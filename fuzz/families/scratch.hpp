// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "fuzz/family.hpp"
#include <meshorder/error.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace meshorder::fuzz {

/// Returns the bytes as text.
inline std::string_view text_of(Family::Bytes input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// Writes a file of that name to the folder of this process for what is read by its path; returns its path.
/// The folder lies in that for temporary files, and is removed at the end of the process.
std::filesystem::path scratch_file(const std::string& name, std::string_view content);

/// Returns what `read()` returns; nothing where it refuses a file by an InputError.
template <class Read>
auto accepted(const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace meshorder::fuzz
