// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"
#include "payoff/access_stream.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <string>

namespace meshorder::command {

/// --cache, for parse_caches.
CLI::Option* add_cache_option(CLI::App& subcommand, std::string& caches);

/// Predicting takes a few seconds for so many simplices, and 13 bytes for each line that a kernel touches.
inline constexpr Offset kMostPredicted = 2'000'000;

/// Whether the mesh has no more than that.
bool is_quick_to_predict(const Mesh& mesh);

/// {"spmv": {"accesses", "misses": […], "jumps": […], "mean_log2"}, …}, misses and jumps level by level
nlohmann::ordered_json to_json(const KernelReuse& reuse, const Caches& caches);

/// What `reuse_cells` shows, in two lines: the kernels, and for each its mean log2 of reuse distances and its
/// misses in each level, and those jumps among the last level's. `left` is how wide the columns before them
/// are.
std::string reuse_header(const Caches& caches, int left);

/// One row of the table: "14.6  1.09M   954k   681k  20.1k" for each kernel.
std::string reuse_cells(const KernelReuse& reuse, const Caches& caches);

}  // namespace meshorder::command
