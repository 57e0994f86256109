// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace meshorder::distributed {

/// Moves rows of values to the ranks that own their new positions ("places"). A RowMover is set up once and
/// can then move many arrays.
class RowMover {
 public:
  /// Every rank has to call it. O(rows · log ranks + ranks).
  ///
  /// @param layout  the owners of the places
  /// @param places  new place of each row of this rank; over all ranks, each place of the layout occurs once
  /// @throws as `Communicator::exchange`
  RowMover(const Communicator& communicator, const Layout& layout, std::span<const GlobalIndex> places);

  /// Returns the rows that move to this rank's places, sorted by place. Every rank has to call this function.
  /// O(bytes).
  ///
  /// @param rows   `width` bytes for each row of this rank
  /// @param width  the same on all ranks
  /// @throws as `Communicator::exchange`
  [[nodiscard]] std::vector<std::byte> moved(std::span<const std::byte> rows, Offset width) const;

  /// As above, for rows of different lengths. O(entries + rows).
  ///
  /// @param rows  freed before the exchange, because the rows to send and the received rows are two more
  ///              copies
  [[nodiscard]] Rows moved(Rows rows) const;

 private:
  const Communicator& communicator_;
  std::vector<Offset> sent_;    ///< rows of this rank in the sequence in which they are sent, rank by rank
  std::vector<Offset> starts_;  ///< index in `sent_` of the first row for each rank, then the size of `sent_`
  std::vector<Offset> places_;  ///< position of each received row among this rank's places
};

}  // namespace meshorder::distributed
