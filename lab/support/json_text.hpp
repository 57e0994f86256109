// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace meshorder {

/// JSON for people and for version control: what is short, and every list of numbers, stands in one line;
/// the rest is indented. Doubles read back to the same bits. Ends with a line break. O(size · depth).
std::string json_text(const nlohmann::ordered_json& json);

/// Writes that to a file, whole or not at all. Throws Error when it cannot be written.
void write_json(const nlohmann::ordered_json& json, const std::filesystem::path& path);

}  // namespace meshorder
