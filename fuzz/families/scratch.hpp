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

/// Writes a file to this process's scratch folder and returns its path, for readers that take a path. The
/// folder is in the system's folder for temporary files, and is removed at the end of the process.
std::filesystem::path scratch_file(const std::string& name, std::string_view content);

/// Returns the result of `read()`; empty if `read` throws InputError.
template <class Read>
auto accepted(const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace meshorder::fuzz
