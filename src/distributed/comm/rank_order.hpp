// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/checksum.hpp"
#include "distributed/comm/communicator.hpp"

#include <cstddef>

namespace meshorder::distributed {

/// Goes on with a checksum, the same on all ranks, by what each of them adds, in their order. Every rank has
/// to call it, and waits for those before it.
template <class Add>
void add_in_rank_order(const Communicator& communicator, Checksum& checksum, const Add& add) {
  for (int turn = 0; turn < communicator.size(); ++turn) {
    if (turn == communicator.rank()) add();
    checksum = communicator.gathered(checksum)[static_cast<std::size_t>(turn)];
  }
}

}  // namespace meshorder::distributed
