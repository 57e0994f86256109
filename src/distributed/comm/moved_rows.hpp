// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace meshorder::distributed {

/// Moves rows of values to the ranks that own their new places. Made once, asked to move as many arrays as
/// there are.
class RowMover {
 public:
  /// Every rank has to call it. O(rows + ranks).
  ///
  /// @param layout  who owns which places
  /// @param places  of the own rows; every place of the layout is that of one row of one rank
  /// @throws as `Communicator::exchange`
  RowMover(const Communicator& communicator, const Layout& layout, std::span<const GlobalIndex> places);

  /// Returns the rows of this rank's places, in the order of these. Every rank has to call it. O(bytes).
  ///
  /// @param rows   `width` bytes for each own row
  /// @param width  the same on all ranks
  /// @throws as `Communicator::exchange`
  [[nodiscard]] std::vector<std::byte> moved(std::span<const std::byte> rows, Offset width) const;

  /// The same for rows of different lengths. O(entries + rows).
  ///
  /// @param rows  taken: with those that are sent and those that arrive they would be there three times
  [[nodiscard]] Rows moved(Rows rows) const;

 private:
  const Communicator& communicator_;
  std::vector<Offset> sent_;    ///< own rows in the order in which they are sent
  std::vector<Offset> starts_;  ///< of those for each rank
  std::vector<Offset> places_;  ///< of the rows that arrive, among the own places
};

}  // namespace meshorder::distributed
