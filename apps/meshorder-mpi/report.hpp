// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "distributed/order/order.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <vector>

namespace meshorder::command {

/// Returns the most memory that this process has had so far, in bytes; 0 where the system does not say.
std::int64_t peak_memory();

/// Prints what is reported of an order, besides the files.
void print_report(const Console& console, const distributed::DistributedOptions& options,
                  const distributed::DistributedReport& report, const std::vector<std::int64_t>& peaks);

/// Returns {"ranks", "parts", "partition", "edge_span", "memory_bytes", "seconds"}.
nlohmann::ordered_json to_json(const distributed::DistributedOptions& options,
                               const distributed::DistributedReport& report,
                               const std::vector<std::int64_t>& peaks);

}  // namespace meshorder::command
