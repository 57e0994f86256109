// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace meshorder {

/// Keys as docs/results.schema.json has them.
nlohmann::ordered_json to_json(const StudyResults& results);

/// Writes the file whole or not at all. Throws Error when it cannot be written.
void write_results(const StudyResults& results, const std::filesystem::path& path);

/// Reads what write_results wrote: the same to the last bit. Throws Error that names the place in the file
/// for whatever is missing, unknown or out of range.
StudyResults read_results(const std::filesystem::path& path);

}  // namespace meshorder
