// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "distributed/order/order.hpp"
#include "mesh/stored_matrix.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <vector>

namespace meshorder::command {

/// Returns the peak memory of this process so far, in bytes; 0 if the system does not report it.
std::int64_t peak_memory();

/// Prints the report on an order, without the files.
///
/// @param stored  null if the mesh is not a matrix
void print_report(const Console& console, const distributed::DistributedOptions& options,
                  const distributed::DistributedReport& report, const std::vector<std::int64_t>& peaks,
                  const StoredMatrix* stored);

/// Returns {"ranks", "parts", "partition", "edge_span", "memory_bytes", "seconds"}.
nlohmann::ordered_json to_json(const distributed::DistributedOptions& options,
                               const distributed::DistributedReport& report,
                               const std::vector<std::int64_t>& peaks);

}  // namespace meshorder::command
