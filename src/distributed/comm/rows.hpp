// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"

#include <span>
#include <vector>

namespace meshorder::distributed {

/// Rows of 64-bit integers. An entry may also hold the bits of a real number.
struct Rows {
  std::vector<Offset> offsets{0};  ///< rows + 1 entries, ascending
  std::vector<GlobalIndex> entries;

  [[nodiscard]] Offset size() const noexcept { return static_cast<Offset>(offsets.size()) - 1; }
  [[nodiscard]] std::span<const GlobalIndex> operator[](Offset row) const {
    return {entries.data() + offsets[static_cast<std::size_t>(row)],
            entries.data() + offsets[static_cast<std::size_t>(row) + 1]};
  }
  /// Ends a row, after its entries were appended to `entries`.
  void end_row() { offsets.push_back(static_cast<Offset>(entries.size())); }

  bool operator==(const Rows&) const = default;
};

/// A row to be sent to a rank.
struct Dispatch {
  int to;
  Offset row;
};

/// Sends a copy of a row for each dispatch. Returns the rows that this rank receives, sorted by sending rank;
/// rows of one rank are in the sequence of its dispatches. Every rank has to call it. O(entries +
/// dispatches).
///
/// @param rows        freed before the exchange, because the rows to send and the received rows are two more
///                    copies
/// @param dispatches  freed before the exchange
/// @throws as `Communicator::exchange`
[[nodiscard]] Rows send_rows(const Communicator& communicator, Rows rows, std::vector<Dispatch> dispatches);

}  // namespace meshorder::distributed
