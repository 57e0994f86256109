// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/cache.hpp"
#include "payoff/access_stream.hpp"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <string_view>

namespace meshorder::command {

/// Returns {"spmv": {"accesses", "misses": […], "jumps": […], "mean_log2"}, …} for these kernels, which are
/// the first of kKernels. Misses and jumps have a number for each cache level.
nlohmann::ordered_json to_json(const KernelReuse& reuse, const Caches& caches,
                               std::span<const Kernel> kernels = kKernels);

/// Explanation of the columns of reuse_header.
inline constexpr std::string_view kReuseLegend =
    "log2: mean log2 of the reuse distances; a cache's size: its misses; jumps: misses of the last\n"
    "level that hardware prefetchers do not predict";

/// Title of the product with a matrix in tables; matrices have no other kernel.
inline constexpr std::string_view kProduct = "product";

/// Returns the heads of the columns of reuse_cells: "log2", the caches, "jumps".
std::string reuse_header(const Caches& caches);

/// Returns the cells of a kernel: "14.6  1.09M   954k   681k  20.1k".
std::string reuse_cells(const Reuse& of_kernel, const Caches& caches);

}  // namespace meshorder::command
