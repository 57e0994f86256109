// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"

#include <span>
#include <vector>

namespace meshorder::distributed {

/// Rows of whole numbers, which may be bits of others.
struct Rows {
  std::vector<Offset> offsets{0};  ///< rows + 1, ascending
  std::vector<GlobalIndex> entries;

  [[nodiscard]] Offset size() const noexcept { return static_cast<Offset>(offsets.size()) - 1; }
  [[nodiscard]] std::span<const GlobalIndex> operator[](Offset row) const {
    return {entries.data() + offsets[static_cast<std::size_t>(row)],
            entries.data() + offsets[static_cast<std::size_t>(row) + 1]};
  }
  /// Ends the row whose entries were appended.
  void end_row() { offsets.push_back(static_cast<Offset>(entries.size())); }

  bool operator==(const Rows&) const = default;
};

/// A row on its way to a rank.
struct Dispatch {
  int to;
  Offset row;
};

/// Sends copies of rows to ranks, a row to as many as there are dispatches of it, and returns what this rank
/// gets: by the rank that sent it, then in the order of the dispatches there. Every rank has to call it.
/// O(entries + dispatches).
///
/// @param rows        taken: with those that are sent and those that arrive they would be there three times
/// @param dispatches  taken
/// @throws as `Communicator::exchange`
[[nodiscard]] Rows send_rows(const Communicator& communicator, Rows rows, std::vector<Dispatch> dispatches);

}  // namespace meshorder::distributed
