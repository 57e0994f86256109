// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "lab/study/results.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace meshorder {

/// Returns the results as docs/results.schema.json describes them.
nlohmann::ordered_json to_json(const StudyResults& results);

/// Writes the file, completely or not at all. Throws Error if it cannot be written.
void write_results(const StudyResults& results, const FilePath& path);

/// Reads results that write_results wrote; their values are the same bit for bit. Throws Error, which names
/// the value, for values that are missing, unknown or out of range.
StudyResults read_results(const FilePath& path);

}  // namespace meshorder
