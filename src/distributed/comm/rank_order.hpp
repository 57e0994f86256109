// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/checksum.hpp"
#include "distributed/comm/communicator.hpp"

#include <cstddef>

namespace meshorder::distributed {

/// Extends a checksum, the same on all ranks, by the data that the ranks add one after another, in rank
/// order: each calls `add()`, which must not throw. Every rank has to call it; ranks wait for each other.
template <class Add>
void add_in_rank_order(const Communicator& communicator, Checksum& checksum, const Add& add) {
  for (int turn = 0; turn < communicator.size(); ++turn) {
    if (turn == communicator.rank()) add();
    checksum = communicator.gathered(checksum)[static_cast<std::size_t>(turn)];
  }
}

}  // namespace meshorder::distributed
